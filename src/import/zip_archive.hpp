#pragma once

#include <memory>
#include <string>

namespace tegotae {

/// The files in a ZIP archive.
class ZipArchive {
 public:
  /// Throws Error unless `path` is a readable archive.
  explicit ZipArchive(const std::string& path);

  /// The bytes of the file `name`. Throws Error when it is missing or damaged, or larger than an archive of this size
  /// can reasonably hold.
  std::string read(const std::string& name) const;

 private:
  struct Close {
    void operator()(void* archive) const;
  };
  const std::string path_;
  std::unique_ptr<void, Close> archive_;
};

}  // namespace tegotae
