// Runs the programs as a user does.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace tegotae::test {

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

/// A folder of its own under the temporary one, gone with the object.
class TempFolder {
 public:
  TempFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "tegotae_test_XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
  }

 private:
  std::filesystem::path path_;
};

struct Output {
  int code = -1;  ///< exit code; 128 + signal when it was killed
  std::string out;
  std::string err;
};

/// Runs `program` of the build's bin folder with shell-quoted `arguments`.
inline Output run_program(const std::string& program, const std::string& arguments) {
  const TempFolder folder;
  const std::string command = std::string(TEGOTAE_BIN_DIR "/") + program + " " + arguments + " </dev/null >" +
                              (folder / "out") + " 2>" + (folder / "err");
  const int status = std::system(command.c_str());
  Output output;
  output.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  output.out = read_text(folder / "out");
  output.err = read_text(folder / "err");
  return output;
}

/// A tetrahedron held 20 mm over another and moved about there; a fraction of a second.
inline void write_small_scene(const TempFolder& folder) {
  folder.write("tet.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  folder.write("path.csv",
               "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.02,1,0,0,0\n0.3,0.005,0,0.02,1,0,0,0\n0.6,0.01,0,0.02,1,0,0,0\n");
  folder.write("scene.toml",
               "unit = \"mm\"\n"
               "[[part]]\nname = \"block\"\nmesh = \"tet.obj\"\n"
               "[[part]]\nname = \"peg\"\nmesh = \"tet.obj\"\nheld = true\nposition = [0, 0, 0.02]\n"
               "[device]\nscript = \"path.csv\"\n");
}

}  // namespace tegotae::test
