#include <filesystem>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "core/same_file.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using Catch::Contains;
namespace fs = std::filesystem;

TEST_CASE("a file is the same under every name", "[core]") {
  const test::TempFolder folder;
  folder.write("a", "text");
  fs::create_symlink("a", folder / "soft");
  fs::create_hard_link(folder / "a", folder / "hard");
  fs::create_directory_symlink(".", folder / "here");
  for (const char* name : {"a", "./a", "soft", "hard", "here/a", "here/./a"}) {
    CAPTURE(name);
    CHECK_THROWS_WITH(refuse_to_replace(folder / name, {folder / "x", folder / "a"}), Contains("would be replaced"));
  }
  folder.write("b", "text");  // the same content is another file
  CHECK_NOTHROW(refuse_to_replace(folder / "b", {folder / "a", "", folder / "absent"}));
  CHECK_NOTHROW(refuse_to_replace("", {folder / "a"}));
  CHECK_NOTHROW(refuse_to_replace("/dev/null", {"/dev/null"}));
  // Files that are not there yet are where they would be.
  CHECK_THROWS_WITH(refuse_to_replace({folder / "n", folder / "here/n"}, {}), Contains("writes it twice"));
  CHECK_NOTHROW(refuse_to_replace({folder / "n", folder / "m", "", ""}, {folder / "a"}));
  fs::create_symlink("n", folder / "to n");
  fs::create_symlink("here/to n", folder / "to that");
  fs::create_symlink("round", folder / "round");
  for (const char* name : {"to n", "to that", "here/to n"}) {
    CAPTURE(name);
    CHECK_THROWS_WITH(refuse_to_replace({folder / "n", folder / name}, {}), Contains("writes it twice"));
    CHECK_THROWS_WITH(refuse_to_replace({folder / name, folder / "n"}, {}), Contains("writes it twice"));
  }
  CHECK_NOTHROW(refuse_to_replace({folder / "n", folder / "round"}, {}));
}
