#include "shared/option_check.hpp"

#include <algorithm>
#include <filesystem>

namespace tegotae::apps {

namespace {

using Names = std::vector<std::string>;

std::string joined(const Names& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

/// How many letters must be put in, left out, replaced or swapped with their neighbor to make one word of the other.
std::size_t typing_errors(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i)
    for (std::size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

/// "; did you mean NAME?" of the name that is most like `word`, or that begins with it; "" when none is.
std::string suggestion(const std::string& word, const Names& names) {
  const std::size_t most = word.size() < 5 ? 1 : word.size() < 12 ? 2 : 3;
  std::string best;
  std::size_t least = most + 1;
  for (const std::string& name : names) {
    if (name.size() < 3) continue;  // is seen in the list
    const bool begun = word.size() > 3 && name.rfind(word, 0) == 0;
    const std::size_t errors = begun ? most : typing_errors(word, name);
    if (errors < least) best = name, least = errors;
  }
  return best.empty() ? "" : "; did you mean " + best + "?";
}

/// The command whose words were read last.
const CLI::App& innermost(const CLI::App& app) {
  const auto parsed = app.get_subcommands();
  return parsed.empty() ? app : innermost(*parsed.back());
}

Names options_of(const CLI::App& app) {
  Names names;
  for (const CLI::Option* option : app.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// The first word that begins like an option and is a file here.
std::string file_with_dash(int argc, char** argv) {
  std::error_code none;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.size() > 1 && word.front() == '-' && std::filesystem::exists(word, none)) return word;
  }
  return {};
}

std::string unknown_option(const std::string& word, const CLI::App& app) {
  const std::string name = word.substr(0, word.find('=')), command = app.get_parent() ? " for " + app.get_name() : "";
  return "there is no option " + name + command + suggestion(name, options_of(app));
}

/// Of an option that is not there, or with `all` of any words that nothing was read from; "" when there are none.
std::string unused_words(const CLI::App& app, bool all) {
  const Names words = app.remaining(true);
  const CLI::App& command = innermost(app);
  for (const std::string& word : words)
    if (word.rfind("-", 0) == 0) return unknown_option(word, command);
  return all ? command.get_name() + " has no use for " + joined(words) : "";
}

std::string unknown_command(const std::string& given, const CLI::App& app, const Names& commands) {
  if (given.empty()) return "no command is given; there are " + joined(commands);
  if (given.front() == '-') return unknown_option(given, app);
  const std::string near = suggestion(given, commands);
  return "there is no command " + given + (near.empty() ? ", but " : near + " There are ") + joined(commands);
}

/// Of an option that has too few values or too many: "NAME: 1 required FILE missing", "NAME: At least 2 required but
/// received 1", "NAME: At Most 1 required but received 2".
std::string wrong_count(const std::string& text) {
  const std::size_t name = text.find(": "), required = text.find(" required ");
  if (name == text.npos || required == text.npos) return text;
  const std::string option = text.substr(0, name), least = "At least ";
  if (text.compare(name + 2, least.size(), least) == 0) {
    const std::size_t number = name + 2 + least.size();
    return option + " needs " + text.substr(number, required - number) + " values";
  }
  const std::size_t type = required + std::string(" required ").size(), missing = text.rfind(" missing");
  return option + (missing != text.npos ? " needs " + text.substr(type, missing - type) : " is given more than once");
}

}  // namespace

CLI::Validator one_of(const std::vector<std::string>& names) {
  const auto check = [names](const std::string& text) {
    if (std::find(names.begin(), names.end(), text) != names.end()) return std::string();
    return text + " is none of " + joined(names) + suggestion(text, names);
  };
  return CLI::Validator(check, joined(names));
}

std::string usage_error(const CLI::App& app, int argc, char** argv, const CLI::ParseError& error) {
  if (const std::string dash = file_with_dash(argc, argv); !dash.empty())
    return dash + " begins like an option; write ./" + dash;
  Names commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  const std::string given = argc > 1 ? argv[1] : "";
  if (!commands.empty() && std::find(commands.begin(), commands.end(), given) == commands.end())
    return unknown_command(given, app, commands);
  const std::string text = error.what();
  // What was mistyped is told before what is missing for that reason.
  const bool extras = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr;
  if (const std::string unused = unused_words(app, extras); !unused.empty()) return unused;
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) return wrong_count(text);
  return text;
}

}  // namespace tegotae::apps
