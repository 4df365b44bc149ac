#include "import/import_notes.hpp"

#include <algorithm>

#include "core/number_text.hpp"

namespace tegotae {
namespace {

constexpr std::size_t kNamed = 3;

/// `things` with something between them that they do not have themselves.
std::string list(const std::vector<std::string>& things) {
  const bool has_comma =
      std::any_of(things.begin(), things.end(), [](const auto& t) { return t.find(',') != std::string::npos; });
  std::string text;
  for (const std::string& thing : things) text += (text.empty() ? "" : has_comma ? "; " : ", ") + thing;
  return text;
}

std::string with_value(std::string text, double m) {
  const std::size_t at = text.find("%s");
  if (at == std::string::npos) return text;
  return text.replace(at, 2, number_text(1e6 * m, 3) + " um");
}

}  // namespace

void ImportNotes::add(const NoteText& text, const std::string& thing, double value) {
  auto said = std::find_if(said_.begin(), said_.end(), [&](const Said& s) { return s.text == &text; });
  if (said == said_.end()) said = said_.insert(said_.end(), Said{&text, {}});
  ++said->count;
  said->largest = std::max(said->largest, value);
  if (said->first.size() < kNamed) said->first.push_back(thing);
}

void ImportNotes::write_to(std::vector<std::string>& notes) const {
  for (const Said& said : said_) {
    const NoteText& text = *said.text;
    std::string line = said.count == 1 ? text.one + said.first[0]
                                       : std::to_string(said.count) + ' ' + text.many + " (" + list(said.first) +
                                             (said.count > kNamed ? ", ..." : "") + ')';
    notes.push_back(line + ": " + with_value(text.what, said.largest) + "; " + text.advice);
  }
}

}  // namespace tegotae
