#include "import/off_check.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "import/check_text.hpp"

namespace tegotae {
namespace {

/// An OFF file as assimp reads it: the header by words, with comments from # to the end of the line, then a vertex or
/// face to a line.
class OffText {
 public:
  explicit OffText(std::string_view bytes) : bytes_(bytes) {}

  std::string_view header_word() {
    skip_comments();
    const std::size_t begin = at_;
    at_ = std::min(bytes_.find_first_of(kBlank, at_), bytes_.size());
    return bytes_.substr(begin, at_ - begin);
  }
  /// The next line that is not empty; without more lines, an empty one.
  std::string_view line() {
    at_ = std::min(bytes_.find_first_not_of("\r\n", at_), bytes_.size());
    const std::size_t begin = at_;
    at_ = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
    return bytes_.substr(begin, at_ - begin);
  }
  void skip_comments() {
    while ((at_ = std::min(bytes_.find_first_not_of(kBlank, at_), bytes_.size())) < bytes_.size() && bytes_[at_] == '#')
      at_ = std::min(bytes_.find_first_of("\r\n", at_), bytes_.size());
  }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

void check_off_face(const std::string& path, std::string_view line, std::int64_t face, std::int64_t vertices) {
  constexpr std::int64_t kMaxCorners = 9;  // assimp drops larger faces without a word
  const std::string name = "face " + std::to_string(face);
  std::int64_t corners = 0;
  // assimp reads on past a face without corners and ends in a segmentation fault.
  if (!take_number(line, corners) || corners < 1) refuse(path, "truncated or damaged at " + name);
  if (corners > kMaxCorners) {
    refuse(path, name + " has " + std::to_string(corners) + " corners; faces of OFF files are read up to " +
                     std::to_string(kMaxCorners) + ": export the part as triangles");
  }
  for (std::int64_t k = 0; k < corners; ++k) {
    std::int64_t index = 0;
    if (!take_number(line, index)) refuse(path, "truncated or damaged in " + name + ", which takes a line");
    if (index < 0 || index >= vertices) {
      refuse(path, "index out of range: " + name + " names vertex " + std::to_string(index) + " of " +
                       std::to_string(vertices));
    }
  }
}

}  // namespace

void check_off(const std::string& path, std::string_view bytes) {
  constexpr std::size_t kLongestLine = 4000;  // assimp's buffer for a line has 4096 bytes, and it does not mind its end
  OffText text(bytes);
  const std::string_view magic = text.header_word();
  if (magic.size() < 3 || magic.substr(magic.size() - 3) != "OFF") refuse(path, "damaged: it does not begin with OFF");
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 32 && kBlank.find(c) == kBlank.npos; };
  if (std::any_of(bytes.begin(), bytes.end(), control))
    refuse(path, "damaged: it has control characters (text OFF only)");
  std::array<std::int64_t, 3> counts{};  // of vertices, faces, edges
  for (std::int64_t& count : counts) {
    std::string_view word = text.header_word();
    if (!take_number(word, count) || count < 0) {
      refuse(path, "damaged: the counts of vertices, faces and edges are no numbers (text OFF only)");
    }
  }
  const auto [vertices, faces, edges] = counts;
  const auto room = static_cast<std::int64_t>(bytes.size());
  if (vertices > room || faces > room) refuse(path, "truncated: it announces more elements than it has bytes");
  text.skip_comments();
  for (std::int64_t i = 0; i < vertices + faces; ++i) {
    std::string_view line = text.line();
    if (line.size() > kLongestLine) refuse(path, "damaged: a line is longer than 4000 characters");
    if (i >= vertices) {
      check_off_face(path, line, i - vertices, vertices);
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      double x = 0;
      if (!take_number(line, x)) {
        refuse(path, "truncated or damaged at vertex " + std::to_string(i) + ", which takes a line of its own");
      }
    }
  }
}

}  // namespace tegotae
