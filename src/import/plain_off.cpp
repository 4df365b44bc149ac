#include "import/plain_off.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "import/check_text.hpp"
#include "import/ply_bytes.hpp"

namespace tegotae {
namespace {

/// An OFF file: the header by words, then a vertex or face to a line; comments go from # to the end of the line.
class OffReader {
 public:
  OffReader(const std::string& path, std::string_view bytes) : path_(path), rest_(bytes) {}

  std::string plain(std::vector<std::string>& notes) {
    read_header();
    if (vertices_ > rest_.size() || faces_ > rest_.size())
      refuse(path_, crowded_ ? "damaged: more than counts on the line of its counts; each vertex and face takes a line"
                             : "truncated: it announces more elements than it has bytes");
    PlyBytes out;
    for (std::uint64_t i = 0; i < vertices_; ++i) out.vertex(read_vertex(i));
    for (std::uint64_t i = 0; i < faces_; ++i) out.face(read_face(i));
    if (!next_line().empty())
      notes.push_back(
          "lines behind its last face are not read: its counts announce fewer vertices and faces; "
          "correct them if something is missing");
    out.note_short(notes);
    if (!out.has_faces()) refuse(path_, "no triangles");
    return out.file();
  }

 private:
  /// Up to the counts: "OFF" may be missing, as the format says; its prefixes tell what vertices have besides.
  void read_header() {
    require_single_bytes(path_, rest_);
    const auto control = [](char c) { return static_cast<unsigned char>(c) < 32 && kBlank.find(c) == kBlank.npos; };
    if (rest_.substr(0, 3) == "\xef\xbb\xbf") rest_.remove_prefix(3);
    if (rest_.substr(0, first_of(rest_, "\r\n")).find("BINARY") != rest_.npos)
      refuse(path_, "binary OFF is not read (text OFF only): save it as text");
    if (std::any_of(rest_.begin(), rest_.end(), control))
      refuse(path_, "damaged: it has control characters (text OFF only)");
    std::string_view counts = next_line();
    std::string_view after = counts;
    const std::string_view magic = take_word(after);
    if (magic.size() >= 3 && magic.substr(magic.size() - 3) == "OFF") {
      read_prefixes(magic.substr(0, magic.size() - 3));
      counts = after;
    } else if (std::uint64_t number = 0; !take_number(after, number)) {
      refuse(path_, "damaged: it does not begin with OFF");
    }
    if (any_dimension_) {
      std::uint64_t dimensions = 0;
      if (!take_count(counts, dimensions)) refuse(path_, "damaged: the number of its dimensions is none");
      if (dimensions != 3)
        refuse(path_, "it has " + std::to_string(dimensions) + " dimensions; OFF files of three are read");
    }
    if (!take_count(counts, vertices_) || !take_count(counts, faces_))
      refuse(path_, "damaged: the counts of vertices and faces are not numbers (text OFF only)");
    take_word(counts);  // of edges, which nobody needs
    crowded_ = !take_word(counts).empty();
  }

  void read_prefixes(std::string_view prefixes) {
    for (const std::string_view known : {"ST", "C", "N", "4", "n"}) {
      if (prefixes.substr(0, known.size()) != known) continue;
      prefixes.remove_prefix(known.size());
      homogeneous_ = homogeneous_ || known == "4";
      any_dimension_ = any_dimension_ || known == "n";
    }
    if (!prefixes.empty()) refuse(path_, "damaged: it does not begin with OFF");
  }

  /// Counts may stand on a line each.
  bool take_count(std::string_view& line, std::uint64_t& count) {
    line.remove_prefix(first_not_of(line, kBlank));
    if (line.empty()) line = next_line();
    return take_number(line, count);
  }

  static std::string_view take_word(std::string_view& line) {
    line.remove_prefix(first_not_of(line, kBlank));
    const std::string_view word = line.substr(0, first_of(line, kBlank));
    line.remove_prefix(word.size());
    return word;
  }

  /// The next line with something on it, without its comment; at the end of the file an empty one.
  std::string_view next_line() {
    while (!rest_.empty()) {
      std::string_view line = rest_.substr(0, first_of(rest_, "\r\n"));
      rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
      line = line.substr(0, line.find('#'));
      if (line.find_first_not_of(kBlank) != line.npos) return line;
    }
    return {};
  }

  /// What follows the three (or four) numbers is a normal, a color, a place in a texture.
  Vec3 read_vertex(std::uint64_t number) {
    std::string_view line = next_line();
    Vec3 p;
    double w = 1;
    bool whole = true;
    for (double& x : p) whole = whole && take_coordinate(line, x);
    if (homogeneous_) whole = whole && take_coordinate(line, w);
    if (!whole)
      refuse(path_, "truncated or damaged at vertex " + std::to_string(number) + ", which takes a line of its own");
    if (w == 0) refuse(path_, "vertex " + std::to_string(number) + " lies at infinity");
    return p / w;
  }

  /// What follows the corners is a color.
  std::vector<std::uint32_t> read_face(std::uint64_t number) {
    std::string_view line = next_line();
    const std::string name = "face " + std::to_string(number);
    std::uint64_t corners = 0;
    if (!take_number(line, corners)) refuse(path_, "truncated or damaged at " + name);
    if (corners > line.size()) refuse(path_, "truncated or damaged in " + name + ", which takes a line");
    std::vector<std::uint32_t> face;
    for (std::uint64_t k = 0; k < corners; ++k) {
      std::int64_t index = 0;
      if (!take_number(line, index)) refuse(path_, "truncated or damaged in " + name + ", which takes a line");
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_)
        refuse(path_, "index out of range: " + name + " names vertex " + std::to_string(index) + " of " +
                          std::to_string(vertices_));
      face.push_back(static_cast<std::uint32_t>(index));
    }
    return face;
  }

  const std::string& path_;
  std::string_view rest_;
  std::uint64_t vertices_ = 0, faces_ = 0;
  bool homogeneous_ = false, any_dimension_ = false;
  bool crowded_ = false;  // something behind the counts
};

}  // namespace

std::string plain_off(const std::string& path, std::string_view bytes, std::vector<std::string>& notes) {
  return OffReader(path, bytes).plain(notes);
}

}  // namespace tegotae
