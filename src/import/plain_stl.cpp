#include "import/plain_stl.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>

#include "import/check_text.hpp"
#include "import/utf8.hpp"

namespace tegotae {
namespace {

constexpr std::size_t kHeader = 84, kFacet = 50;
// Names are cut there; assimp refuses longer ones.
constexpr std::size_t kLongestName = 200;

std::uint32_t little_endian_32(std::string_view bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
  return value;
}

bool is_word(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

/// Whether a line that begins with `word` is a comment or a color, which some programs write between facets.
bool is_aside(std::string_view word) {
  return word.substr(0, 1) == "#" || word.substr(0, 1) == ";" || word.substr(0, 2) == "//" || is_word(word, "color");
}

bool is_of_facet(std::string_view word) {
  for (const char* keyword : {"outer", "loop", "vertex", "endloop", "endfacet", "facet", "endsolid"})
    if (is_word(word, keyword)) return true;
  return false;
}

/// The words of a text STL file, and the plain file as it becomes.
class TextStl {
 public:
  TextStl(const std::string& path, std::string_view text) : path_(path), rest_(text) {}

  std::string plain() {
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (is_word(word, "solid")) {
        solid();
      } else if (open_ && is_word(word, "facet")) {
        facet();
      } else if (open_ && is_word(word, "endsolid")) {
        out_ += "endsolid\n";
        rest_of_line();
        open_ = false;
      } else if (is_aside(word)) {
        rest_of_line();
      } else if (open_ || is_word(word, "facet")) {
        refuse(path_, "truncated or damaged: \"" + printable(std::string(word.substr(0, 40))) +
                          "\" where a facet or endsolid belongs");
      }
    }
    if (open_) refuse(path_, "truncated: the last solid has no endsolid");
    return std::move(out_);
  }

 private:
  /// The next word; empty at the end.
  std::string_view next() {
    rest_.remove_prefix(first_not_of(rest_, kSpace));
    const std::string_view word = rest_.substr(0, first_of(rest_, kSpace));
    rest_.remove_prefix(word.size());
    return word;
  }

  std::string_view rest_of_line() {
    const std::string_view line = rest_.substr(0, first_of(rest_, "\r\n"));
    rest_.remove_prefix(line.size());
    return line;
  }

  /// Whether the word `facet`, which stands before `rest`, begins a facet: `outer` is the first that follows of its
  /// words. In a name it may be any word.
  bool begins_facet(std::string_view rest) const {
    TextStl behind(path_, rest);
    if (!is_word(behind.next(), "normal")) return false;
    std::string_view word = behind.next();
    while (!word.empty() && !is_of_facet(word)) word = behind.next();
    return is_word(word, "outer");
  }

  /// The first word of the name is kept. A name ends with its line, or before a facet on it.
  void solid() {
    const std::string_view all = rest_;
    TextStl line(path_, rest_of_line());
    std::string_view name;
    for (std::string_view word = line.next(); !word.empty(); word = line.next()) {
      const auto at = static_cast<std::size_t>(word.data() - all.data());
      if (is_word(word, "facet") && begins_facet(all.substr(at + word.size()))) {
        rest_ = all.substr(at);
        break;
      }
      if (name.empty()) name = word;
    }
    out_ += "solid";
    if (!name.empty()) (out_ += ' ') += name.substr(0, kLongestName);
    out_ += '\n';
    open_ = true;
  }

  void expect(std::string_view keyword) {
    if (!is_word(next(), keyword)) refuse(path_, "truncated or damaged: a facet without " + std::string(keyword));
  }

  void facet() {
    expect("normal");
    // What stands for a normal may be anything but the words that follow it.
    for (std::string_view word = TextStl(path_, rest_).next(); !word.empty() && !is_of_facet(word);
         word = TextStl(path_, rest_).next())
      next();
    expect("outer");
    expect("loop");
    out_ += "facet normal 0 0 0\nouter loop\n";
    for (int k = 0; k < 3; ++k) vertex();
    expect("endloop");
    expect("endfacet");
    out_ += "endloop\nendfacet\n";
  }

  void vertex() {
    expect("vertex");
    out_ += "vertex";
    for (int k = 0; k < 3; ++k) {
      std::string word(next());
      // Some programs write the decimal comma of their country; it cannot be anything else here.
      std::replace(word.begin(), word.end(), ',', '.');
      std::string_view text = word;
      double value = 0;
      if (!take_number(text, value)) refuse(path_, "truncated or damaged: a vertex without three numbers");
      if (!std::isfinite(value)) refuse(path_, "a coordinate is not a finite number");
      (out_ += ' ') += plain_number(word, value);
    }
    out_ += '\n';
  }

  static constexpr std::string_view kSpace = " \t\r\n\v\f";
  const std::string& path_;
  std::string_view rest_;
  std::string out_;
  bool open_ = false;
};

/// What might be a text STL file, from its first word that is not a comment to the padding at its end.
std::string_view text_of(std::string_view bytes) {
  bytes = bytes.substr(0, bytes.find_last_not_of('\0') + 1);
  if (bytes.substr(0, 3) == "\xef\xbb\xbf") bytes.remove_prefix(3);
  for (;;) {
    bytes.remove_prefix(first_not_of(bytes, kBlank));
    if (bytes.empty() || !is_aside(bytes.substr(0, first_of(bytes, kBlank)))) return bytes;
    bytes.remove_prefix(first_of(bytes, "\r\n"));
  }
}

/// Whether `bytes` look like text: the count of a binary file has a byte that is none.
bool is_text(std::string_view bytes) {
  return std::none_of(bytes.begin(), bytes.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 32 && kBlank.find(c) == kBlank.npos; });
}

/// Whether a text has the word of facets that no name has.
bool has_facets(std::string_view text) {
  return text.find("endfacet") != text.npos || text.find("ENDFACET") != text.npos;
}

/// The line of the first zero byte.
std::size_t zero_line(std::string_view text) {
  const std::string_view before = text.substr(0, text.find('\0'));
  return static_cast<std::size_t>(std::count(before.begin(), before.end(), '\n')) + 1;
}

/// What a text begins with instead of `solid`, where nobody can see it.
std::string other_start(std::string_view text) {
  std::string bytes;
  for (const char c : text.substr(0, 8)) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x80) break;
    constexpr const char* kDigits = "0123456789ABCDEF";
    ((bytes += ' ') += kDigits[code / 16]) += kDigits[code % 16];
  }
  return bytes.empty() ? "" : ", this one with the bytes" + bytes;
}

}  // namespace

std::string plain_stl(const std::string& path, std::string file) {
  const std::string_view bytes = file;
  const std::uint64_t facets = bytes.size() < kHeader ? 0 : little_endian_32(bytes, kHeader - 4);
  const std::size_t room = bytes.size() < kHeader ? 0 : (bytes.size() - kHeader) / kFacet;
  const std::size_t whole = kHeader + kFacet * static_cast<std::size_t>(facets);
  if (bytes.size() >= kHeader && whole == bytes.size()) {
    if (facets == 0) refuse(path, "no triangles");
    return file;
  }
  const std::string_view text = text_of(bytes);
  if (is_word(text.substr(0, 5), "solid") && text.find('\0') == std::string_view::npos)
    return TextStl(path, text).plain();
  // Bytes behind the last facet are padding, unless they may be facets: then the count is wrong. Facets of one and the
  // same byte have all corners in one place.
  if (facets > 0 && whole < bytes.size() && (room == facets || is_padding(bytes.substr(whole))))
    return std::string(bytes.substr(0, whole));
  require_single_bytes(path, bytes);
  if (is_word(text.substr(0, 5), "solid") && has_facets(text))
    refuse(path, "damaged: zero bytes in the text, the first in line " + std::to_string(zero_line(text)));
  if (is_text(bytes.substr(0, kHeader)))
    refuse(path, "damaged: a text STL file begins with \"solid\"" + other_start(text));
  if (bytes.size() < kHeader) refuse(path, "truncated: too short for a binary STL and no text STL");
  refuse(path, std::string(facets > room ? "truncated" : "damaged") + ": its header states " + std::to_string(facets) +
                   " triangles, the file has bytes for " + std::to_string(room));
}

}  // namespace tegotae
