#include "mesh/cache_entry.hpp"

#include <sys/mman.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <tuple>
#include <utility>

#include "core/parallel_for.hpp"

namespace tegotae {

namespace fs = std::filesystem;

namespace {

constexpr std::uint32_t kLayout = 1;                           // of the files below
constexpr std::uintmax_t kMaxBytes = std::uintmax_t{4} << 30;  // in the folder
// Blocks are summed in pieces, which several threads can read, and while they are still in the processor's cache; the
// sum of an entry is over its heads and the keys of its pieces.
constexpr std::size_t kPiece = std::size_t{1} << 18;
// Larger blocks take longer to read than a thread to begin.
constexpr std::size_t kWorthThreads = std::size_t{1} << 22;
constexpr std::size_t kKeyDigits = 32;
constexpr std::size_t kPage = 4096, kLargePage = std::size_t{1} << 21;

std::string& folder() {
  static std::string path;
  return path;
}

/// Fixed size, no padding.
struct Header {
  std::array<char, 8> magic{'T', 'E', 'G', 'O', 'C', 'A', 'C', 'H'};
  std::uint32_t layout = kLayout, byte_order = 0x01020304;
  std::array<char, 8> kind{};
  std::uint32_t build = 0, unused = 0;
  ContentKey of{};
};
static_assert(sizeof(Header) == 48);

struct BlockHead {
  std::uint64_t element, count;
};

Header header_of(const CacheName& name) {
  Header h;
  std::strncpy(h.kind.data(), name.kind, h.kind.size() - 1);
  h.build = name.build;
  h.of = name.of;
  return h;
}

std::string file_of(const CacheName& name) {
  char digits[kKeyDigits + 1];
  std::snprintf(digits, sizeof digits, "%016llx%016llx", static_cast<unsigned long long>(name.of[0]),
                static_cast<unsigned long long>(name.of[1]));
  return folder() + "/" + digits + "." + name.kind;
}

/// Whether a file of this name is of the cache, whole or not.
bool is_ours(const std::string& name) {
  return name.size() > kKeyDigits && name[kKeyDigits] == '.' &&
         name.find_first_not_of("0123456789abcdef") == kKeyDigits;
}

/// Removes the files that were not used for longest as long as there are more than kMaxBytes.
void make_room() {
  std::error_code status;
  struct File {
    fs::file_time_type used;
    fs::path path;
    std::uintmax_t bytes;
  };
  std::vector<File> files;
  std::uintmax_t all = 0;
  for (fs::directory_iterator i(folder(), status), end; !status && i != end; i.increment(status)) {
    std::error_code gone;
    if (!is_ours(i->path().filename().string())) continue;
    const std::uintmax_t bytes = i->file_size(gone);
    if (gone) continue;
    files.push_back({i->last_write_time(gone), i->path(), bytes});
    all += bytes;
  }
  std::sort(files.begin(), files.end(),
            [](const File& a, const File& b) { return std::tie(a.used, a.path) < std::tie(b.used, b.path); });
  for (std::size_t i = 0; i < files.size() && all > kMaxBytes; ++i) {
    all -= files[i].bytes;
    fs::remove(files[i].path, status);
  }
}

/// Reads all of it; false at the end of the file or when it cannot be read.
bool read_fully(int fd, std::uint64_t from, void* to, std::size_t bytes) {
  char* at = static_cast<char*>(to);
  while (bytes > 0) {
    const ssize_t n = ::pread(fd, at, bytes, static_cast<off_t>(from));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += n;
    from += static_cast<std::uint64_t>(n);
    bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

ContentKey key_of(const void* data, std::size_t bytes) {
  ContentSum sum;
  sum.add(data, bytes);
  return sum.key();
}

}  // namespace

void set_cache_folder(const std::string& path) {
  folder() = path;
}

bool has_cache_folder() {
  return !folder().empty();
}

CacheReader::CacheReader(const CacheName& name)
    : path_(file_of(name)), file_(above_standard(::open(path_.c_str(), O_RDONLY | O_CLOEXEC))) {
  struct stat status;
  if (file_.get() < 0 || fstat(file_.get(), &status) != 0 || !S_ISREG(status.st_mode)) return;
  constexpr std::uint64_t kEnds = sizeof(Header) + sizeof(ContentKey);
  const auto size = static_cast<std::uint64_t>(status.st_size);
  if (size < kEnds) return;
  left_ = size - kEnds;
  Header header;
  const Header wanted = header_of(name);
  sound_ = read_head(&header, sizeof header) && std::memcmp(&header, &wanted, sizeof header) == 0;
}

bool CacheReader::next_block(std::size_t element, std::uint64_t& count) {
  BlockHead head;
  if (!sound_ || left_ < sizeof head) return sound_ = false;
  left_ -= sizeof head;
  // A count that was damaged must not ask for memory that the file cannot fill.
  if (!read_head(&head, sizeof head) || head.element != element || head.count > left_ / element) return sound_ = false;
  count = head.count;
  left_ -= count * element;
  return true;
}

void CacheReader::expect_large(void* memory, std::size_t bytes) noexcept {
  const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + kPage - 1) / kPage * kPage;
  const auto end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / kPage * kPage;
  // Where the system does not do it, nothing is lost but time.
  if (end > begin && end - begin >= kLargePage) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

bool CacheReader::read_head(void* to, std::size_t bytes) {
  if (!read_fully(file_.get(), at_, to, bytes)) return sound_ = false;
  sum_.add(to, bytes);
  at_ += bytes;
  return true;
}

bool CacheReader::read_block(void* to, std::size_t bytes) {
  std::vector<ContentKey> keys((bytes + kPiece - 1) / kPiece);
  std::atomic<bool> read{true};
  const auto read_piece = [&](int i) {
    const std::size_t from = static_cast<std::size_t>(i) * kPiece, n = std::min(bytes - from, kPiece);
    char* piece = static_cast<char*>(to) + from;
    if (!read_fully(file_.get(), at_ + from, piece, n)) read = false;
    keys[static_cast<std::size_t>(i)] = key_of(piece, n);
  };
  parallel_for(static_cast<int>(keys.size()), bytes < kWorthThreads ? 1 : 0, read_piece, {});
  sum_.add(keys.data(), keys.size() * sizeof(ContentKey));
  at_ += bytes;
  return read || (sound_ = false);
}

bool CacheReader::done() {
  ContentKey stored;
  if (!sound_ || left_ != 0 || !read_fully(file_.get(), at_, &stored, sizeof stored) || stored != sum_.key())
    return false;
  std::error_code none;
  fs::last_write_time(path_, fs::file_time_type::clock::now(), none);
  return true;
}

CacheWriter::CacheWriter(const CacheName& name) : path_(file_of(name)) {
  static std::atomic<unsigned> count{0};
  std::error_code none;
  fs::create_directories(folder(), none);
  partial_ = path_ + "." + std::to_string(::getpid()) + "-" + std::to_string(count++);
  file_ = FileDescriptor(above_standard(::open(partial_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666)));
  failed_ = file_.get() < 0;
  const Header header = header_of(name);
  sum_.add(&header, sizeof header);
  write(&header, sizeof header);
}

CacheWriter::~CacheWriter() {
  std::error_code none;
  if (!kept_) fs::remove(partial_, none);
}

void CacheWriter::put_block(const void* data, std::uint64_t count, std::size_t element) {
  const BlockHead head{element, count};
  sum_.add(&head, sizeof head);
  write(&head, sizeof head);
  const char* at = static_cast<const char*>(data);
  for (std::size_t left = count * element; left > 0 && !failed_;) {
    const std::size_t n = std::min(left, kPiece);
    const ContentKey key = key_of(at, n);
    sum_.add(&key, sizeof key);
    write(at, n);
    at += n;
    left -= n;
  }
}

void CacheWriter::write(const void* data, std::size_t bytes) {
  const char* at = static_cast<const char*>(data);
  while (bytes > 0 && !failed_) {
    const ssize_t written = ::write(file_.get(), at, bytes);
    if (written < 0 && errno == EINTR) continue;
    failed_ = written <= 0;
    if (failed_) return;
    at += written;
    bytes -= static_cast<std::size_t>(written);
  }
}

void CacheWriter::keep() {
  const ContentKey key = sum_.key();
  write(&key, sizeof key);
  failed_ = failed_ || ::close(file_.release()) != 0;
  if (failed_) return;
  std::error_code error;
  fs::rename(partial_, path_, error);
  kept_ = !error;
  if (kept_) make_room();
}

}  // namespace tegotae
