// A whole file is written: what stood there is never lost.
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <thread>
#include <vector>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "core/file_descriptor.hpp"
#include "core/output_file.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

/// While it lives files of this process grow to so many bytes: a write beyond fails as on a full disk.
class SizeLimit {
 public:
  explicit SizeLimit(rlim_t bytes) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit less{bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &less);
  }
  ~SizeLimit() { ::setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_{};
};

}  // namespace

TEST_CASE("a file is written whole or said not to be", "[core]") {
  const test::TempFolder folder;
  write_file(folder / "a", "one");
  CHECK(test::read_text(folder / "a") == "one");
  write_file(folder / "a", "two");
  CHECK(test::read_text(folder / "a") == "two");
  {
    const SizeLimit limit(10);
    CHECK_THROWS_WITH(write_file(folder / "a", std::string(11, 'x')),
                      Contains((folder / "a") + ": cannot be written: File too large"));
  }
  CHECK(test::read_text(folder / "a") == "two");
  CHECK_THROWS_WITH(write_file(folder / "no/a", "one"),
                    Contains((folder / "no/a") + ": cannot be written: No such file"));
  fs::create_directory(folder / "of");
  CHECK_THROWS_WITH(write_file(folder / "of", "one"), Contains("Is a directory"));
  CHECK(files_in(folder / "") == 2);  // nothing is left beside them
}

TEST_CASE("what is written beside a file takes its place with its rights", "[core]") {
  const test::TempFolder folder;
  folder.write("a", "old");
  fs::permissions(folder / "a", fs::perms(0640));
  write_file(folder / "a", "new");
  CHECK(fs::status(folder / "a").permissions() == fs::perms(0640));
  // A new file has those of every other new file.
  folder.write("b", "");
  write_file(folder / "c", "new");
  CHECK(fs::status(folder / "c").permissions() == fs::status(folder / "b").permissions());
}

TEST_CASE("symbolic links stay, and lead to what is written", "[core]") {
  const test::TempFolder folder;
  fs::create_directory(folder / "in");
  folder.write("in/a", "old");
  fs::create_symlink("in/a", folder / "soft");
  fs::create_symlink("soft", folder / "softer");
  fs::create_symlink(folder / "in/new", folder / "dangling");
  fs::create_directory_symlink("in", folder / "here");
  for (const char* name : {"soft", "softer", "here/a"}) {
    write_file(folder / name, name);
    CHECK(test::read_text(folder / "in/a") == name);
  }
  write_file(folder / "dangling", "new");
  CHECK(test::read_text(folder / "in/new") == "new");
  for (const char* name : {"soft", "softer", "dangling"}) CHECK(fs::is_symlink(folder / name));
  CHECK(files_in(folder / "in") == 2);
  fs::create_symlink("round", folder / "round");
  CHECK_THROWS_WITH(write_file(folder / "round", "x"), Contains("Too many levels of symbolic links"));
}

TEST_CASE("pipes, devices and descriptors are written into", "[core]") {
  const test::TempFolder folder;
  CHECK_THROWS_WITH(write_file("/dev/full", "one"), Contains("/dev/full: cannot be written: No space left"));
  CHECK_NOTHROW(write_file("/dev/null", "one"));
  REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
  fs::create_symlink("pipe", folder / "soft");
  const FileDescriptor reader(::open((folder / "pipe").c_str(), O_RDONLY | O_NONBLOCK));
  for (const char* name : {"pipe", "soft"}) {
    write_file(folder / name, name);
    char read[16] = {};
    CHECK(::read(reader.get(), read, sizeof read) == 4);
    CHECK(std::string(read) == name);
  }
  CHECK(fs::is_fifo(folder / "pipe"));
  // As /dev/stdout in a shell's `> file`: who else writes there has the same file.
  const FileDescriptor open(::open((folder / "out").c_str(), O_RDWR | O_CREAT, 0600));
  const std::string number = std::to_string(open.get());
  fs::create_symlink("/dev/fd/" + number, folder / "stdout");
  for (const std::string& name : {"/dev/fd/" + number, "/proc/self/fd/" + number, folder / "stdout"}) {
    write_file(name, name);
    std::string read(name.size(), ' ');
    CHECK(::pread(open.get(), read.data(), read.size(), 0) == static_cast<ssize_t>(read.size()));
    CHECK(read == name);
  }
}

TEST_CASE("of files that are written at once one is there, whole", "[core]") {
  const test::TempFolder folder;
  const std::size_t size = 1 << 20;
  std::vector<std::thread> threads;
  for (const char letter : {'a', 'b', 'c', 'd'})
    threads.emplace_back([&, letter] { write_file(folder / "a", std::string(size, letter)); });
  for (std::thread& thread : threads) thread.join();
  const std::string text = test::read_text(folder / "a");
  CHECK(text == std::string(size, text.empty() ? ' ' : text[0]));
  CHECK(files_in(folder / "") == 1);
}

TEST_CASE("a file that is not to be written into is not replaced", "[core]") {
  const test::TempFolder folder;
  folder.write("a", "old");
  fs::permissions(folder / "a", fs::perms(0444));
  fs::permissions(folder / "", fs::perms(0777));
  const bool root = ::geteuid() == 0;  // who may write everywhere
  if (root) REQUIRE(::seteuid(65534) == 0);
  CHECK_THROWS_WITH(write_file(folder / "a", "new"), Contains("Permission denied"));
  CHECK_NOTHROW(write_file(folder / "b", "new"));
  if (root) REQUIRE(::seteuid(0) == 0);
  CHECK(test::read_text(folder / "a") == "old");
  CHECK(test::read_text(folder / "b") == "new");
}
