#include "cli/dropped_file.hpp"

#include <algorithm>
#include <filesystem>

#include "import/file_check.hpp"

namespace tegotae::apps {
namespace {

bool looks_like_a_file(const std::string& given) {
  std::error_code none;
  if (std::filesystem::is_regular_file(given, none)) return true;
  const std::string ending = lower_extension(given);
  return given.find('/') != std::string::npos || is_file_of_parts(given) || ending == ".toml" || ending == ".csv" ||
         ending == ".mcap";
}

}  // namespace

std::vector<char*> with_view(const CLI::App& app, int argc, char** argv) {
  static char view[] = "view";
  std::vector<char*> words(argv, argv + argc);
  const std::string given = argc > 1 ? argv[1] : "";
  const auto commands = app.get_subcommands([&](const CLI::App* c) { return c->get_name() == given; });
  if (!given.empty() && given.front() != '-' && commands.empty() && looks_like_a_file(given))
    words.insert(words.begin() + 1, view);
  words.push_back(nullptr);
  return words;
}

}  // namespace tegotae::apps
