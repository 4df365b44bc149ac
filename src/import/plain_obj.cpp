#include "import/plain_obj.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "import/check_text.hpp"
#include "import/utf8.hpp"

namespace tegotae {
namespace {

constexpr std::string_view kSpace = " \t\v\f";
// Names are cut there; no program makes longer ones.
constexpr std::size_t kLongestName = 200;

// Free-form surfaces, also as the format had them before.
constexpr std::array<std::string_view, 4> kSurfaces = {"surf", "bsp", "bzp", "cdp"};
// Statements of the format that nothing of a polygon's shape depends on.
constexpr std::array<std::string_view, 32> kBesideShape = {
    "vt",       "vn",   "vp",     "deg",    "bmat",       "step",      "cstype", "p",     "l",   "curv",  "curv2",
    "parm",     "trim", "hole",   "scrv",   "sp",         "end",       "con",    "s",     "mg",  "bevel", "c_interp",
    "d_interp", "lod",  "maplib", "usemap", "shadow_obj", "trace_obj", "ctech",  "stech", "cdc", "res"};

template <class Words>
bool is_one_of(const Words& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The statements of an OBJ file, and the plain file as it becomes.
class ObjReader {
 public:
  ObjReader(const std::string& path, std::string_view bytes) : path_(path), rest_(bytes) {
    require_single_bytes(path, bytes);
    if (rest_.substr(0, 3) == "\xef\xbb\xbf") rest_.remove_prefix(3);
    // Padding, and how some systems marked the end of a text.
    rest_ = rest_.substr(0, rest_.find_last_not_of(std::string_view("\0\x1a\x04", 3)) + 1);
  }

  std::string plain(std::vector<std::string>& notes) {
    while (!rest_.empty()) {
      line_ = next_line_;
      take_statement();
      read();
    }
    if (largest_ > vertices_)
      refuse(path_, "index out of range: line " + std::to_string(largest_line_) + " names vertex " +
                        std::to_string(largest_) + " of " + std::to_string(vertices_) +
                        (unknown_.empty() ? "" : "; " + unknown()));
    if (!has_faces_) refuse(path_, "no triangles" + (unknown_.empty() ? "" : "; " + unknown()));
    if (surface_line_ > 0)
      notes.push_back("the free-form surfaces from line " + std::to_string(surface_line_) +
                      " on are not read; export them as polygons");
    if (!unknown_.empty()) notes.push_back(unknown() + ": left out; export anew if something is missing");
    if (short_line_ > 0)
      notes.push_back("faces of fewer than three corners are left out, the first in line " +
                      std::to_string(short_line_) + "; export anew if there is a hole");
    return std::move(out_);
  }

 private:
  std::string unknown() const {
    return "line " + std::to_string(unknown_line_) + " \"" + unknown_ + "\" is not a known statement";
  }

  [[noreturn]] void bad(const std::string& why) const {
    refuse(path_, (ends_file_ ? "truncated: the last line \"" : "damaged: line " + std::to_string(line_) + " \"") +
                      printable(statement_.substr(0, 60)) + "\" " + why);
  }

  /// The next statement into `statement_`: a backslash at the end of a line goes on with the next, but in a comment,
  /// where it is the end of some folder's name.
  void take_statement() {
    statement_.clear();
    for (bool goes_on = true; goes_on && !rest_.empty();) {
      std::string_view line = rest_.substr(0, first_of(rest_, "\r\n"));
      rest_.remove_prefix(line.size());
      ends_file_ = rest_.empty();
      rest_.remove_prefix(std::min<std::size_t>(rest_.substr(0, 2) == "\r\n" ? 2 : 1, rest_.size()));
      ++next_line_;
      const std::size_t start = first_not_of(line, kSpace);
      if (statement_.empty() && line.substr(start, 1) == "#") return;
      goes_on = !line.empty() && line.back() == '\\';
      if (goes_on) line.remove_suffix(1);
      (statement_ += line) += goes_on ? " " : "";
    }
  }

  static std::string_view take_word(std::string_view& line) {
    line.remove_prefix(first_not_of(line, kSpace));
    const std::string_view word = line.substr(0, first_of(line, kSpace));
    line.remove_prefix(word.size());
    return word;
  }

  void read() {
    std::string_view values = statement_;
    const std::string_view word = take_word(values);
    if (word == "v") {
      read_vertex(values.substr(0, values.find('#')));
    } else if (word == "f" || word == "fo") {
      read_face(values.substr(0, values.find('#')));
    } else if (word == "o" || word == "g" || word == "usemtl" || word == "mtllib") {
      copy_name(word, values);
    } else if (is_one_of(kSurfaces, word)) {
      if (surface_line_ == 0) surface_line_ = line_;
    } else if (!word.empty() && word[0] != '#' && !is_one_of(kBesideShape, word)) {
      read_unknown(word);
    }
  }

  /// What is not a statement of the format. One that does not begin with a word may be any, damaged.
  void read_unknown(std::string_view word) {
    if (std::any_of(word.begin(), word.end(), [](char c) { return c < '!' || c > '~'; }))
      bad("does not begin with the word of a statement");
    if (!unknown_.empty()) return;
    unknown_ = printable(statement_.substr(0, 60));
    unknown_line_ = line_;
  }

  /// Behind x, y and z stand a weight that only curves and surfaces use, or a color.
  void read_vertex(std::string_view values) {
    out_ += 'v';
    for (int k = 0; k < 3; ++k) {
      std::string number(take_word(values));
      // Some programs write the decimal comma of their country; it cannot be anything else here.
      std::replace(number.begin(), number.end(), ',', '.');
      std::string_view text = number;
      double value = 0;
      if (number.empty() || !take_number(text, value)) bad("has no coordinate where one belongs");
      (out_ += ' ') += plain_number(number, value);
    }
    out_ += '\n';
    ++vertices_;
  }

  /// Corners are "vertex/texture/normal", of which only the vertex counts.
  void read_face(std::string_view values) {
    std::vector<std::uint64_t> corners;
    for (std::string_view word = take_word(values); !word.empty(); word = take_word(values)) {
      std::string_view text = word.substr(0, word.find('/'));
      std::int64_t index = 0;
      if (!take_number(text, index)) bad("has a corner that is not an index of a vertex");
      const auto known = static_cast<std::int64_t>(vertices_);
      if (index == 0 || index < -known) bad("has an index out of range");
      corners.push_back(static_cast<std::uint64_t>(index > 0 ? index : known + index + 1));
      if (corners.back() > largest_) {
        largest_ = corners.back();
        largest_line_ = line_;
      }
    }
    if (corners.size() < 3) {
      if (ends_file_) bad("has fewer than three corners");
      if (short_line_ == 0) short_line_ = line_;
      return;
    }
    has_faces_ = true;
    out_ += 'f';
    for (const std::uint64_t corner : corners) (out_ += ' ') += std::to_string(corner);
    out_ += '\n';
  }

  void copy_name(std::string_view word, std::string_view name) {
    name.remove_prefix(first_not_of(name, kSpace));
    (out_ += word) += ' ';
    for (const char c : name.substr(0, kLongestName)) out_ += c == '\\' ? '/' : c;  // assimp goes on after a backslash
    out_ += '\n';
  }

  const std::string& path_;
  std::string_view rest_;
  std::string statement_, out_, unknown_;
  std::size_t line_ = 0, next_line_ = 1, largest_line_ = 0, surface_line_ = 0, unknown_line_ = 0, short_line_ = 0;
  std::uint64_t vertices_ = 0, largest_ = 0;
  bool has_faces_ = false;
  bool ends_file_ = false;  // with the statement, and no line break behind it
};

}  // namespace

std::string plain_obj(const std::string& path, std::string_view bytes, std::vector<std::string>& notes) {
  return ObjReader(path, bytes).plain(notes);
}

}  // namespace tegotae
