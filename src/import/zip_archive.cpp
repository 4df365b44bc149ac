#include "import/zip_archive.hpp"

#include <minizip/unzip.h>

#include "tegotae/core/error.hpp"

namespace tegotae {
namespace {

// Deflate packs a thousand bytes into one at best.
constexpr double kMaxCompression = 1100;

}  // namespace

void ZipArchive::Close::operator()(void* archive) const {
  unzClose(archive);
}

ZipArchive::ZipArchive(const std::string& path) : path_(path), archive_(unzOpen64(path.c_str())) {
  if (archive_ == nullptr) throw Error(path + ": truncated or damaged: no ZIP archive");
}

std::string ZipArchive::read(const std::string& name) const {
  const auto damaged = [&](const std::string& why) { return Error(path_ + ": damaged: " + name + " in it " + why); };
  if (unzLocateFile(archive_.get(), name.c_str(), 2) != UNZ_OK) throw damaged("is missing");  // 2: names have no case
  unz_file_info64 info{};
  if (unzGetCurrentFileInfo64(archive_.get(), &info, nullptr, 0, nullptr, 0, nullptr, 0) != UNZ_OK)
    throw damaged("has no header");
  if (static_cast<double>(info.uncompressed_size) > kMaxCompression * static_cast<double>(info.compressed_size) + 1000)
    throw damaged("is larger than its bytes can hold");
  if (unzOpenCurrentFile(archive_.get()) != UNZ_OK)
    throw damaged("cannot be opened (encrypted, or another compression)");
  std::string bytes;
  char block[65536];
  int n = 0;
  while ((n = unzReadCurrentFile(archive_.get(), block, sizeof block)) > 0 && bytes.size() <= info.uncompressed_size)
    bytes.append(block, static_cast<std::size_t>(n));
  const int closed = unzCloseCurrentFile(archive_.get());  // compares the checksum
  if (n < 0 || closed != UNZ_OK || bytes.size() != info.uncompressed_size) throw damaged("cannot be unpacked");
  return bytes;
}

}  // namespace tegotae
