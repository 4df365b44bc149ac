// The public API on one page, docs/api.md: every public header without what users do not read (includes, guards,
// private members). `api_page HEADERS_FOLDER` prints the page; the test compares it with the one in docs.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

// In the order in which they build on each other.
const std::vector<std::string> kParts = {"core", "mesh",    "device",   "record", "narrowphase", "contact",
                                         "lp",   "resolve", "coupling", "servo",  "sim"};

bool starts_with(const std::string& s, const std::string& prefix) {
  return s.rfind(prefix, 0) == 0;
}

/// Whether a line of a header has no place on the page.
bool is_frame(const std::string& line) {
  return starts_with(line, "#pragma once") || starts_with(line, "#include") ||
         starts_with(line, "namespace tegotae TEGOTAE_EXPORT") || starts_with(line, "}  // namespace tegotae");
}

/// The header's lines; private sections end with their class.
std::vector<std::string> public_lines(const fs::path& header) {
  std::vector<std::string> lines;
  std::ifstream in(header);
  bool hidden = false;
  for (std::string line; std::getline(in, line);) {
    if (line == " private:") hidden = true;
    if (line == "};") hidden = false;
    if (hidden || is_frame(line)) continue;
    const bool empty = line.empty();
    if (empty && (lines.empty() || lines.back().empty())) continue;
    if (line == "};" && !lines.empty() && lines.back().empty()) lines.pop_back();
    lines.push_back(line);
  }
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: api_page include/tegotae\n";
    return 2;
  }
  const fs::path root = argv[1];
  std::cout
      << "# Public interface\n\n"
         "Everything that a program may use, header by header, made from `include/tegotae/` by "
         "`cmake --build build/release --target api`.\n"
         "All of it is in the namespace `tegotae`. SI units everywhere; `X_WF` is the pose of frame F in the world.\n"
         "What may change from version to version: [package](package.md).\n";
  for (const auto& entry : fs::directory_iterator(root)) {
    if (std::find(kParts.begin(), kParts.end(), entry.path().filename().string()) == kParts.end()) {
      std::cerr << "api_page: " << entry.path().string() << " has no place on the page\n";
      return 1;
    }
  }
  for (const std::string& part : kParts) {
    std::vector<fs::path> headers;
    if (!fs::exists(root / part)) continue;
    for (const auto& entry : fs::directory_iterator(root / part)) headers.push_back(entry.path());
    std::sort(headers.begin(), headers.end());
    std::cout << "\n## " << part << "\n";
    for (const fs::path& header : headers) {
      std::cout << "\n### `tegotae/" << part << "/" << header.filename().string() << "`\n```cpp\n";
      for (const std::string& line : public_lines(header)) std::cout << line << "\n";
      std::cout << "```\n";
    }
  }
}
