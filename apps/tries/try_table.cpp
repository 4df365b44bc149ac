#include "tries/try_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include "core/output_file.hpp"
#include "scene_file/scene_text.hpp"
#include "shared/format.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"

namespace tegotae::tries {
namespace {

const char* const kHeader =
    "try,operator,route,offset_m,tilt_rad,reached,time_s,depth_m,force_n,torque_nm,stuck_s,intersecting,x_m,y_m,z_m,"
    "blocked_by\n";
constexpr std::size_t kColumns = 16;

std::string digits(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

std::string quoted(const std::string& name) {
  std::string out = "\"";
  for (const char c : name) {
    const bool control = static_cast<unsigned char>(c) < 0x20;  // a row is a line
    out += c == '"' ? std::string("\"\"") : std::string(1, control ? ' ' : c);
  }
  return out + '"';
}

std::string unquoted(const std::string& text) {
  std::string out;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == '"') ++i;
    out += text[i];
  }
  return out;
}

/// The first cells are without commas and quotes, the last one is quoted.
std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out;
  std::size_t at = 0;
  while (out.size() + 1 < kColumns) {
    const std::size_t comma = line.find(',', at);
    if (comma == std::string::npos) return {};
    out.push_back(line.substr(at, comma - at));
    at = comma + 1;
  }
  out.push_back(line.substr(at));
  return out.back().size() >= 2 && out.back().front() == '"' && out.back().back() == '"' ? out
                                                                                         : std::vector<std::string>();
}

template <typename Number>
bool read_number(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(static_cast<double>(value));
}

bool read_row(const std::string& line, Result& r) {
  const std::vector<std::string> c = cells(line);
  int reached = 0;
  if (c.empty() || !read_number(c[0], r.number) || !read_number(c[5], reached) || !read_number(c[11], r.intersecting) ||
      r.number < 0)
    return false;
  r.who = c[1];
  r.route = c[2];
  r.reached = reached != 0;
  r.blocked_by = unquoted(c[15]);
  const std::pair<std::size_t, double*> numbers[] = {
      {3, &r.offset}, {4, &r.tilt},   {6, &r.time},         {7, &r.depth},        {8, &r.force},
      {9, &r.torque}, {10, &r.stuck}, {12, &r.place_W.x()}, {13, &r.place_W.y()}, {14, &r.place_W.z()}};
  return std::all_of(std::begin(numbers), std::end(numbers),
                     [&](const auto& n) { return read_number(c[n.first], *n.second); });
}

std::string row(const Result& r) {
  std::string text = std::to_string(r.number) + ',' + r.who + ',' + r.route;
  for (const double x : {r.offset, r.tilt}) text += ',' + digits(x);
  text += r.reached ? ",1" : ",0";
  for (const double x : {r.time, r.depth, r.force, r.torque, r.stuck}) text += ',' + digits(x);
  text += ',' + std::to_string(r.intersecting);
  for (const double x : r.place_W) text += ',' + digits(x);
  return text + ',' + quoted(r.blocked_by) + '\n';
}

/// FNV-1a, 64 bits.
class Hash {
 public:
  void add(const void* data, std::size_t size) {
    for (const auto* p = static_cast<const unsigned char*>(data); size-- > 0; ++p)
      value_ = (value_ ^ *p) * 0x100000001b3u;
  }
  void add(double x) { add(&x, sizeof x); }
  void add(const std::string& text) { add(text.data(), text.size() + 1); }
  void add(const Pose& X) {
    for (const double x : X.p) add(x);
    for (const double x : X.q.coeffs()) add(x);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace

std::string fingerprint(const Task& task) {
  Hash hash;
  for (const Part& part : task.file.scene.parts) {
    hash.add(part.name);
    hash.add(part.pose);
    hash.add(part.held ? 1.0 : 0.0);
    for (const Vec3& v : part.mesh->vertices)
      for (const double x : v) hash.add(x);
    for (const auto& t : part.mesh->triangles) hash.add(t.data(), sizeof t);
  }
  const Scene& s = task.file.scene;
  hash.add(to_string(s.contact.resolver));
  hash.add(std::string(s.contact.narrowphase == NarrowPhase::fcl ? "fcl" : "patch"));
  for (const double x :
       {s.contact.l_min.value_or(-1), s.contact.l_0.value_or(-1), s.contact.density, s.coupling.stiffness,
        s.coupling.damping, s.coupling.torsional_stiffness, s.coupling.torsional_damping,
        s.max_torsional_stiffness.value_or(-1), task.file.safety.limits.force, task.file.safety.limits.torque,
        task.file.safety.continuous_force, task.seconds})
    hash.add(x);
  hash.add(scene_settings(task.file));  // whatever the file sets, known here or not
  hash.add(task.file.script.pose(task.file.script.end()));
  return apps::format("tegotae %s, seed %llu, task %016llx", TEGOTAE_VERSION_STRING,
                      static_cast<unsigned long long>(task.seed), static_cast<unsigned long long>(hash.value()));
}

TryTable::TryTable(const std::string& folder, const std::string& task)
    : path_(folder + "/tries.csv"), task_("# " + task) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw Error(folder + ": cannot be made: " + failed.message());
  if (std::filesystem::exists(path_)) read();
}

void TryTable::read() {
  std::ifstream in(path_, std::ios::binary);
  std::string line;
  std::getline(in, line);
  if (line != task_)
    throw Error(
        path_ +
        ":1: holds tries of another scene, settings, goal, seed, time or version; choose another --out or delete it");
  std::getline(in, line);
  if (line + "\n" != kHeader) throw Error(path_ + ":2: has other columns; choose another --out or delete it");
  for (int number = 3; std::getline(in, line); ++number) {
    Result r;
    if (!read_row(line, r)) throw Error(path_ + ":" + std::to_string(number) + ": is no try; delete the line");
    rows_[r.number] = r;
  }
}

void TryTable::add(const Result& result) {
  rows_[result.number] = result;
  write();
}

void TryTable::write() const {
  std::string text = task_ + '\n' + kHeader;
  for (const auto& [number, result] : rows_) text += row(result);
  replace_file(path_, text);
}

}  // namespace tegotae::tries
