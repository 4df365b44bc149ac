// The public API on one page, docs/api.md: every public header without what users do not read (includes, guards,
// private members). `api_page HEADERS_FOLDER` prints the page; the test compares it with the one in docs.
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

// In the order in which they build on each other.
const std::vector<std::string> kParts = {"core",       "mesh",     "contact",     "resolve", "loop",    "coupling",
                                         "device",     "operator", "transport",   "servo",   "session", "import",
                                         "scene_file", "record",   "narrowphase", "lp"};

/// What one wants to do, and the headers for it.
struct Task {
  const char* what;
  const char* headers;  ///< with spaces between them
};
const Task kMap[] = {
    {"feel a scene with a pen: all that most programs need", "tegotae.hpp session/rig.hpp"},
    {"the same from C, C#, Rust, Unity", "tegotae.h"},
    {"describe a scene",
     "loop/scene.hpp mesh/triangle_mesh.hpp mesh/weld.hpp mesh/color.hpp import/load.hpp scene_file/scene_file.hpp "
     "import/assembly.hpp"},
    {"know a mesh before it is used",
     "mesh/report.hpp mesh/mass.hpp loop/clash.hpp import/isolated_load.hpp import/write.hpp"},
    {"use contacts", "contact/contact_point.hpp core/ids.hpp core/contact_force.hpp contact/contact.hpp"},
    {"change a scene while it runs", "loop/scene_change.hpp loop/initial_contacts.hpp"},
    {"know what a tick did, and why a part lags", "loop/haptic_loop.hpp core/lag_reason.hpp resolve/status.hpp"},
    {"bring a device",
     "device/device.hpp device/simulated_device.hpp device/openhaptics_device.hpp device/input_devices.hpp "
     "device/limits.hpp"},
    {"be the hand of a simulated pen",
     "device/script.hpp device/input_source.hpp device/input_guide.hpp operator/operator.hpp"},
    {"set the feel and the safety chain",
     "coupling/coupling.hpp coupling/stability.hpp servo/safety.hpp transport/mapping.hpp"},
    {"wire servo and contact loop by hand",
     "servo/servo.hpp transport/contact_link.hpp transport/attachment.hpp servo/realtime.hpp "
     "transport/channel.hpp coupling/contact_planes.hpp transport/servo_statistics.hpp core/latency_histogram.hpp"},
    {"write a driver in another language", "device/shm.h"},
    {"run a scene file, record it, watch it", "session/session.hpp record/recorder.hpp record/recording.hpp"},
    {"bring a resolver", "resolve/kind.hpp resolve/resolver.hpp lp/low_rank_matrix.hpp lp/friction_problem.hpp"},
    {"poses, errors, clock, version",
     "core/pose.hpp core/error.hpp core/clock.hpp core/constants.hpp core/up_axis.hpp core/version.hpp "
     "core/export.hpp"},
    {"start large scenes sooner", "narrowphase/hierarchy_cache.hpp"},
};

bool starts_with(const std::string& s, const std::string& prefix) {
  return s.rfind(prefix, 0) == 0;
}

/// Whether a line of a header has no place on the page.
bool is_frame(const std::string& line) {
  return starts_with(line, "#pragma once") || starts_with(line, "#include") ||
         starts_with(line, "#ifndef TEGOTAE_TEGOTAE_H") || starts_with(line, "#define TEGOTAE_TEGOTAE_H") ||
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

/// The headers of one folder of `root`, by name.
std::vector<fs::path> headers_in(const fs::path& root, const std::string& part) {
  std::vector<fs::path> headers;
  for (const auto& entry : fs::directory_iterator(root / part))
    if (entry.is_regular_file()) headers.push_back(entry.path());
  std::sort(headers.begin(), headers.end());
  return headers;
}

/// The anchor of a header's heading, as GitHub makes it.
std::string anchor(const std::string& header) {
  std::string out = "tegotae";
  for (const char c : header)
    if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_') out += c;
  return out;
}

/// What the folder has and the map has not, or the other way around; empty: nothing.
std::string not_in_map(const fs::path& root, const std::vector<fs::path>& headers) {
  std::set<std::string> mapped;
  for (const Task& task : kMap) {
    std::istringstream words(task.headers);
    for (std::string word; words >> word;) {
      if (!fs::is_regular_file(root / word)) return word;
      mapped.insert(word);
    }
  }
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(root)) files += entry.is_regular_file() ? 1 : 0;
  if (files != headers.size()) return "a folder of " + root.string();
  for (const fs::path& header : headers)
    if (mapped.count(fs::relative(header, root).generic_string()) == 0) return header.string();
  return "";
}

void print_map() {
  std::cout << "\n| to ... | headers under `tegotae/` |\n|---|---|\n";
  for (const Task& task : kMap) {
    std::cout << "| " << task.what << " |";
    std::istringstream words(task.headers);
    for (std::string word; words >> word;) std::cout << " [" << word << "](#" << anchor(word) << ")";
    std::cout << " |\n";
  }
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
  std::vector<fs::path> headers = headers_in(root, "");
  for (const std::string& part : kParts)
    for (const fs::path& header : headers_in(root, part)) headers.push_back(header);
  const std::string missing = not_in_map(root, headers);
  if (!missing.empty()) {
    std::cerr << "api_page: " << missing << " has no place on the page; see kMap and kParts\n";
    return 1;
  }
  print_map();
  std::string part = "-";
  for (const fs::path& header : headers) {
    const fs::path name = fs::relative(header, root);
    if (name.parent_path().string() != part) {
      part = name.parent_path().string();
      std::cout << "\n## " << (part.empty() ? "the door" : part) << "\n";
    }
    std::cout << "\n### `tegotae/" << name.generic_string() << "`\n```" << (name.extension() == ".h" ? "c" : "cpp")
              << "\n";
    for (const std::string& line : public_lines(header)) std::cout << line << "\n";
    std::cout << "```\n";
  }
}
