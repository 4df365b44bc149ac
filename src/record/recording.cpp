#include "tegotae/record/recording.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "record/csv_reader.hpp"
#include "record/mcap_format.hpp"
#include "record/mcap_reader.hpp"
#include "record/recording_info.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

std::string contents(const std::string& path) {
  errno = 0;
  std::FILE* file = std::fopen(path.c_str(), "rb");
  std::string text;
  char block[1 << 16];
  for (std::size_t n = 1; file != nullptr && n > 0;) {
    n = std::fread(block, 1, sizeof block, file);
    text.append(block, n);
  }
  const int error = file == nullptr || std::ferror(file) != 0 ? errno : 0;  // a folder opens, and fails when it is read
  if (file != nullptr) std::fclose(file);
  if (error != 0)
    throw Error(ErrorKind::file,
                path + ": cannot read the recording: " + (error == ENOENT ? "no such file" : std::strerror(error)),
                {path, 0, {}, {}});
  return text;
}

}  // namespace

Recording read_recording(const std::string& path) {
  const std::string text = contents(path);
  if (text.compare(0, mcap::kMagic.size(), mcap::kMagic) == 0) return read_mcap(path, text);
  Recording out = read_csv(path, text);
  out.info = read_info(path);
  return out;
}

}  // namespace tegotae
