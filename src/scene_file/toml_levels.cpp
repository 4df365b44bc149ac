#include "scene_file/toml_levels.hpp"

#include <algorithm>
#include <cstddef>

#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

// Scenes have three.
constexpr int kMaxLevels = 32;
constexpr std::size_t kMaxBytes = std::size_t{1} << 26;

/// Walks over the text from word to word; strings and comments hold nothing that nests.
class Walk {
 public:
  Walk(const std::string& text, const std::string& path) : text_(text), path_(path) {}

  void all() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'')
        string(c);
      else if (c == '#')
        at_ = std::min(text_.find('\n', at_), text_.size());
      else
        plain(c);
    }
  }

 private:
  void plain(char c) {
    ++at_;
    if (c == '\n') ++line_;
    if (c == '.') {
      count(++dots_, "levels in a key");
    } else if (c == '[' || c == '{') {
      count(++brackets_, "brackets in brackets");
      dots_ = 0;
    } else if (c == ']' || c == '}') {
      brackets_ = std::max(0, brackets_ - 1);
      dots_ = 0;
    } else if (c == '\n' || c == '=' || c == ',') {
      dots_ = 0;
    }
  }

  /// One that is not closed ends with the line, as the parser then does, or with the text.
  void string(char quote) {
    const bool many_lines = text_.compare(at_, 3, std::string(3, quote)) == 0;
    at_ += many_lines ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') {
        if (!many_lines) return;
        ++line_;
      } else if (c == '\\' && quote == '"') {
        ++at_;
        if (at_ < text_.size() && text_[at_] == '\n') ++line_;
      } else if (c == quote && (!many_lines || text_.compare(at_, 3, std::string(3, quote)) == 0)) {
        at_ += many_lines ? 3 : 1;
        // Up to two more quotes belong to a string of many lines.
        for (int i = 0; many_lines && i < 2 && at_ < text_.size() && text_[at_] == quote; ++i) ++at_;
        return;
      }
    }
  }

  void count(int levels, const char* what) const {
    if (levels <= kMaxLevels) return;
    throw Error(ErrorKind::file,
                path_ + ":" + std::to_string(line_) + ": more than " + std::to_string(kMaxLevels) + " " + what +
                    "; no scene has so many",
                {path_, static_cast<int>(line_), {}, {}});
  }

  const std::string& text_;
  const std::string& path_;
  std::size_t at_ = 0, line_ = 1;
  int dots_ = 0, brackets_ = 0;
};

}  // namespace

void check_toml_levels(const std::string& text, const std::string& path) {
  if (text.size() > kMaxBytes)
    throw Error(ErrorKind::file, path + ": is longer than 64 MB, and no scene is", {path, 0, {}, {}});
  Walk(text, path).all();
}

}  // namespace tegotae
