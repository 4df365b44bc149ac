#include "cli/scene_writer.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <filesystem>
#include <set>
#include <vector>

#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/import/write.hpp"

namespace tegotae::apps {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t kLongestName = 60;  // of a file, without its extension

/// `name` in letters, digits and - _ . that every file system takes; different in more than case from those in `used`.
std::string file_name(const std::string& name, std::set<std::string>& used) {
  std::string stem;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = byte < 0x80 && (std::isalnum(byte) != 0 || c == '-' || c == '.');
    if (plain)
      stem.push_back(c);
    else if (stem.empty() || stem.back() != '_')
      stem.push_back('_');
  }
  stem = stem.substr(0, kLongestName);
  const auto trim = [](char c) { return c == '.' || c == '_'; };
  while (!stem.empty() && trim(stem.back())) stem.pop_back();
  stem.erase(stem.begin(), std::find_if_not(stem.begin(), stem.end(), trim));
  if (stem.empty()) stem = "part";
  std::string unique = stem;
  const auto key = [](std::string s) {
    std::transform(s.begin(), s.end(), s.begin(), [](unsigned char c) { return std::tolower(c); });
    return s;
  };
  for (int i = 2; !used.insert(key(unique)).second; ++i) unique = stem + "_" + std::to_string(i);
  return unique + ".ply";
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += std::string("\\") + c;
    } else if (byte < 0x20 || byte == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04X", unsigned{byte});
      out += escape;
    } else {
      out.push_back(c);
    }
  }
  return out + '"';
}

/// Digits that read back as the same number.
std::string digits(double value) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value + 0.0);
  std::string out(text.data(), end);
  // TOML wants a digit on both sides of a point and takes an integer for a number; 1e-05 is fine as it is.
  return error == std::errc() ? out : "0";
}

template <typename List>
std::string list_of(const List& numbers) {
  std::string out;
  for (const double n : numbers) out += (out.empty() ? "" : ", ") + digits(n);
  return "[" + out + "]";
}

std::string part_text(const AssemblyPart& part, const std::string& mesh, bool held) {
  std::string text = "\n[[part]]\nname = " + quoted(part.name) + "\nmesh = " + quoted("meshes/" + mesh) + "\n";
  if (held) text += "held = true\n";
  if (!part.path.empty()) {
    std::string groups;
    for (const std::string& group : part.path) groups += (groups.empty() ? "" : ", ") + quoted(group);
    text += "path = [" + groups + "]\n";
  }
  if (part.color) {
    std::vector<double> c(part.color->begin(), part.color->end());
    for (double& x : c) x = std::round(1e4 * x) / 1e4;  // more than any screen shows
    if (c[3] == 1) c.pop_back();
    text += "color = " + list_of(c) + "\n";
  }
  const Pose& X = part.pose;
  if (!X.p.isZero(0)) text += "position = " + list_of(std::array<double, 3>{X.p.x(), X.p.y(), X.p.z()}) + "\n";
  if (!X.q.vec().isZero(0))
    text += "orientation = " + list_of(std::array<double, 4>{X.q.w(), X.q.x(), X.q.y(), X.q.z()}) + "\n";
  return text;
}

}  // namespace

void write_scene(const Assembly& assembly, const std::string& source, const std::string& folder,
                 const std::string& hold,
                 const std::function<void(const char* what, std::size_t done, std::size_t total)>& progress) {
  const fs::path meshes = fs::path(folder) / "meshes";
  make_folder(meshes.string());
  const double unit = unit_length(assembly.unit);
  std::set<std::string> used;
  std::vector<std::string> files;
  for (const auto& shape : assembly.shapes) {
    if (progress) progress("writing meshes", files.size(), assembly.shapes.size());
    files.push_back(file_name(shape->name, used));
    const std::string mesh = (meshes / files.back()).string();
    refuse_to_replace(mesh, {source});
    write_ply(*shape, mesh, unit);
  }
  std::string text = "unit = " + quoted(assembly.unit) + "\n";
  if (assembly.up != UpAxis::z) text += "up = " + quoted(to_string(assembly.up)) + "\n";
  for (const AssemblyPart& part : assembly.parts)
    text += part_text(part, files[part.shape], !hold.empty() && part.name == hold);
  write_file((fs::path(folder) / "scene.toml").string(), text);
}

}  // namespace tegotae::apps
