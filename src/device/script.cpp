#include "tegotae/device/script.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>

#include "core/valid_pose.hpp"
#include "core/wide_text.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

// Shorter quaternions are not a rotation but a forgotten column; files round to a few digits at worst.
constexpr double kMinQuaternionNorm = 1e-3;
// The square of a longer one overflows.
constexpr double kMaxQuaternionNorm = 1e100;

// No hand moves at this speed (m/s, rad/s); beyond it, numbers run out.
constexpr double kFastest = 1e12, kHalfTurn = 3.15;

// What spreadsheets write in front of UTF-8.
constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

constexpr std::array<std::string_view, 8> kColumns = {"t", "px", "py", "pz", "qw", "qx", "qy", "qz"};
// In place of the index of a column: it is not one of them, and is not read.
constexpr std::size_t kOther = kColumns.size();

/// `text` as a message shows it: on one line.
std::string shown(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return line;
}

std::string_view trimmed(std::string_view s) {
  const std::size_t first = s.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return s.substr(first, s.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (;;) {
    // A cell in quotes may have commas; quotes in it are doubled, so that they come in pairs.
    std::size_t comma = line.find_first_of(",\"");
    for (bool quoted = false; comma != std::string_view::npos && (quoted || line[comma] == '"');
         comma = line.find_first_of(",\"", comma + 1))
      if (line[comma] == '"') quoted = !quoted;
    std::string_view cell = trimmed(line.substr(0, comma));
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"') cell = trimmed(cell.substr(1, cell.size() - 2));
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

/// Why `key` cannot follow `previous` (null: it is the first); empty when it can.
std::string refusal(const StylusScript::Key& key, const StylusScript::Key* previous) {
  if (!std::isfinite(key.t) || !key.pose.p.allFinite() || !key.pose.q.coeffs().allFinite())
    return "a value is not finite";
  if (!within_reach(key.pose.p)) return "the position lies beyond 10 km; positions are in m";
  const double norm = key.pose.q.coeffs().stableNorm();
  if (norm < kMinQuaternionNorm) return "the quaternion is zero";
  if (norm > kMaxQuaternionNorm) return "the quaternion is too long";
  if (previous == nullptr) return {};
  const double dt = key.t - previous->t;
  if (!(dt > 0)) return "the time does not increase";
  // A half turn at most; velocities that are not numbers make poses that are none.
  const double speed = ((key.pose.p - previous->pose.p).cwiseAbs().maxCoeff() + kHalfTurn) / dt;
  if (!(speed <= kFastest)) return "the way from the key before is too fast";
  return {};
}

/// For each cell of the header row the index into kColumns; where `others` may be, of those kOther. Throws the reason.
std::vector<std::size_t> read_header(const std::vector<std::string_view>& cells, bool others) {
  std::vector<std::size_t> order;
  for (std::string_view cell : cells) {
    const auto found = std::find(kColumns.begin(), kColumns.end(), cell);
    if (found == kColumns.end() && others) {
      order.push_back(kOther);
      continue;
    }
    if (found == kColumns.end())
      throw Error("unknown column \"" + shown(cell) + "\"; the header row is t,px,py,pz,qw,qx,qy,qz");
    const std::size_t column = found - kColumns.begin();
    if (std::find(order.begin(), order.end(), column) != order.end())
      throw Error("column " + std::string(cell) + " comes twice");
    order.push_back(column);
  }
  for (std::size_t column = 0; column < kColumns.size(); ++column)
    if (std::find(order.begin(), order.end(), column) == order.end())
      throw Error("column " + std::string(kColumns[column]) + " is missing");
  return order;
}

StylusScript::Key read_row(const std::vector<std::string_view>& cells, const std::vector<std::size_t>& order) {
  if (cells.size() != order.size())
    throw Error(std::to_string(cells.size()) + " values where the header row has " + std::to_string(order.size()));
  std::array<double, kColumns.size()> value{};
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (order[i] == kOther) continue;
    const char *begin = cells[i].data(), *end = begin + cells[i].size();
    if (cells[i].size() > 1 && begin[0] == '+' && begin[1] != '-') ++begin;  // from_chars takes no plus
    const auto [rest, error] = std::from_chars(begin, end, value[order[i]]);
    if (error != std::errc() || rest != end)
      throw Error(std::string(kColumns[order[i]]) + " is not a number: \"" + shown(cells[i]) + "\"");
  }
  return {value[0], {Quat(value[4], value[5], value[6], value[7]), Vec3(value[1], value[2], value[3])}};
}

std::string read_all(const std::string& path, const std::string& what) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw Error(ErrorKind::file, path + ": cannot be opened as a " + what, {path, 0, {}, {}});
  std::ostringstream text;
  if (file.peek() != std::ifstream::traits_type::eof()) text << file.rdbuf();
  if (file.bad() || text.bad()) throw Error(ErrorKind::file, path + ": cannot be read as a " + what, {path, 0, {}, {}});
  std::string bytes = text.str();
  if (const char* encoding = wide_encoding(bytes))
    throw Error(ErrorKind::file, path + ": its text is in " + encoding + ": save it as UTF-8", {path, 0, {}, {}});
  return bytes;
}

/// Lines end as on any system, with CR, LF or both.
std::string_view take_line(std::string_view& rest) {
  const std::string_view line = rest.substr(0, rest.find_first_of("\r\n"));
  rest.remove_prefix(line.size());
  rest.remove_prefix(std::min<std::size_t>(rest.substr(0, 2) == "\r\n" ? 2 : 1, rest.size()));
  return line;
}

/// What a file is, for its messages, and whether it may have more columns.
struct KeyFile {
  std::string what;
  bool others;
};

std::vector<StylusScript::Key> read_keys(const std::string& path, const KeyFile& kind) {
  const std::string bytes = read_all(path, kind.what);
  std::string_view rest = bytes;
  if (rest.substr(0, kByteOrderMark.size()) == kByteOrderMark) rest.remove_prefix(kByteOrderMark.size());
  std::vector<std::size_t> order;
  std::vector<StylusScript::Key> keys;
  for (int number = 1; !rest.empty(); ++number) {
    const std::string_view text = trimmed(take_line(rest));
    if (text.empty() || text.front() == '#') continue;
    try {
      if (order.empty()) {
        order = read_header(split(text), kind.others);
        continue;
      }
      keys.push_back(read_row(split(text), order));
      const std::string reason = refusal(keys.back(), keys.size() > 1 ? &keys[keys.size() - 2] : nullptr);
      if (!reason.empty()) throw Error(reason);
    } catch (const Error& error) {
      throw Error(ErrorKind::file, path + ":" + std::to_string(number) + ": " + error.what(), {path, number, {}, {}});
    }
  }
  if (order.empty())
    throw Error(ErrorKind::file,
                path + ": empty; a " + kind.what + " begins with the header row t,px,py,pz,qw,qx,qy,qz",
                {path, 0, {}, {}});
  if (keys.empty()) throw Error(ErrorKind::file, path + ": no row after the header row", {path, 0, {}, {}});
  return keys;
}

}  // namespace

StylusScript::StylusScript(std::vector<Key> keys) : keys_(std::move(keys)) {
  if (keys_.empty()) throw Error(ErrorKind::setting, "stylus script: no key");
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const std::string reason = refusal(keys_[i], i > 0 ? &keys_[i - 1] : nullptr);
    if (!reason.empty()) throw Error(ErrorKind::setting, "stylus script: key " + std::to_string(i + 1) + ": " + reason);
    keys_[i].pose.q.normalize();
  }
  for (std::size_t i = 0; i + 1 < keys_.size(); ++i) {
    const double dt = keys_[i + 1].t - keys_[i].t;
    const Displacement d = displacement(keys_[i].pose, keys_[i + 1].pose, Vec3::Zero());
    rates_.push_back({d.dp / dt, d.dr / dt});
  }
  rates_.push_back({});
}

std::size_t StylusScript::interval(double t) const noexcept {
  const auto after =
      std::upper_bound(keys_.begin(), keys_.end(), t, [](double s, const Key& key) { return s < key.t; });
  return after == keys_.begin() ? 0 : after - keys_.begin() - 1;
}

Pose StylusScript::pose(double t) const noexcept {
  const std::size_t i = interval(t);
  const double s = std::max(0.0, t - keys_[i].t);
  return displaced(keys_[i].pose, Vec3::Zero(), {s * rates_[i].v, s * rates_[i].w});
}

Twist StylusScript::velocity(double t) const noexcept {
  if (!(t >= begin())) return {};
  return rates_[interval(t)];
}

StylusScript read_script(const std::string& path) {
  return StylusScript(read_keys(path, {"stylus script", false}));
}

std::vector<Pose> read_path(const std::string& path) {
  // Run and page read a guide several times, and a pipe can be read once.
  std::error_code none;
  if (std::filesystem::exists(path, none) && !std::filesystem::is_regular_file(path, none))
    throw Error(ErrorKind::file, path + ": is not a regular file, as a path has to be; save it to one",
                {path, 0, {}, {}});
  std::vector<Pose> out;
  for (const StylusScript::Key& key : read_keys(path, {"path", true}))
    out.push_back({key.pose.q.normalized(), key.pose.p});
  return out;
}

}  // namespace tegotae
