#include "core/same_file.hpp"

#include <sys/stat.h>

#include <filesystem>
#include <unordered_map>

#include "tegotae/core/error.hpp"

namespace tegotae {

namespace fs = std::filesystem;

namespace {

// As the system follows.
constexpr int kMostLinks = 40;

/// The place that `path` leads to over symbolic links, also where nothing stands there yet.
fs::path followed(fs::path path) {
  std::error_code failed;
  for (int links = 0; links < kMostLinks; ++links) {
    const fs::path to = fs::read_symlink(path, failed);
    if (failed) break;
    path = path.parent_path() / to;
  }
  return path;
}

/// Files by what they are, where they are there, and by where they are or would be. Of each the first one counts.
class Files {
 public:
  void add(const std::string& path) {
    for (const std::string& key : keys(path)) paths_.emplace(key, path);
  }
  /// The one that is the same file; null: none is.
  const std::string* find(const std::string& path) const {
    for (const std::string& key : keys(path))
      if (const auto found = paths_.find(key); found != paths_.end()) return &found->second;
    return nullptr;
  }

 private:
  static std::vector<std::string> keys(const std::string& path) {
    std::vector<std::string> out;
    struct stat file = {};
    if (::stat(path.c_str(), &file) == 0)
      out.push_back(std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino));
    std::error_code failed;
    const fs::path place = fs::weakly_canonical(followed(fs::absolute(path, failed)), failed);
    if (!failed && !place.empty()) out.push_back(place.string());
    return out;
  }

  std::unordered_map<std::string, std::string> paths_;
};

Files files(const std::vector<std::string>& paths) {
  Files out;
  for (const std::string& path : paths)
    if (!path.empty()) out.add(path);
  return out;
}

/// Devices and pipes hold nothing that could be lost.
bool holds_nothing(const std::string& path) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

void refuse_to_replace(const std::vector<std::string>& outputs, const Files& inputs) {
  Files before;
  for (const std::string& path : outputs) {
    if (path.empty() || holds_nothing(path)) continue;
    if (const std::string* input = inputs.find(path))
      throw Error(ErrorKind::file,
                  path + ": would be replaced, but is read by the same command" +
                      (*input == path ? "" : " as " + *input) + "; write to another file",
                  {path, 0, {}, {}});
    if (before.find(path) != nullptr)
      throw Error(ErrorKind::file, path + ": the same command writes it twice; give each output its own file",
                  {path, 0, {}, {}});
    before.add(path);
  }
}

}  // namespace

void refuse_to_replace(const std::string& path, const std::vector<std::string>& inputs) {
  refuse_to_replace(std::vector<std::string>{path}, files(inputs));
}

void refuse_to_replace(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
  refuse_to_replace(outputs, files(inputs));
}

}  // namespace tegotae
