#include "fuzz/fuzz.hpp"

#include <stdlib.h>

#include <cstdio>
#include <fstream>

namespace tegotae {

namespace fs = std::filesystem;

void require(bool promise, const char* what) {
  if (promise) return;
  std::fprintf(stderr, "promise broken: %s\n", what);
  std::abort();
}

void require_error_of(const std::string& beginning, const std::string& text) {
  require(text.rfind(beginning, 0) == 0, "the error begins with the file");
  require(text.find('\n') == std::string::npos, "the error is one line");
}

const fs::path& scratch_folder() {
  struct Folder {
    fs::path path;
    Folder() {
      const fs::path memory = "/dev/shm";
      std::error_code none;
      const fs::path parent = fs::is_directory(memory, none) ? memory : fs::temp_directory_path();
      std::string name = (parent / "tegotae-fuzz-XXXXXX").string();
      require(mkdtemp(name.data()) != nullptr, "a scratch folder can be made");
      path = name;
    }
    ~Folder() {
      std::error_code none;
      fs::remove_all(path, none);
    }
  };
  static const Folder folder;
  return folder.path;
}

std::string write_input(const std::string& name, const void* data, std::size_t size) {
  const std::string path = (scratch_folder() / name).string();
  std::ofstream(path, std::ios::binary).write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  return path;
}

}  // namespace tegotae
