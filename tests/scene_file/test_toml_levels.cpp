#include <string>

#include "catch.hpp"
#include "scene_file/toml_levels.hpp"
#include "scene_file/toml_table.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using Catch::Contains;

namespace {

std::string key(int levels, const std::string& level = "a") {
  std::string text = level;
  for (int i = 1; i < levels; ++i) text += "." + level;
  return text;
}

std::string repeated(const std::string& what, int times) {
  std::string text;
  for (int i = 0; i < times; ++i) text += what;
  return text;
}

}  // namespace

TEST_CASE("keys, headers and brackets of more levels than any scene has are refused before they are parsed", "[toml]") {
  for (const int levels : {34, 300, 3000, 20'000, 100'000}) {
    CAPTURE(levels);
    const std::string deep = key(levels), spaced = key(levels, " a "), quoted = key(levels, "\"a.]#\"");
    for (const std::string& text :
         {deep + "=1", spaced + "=1", quoted + "=1", "[" + deep + "]", "[[" + deep + "]]", "x = {" + deep + " = 1}",
          "x = [1, {" + deep + " = 1}]", repeated("[", levels), "x = " + repeated("[", levels),
          "x = " + repeated("{ a = ", levels), "x = '\"'\n" + deep + "=1", "x = \"\\\"'\"\n" + deep + "=1",
          "x = \"\"\"\n'\"\\\"\"\"\"\n" + deep + "=1", "x = [\"\"\"a\"\"\"\"\", {" + deep + " = 1}]",
          "x = ['''a''''', {" + deep + " = 1}]", "# \"\n" + deep + "=1"}) {
      CAPTURE(text.substr(0, 60));
      CHECK_THROWS_WITH(parse_toml(text, "scene.toml"), Contains("scene.toml:") && Contains("more than 32"));
    }
  }
}

TEST_CASE("what only looks like levels is let pass", "[toml]") {
  const std::string dots = repeated(".", 1000), brackets = repeated("[{", 1000);
  for (const std::string& text :
       {"a = 1.5\nb = [" + repeated("1.5, ", 5000) + "]\n", "# " + dots + brackets + "\na = 1\n",
        "a = \"" + dots + brackets + "\"\n", "a = '" + dots + brackets + "'\n",
        "a = \"\"\"\n" + dots + "\n" + brackets + "\"\"\"\n", "a = '''\n" + dots + "\n" + brackets + "'''\n",
        repeated("[[part]]\nname = \"a.b\"\nposition = [0.1, 0.2, 0.3]\n", 2000), key(32) + " = 1\n",
        "a = " + repeated("[", 32) + repeated("]", 32) + "\n"}) {
    CAPTURE(text.substr(0, 60));
    CHECK_NOTHROW(parse_toml(text, "scene.toml"));
  }
}

TEST_CASE("what is refused names its line", "[toml]") {
  CHECK_THROWS_WITH(parse_toml("a = 1\nb = \"\"\"\n\n\"\"\"\n" + key(100) + " = 1\n", "s.toml"), Contains("s.toml:5:"));
  CHECK_THROWS_WITH(parse_toml(std::string((std::size_t{1} << 26) + 1, '\n'), "s.toml"), Contains("64 MB"));
}
