#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "core/file_descriptor.hpp"
#include "mesh/content_sum.hpp"

namespace tegotae {

/// Sets the folder of the cache; empty: there is none. Not beside threads that use it.
void set_cache_folder(const std::string& path);
bool has_cache_folder();

/// Smaller meshes are read and prepared faster than keeping them is worth.
inline constexpr std::size_t kMinCached = 20000;  // triangles; 50 ms

/// What an entry of the cache is of.
struct CacheName {
  const char* kind;     ///< at most 7 letters: "mesh", "patch", ...; also how its file's name ends
  std::uint32_t build;  ///< to be raised whenever the same content gives another entry
  ContentKey of;        ///< of what it was made from
};

/// Reads an entry block by block, in the order in which it was written. Nothing that was taken may be used before
/// done() has said that all of it is whole.
class CacheReader {
 public:
  explicit CacheReader(const CacheName& name);

  /// The next block; false when there is none of this kind.
  template <typename T>
  bool take(std::vector<T>& block) {
    std::uint64_t count = 0;
    if (!next_block(sizeof(T), count)) return false;
    block.reserve(count);
    expect_large(block.data(), count * sizeof(T));
    block.resize(count);
    return read_block(block.data(), count * sizeof(T));
  }
  template <typename T>
  bool take_value(T& value) {
    std::uint64_t count = 0;
    return next_block(sizeof(T), count) && count == 1 && read_block(&value, sizeof(T));
  }
  /// Whether all blocks were taken and their sum is the one in the file. Marks the entry as used now.
  bool done();

 private:
  bool next_block(std::size_t element, std::uint64_t& count);
  bool read_head(void* to, std::size_t bytes);
  /// By several threads when it is large.
  bool read_block(void* to, std::size_t bytes);
  /// Asks for large pages: a start makes some hundred megabytes, in pages of 4 kB that is most of its time.
  static void expect_large(void* memory, std::size_t bytes) noexcept;

  std::string path_;
  FileDescriptor file_;
  bool sound_ = false;
  std::uint64_t left_ = 0;  // bytes of blocks
  std::uint64_t at_ = 0;    // in the file
  ContentSum sum_;
};

/// Writes an entry beside its place, and puts it there as a whole. What cannot be written is not an error: there is no
/// entry then.
class CacheWriter {
 public:
  explicit CacheWriter(const CacheName& name);
  ~CacheWriter();
  CacheWriter(const CacheWriter&) = delete;
  CacheWriter& operator=(const CacheWriter&) = delete;

  template <typename T>
  void put(const std::vector<T>& block) {
    put_block(block.data(), block.size(), sizeof(T));
  }
  template <typename T>
  void put_value(const T& value) {
    put_block(&value, 1, sizeof(T));
  }
  /// Puts the entry in its place. The oldest ones go while all take more than the cache may.
  void keep();

 private:
  void put_block(const void* data, std::uint64_t count, std::size_t element);
  void write(const void* data, std::size_t bytes);

  std::string path_, partial_;
  FileDescriptor file_;
  bool kept_ = false;
  bool failed_ = false;
  ContentSum sum_;
};

}  // namespace tegotae
