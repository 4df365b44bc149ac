#include "view/recording.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include "tegotae/core/error.hpp"

namespace tegotae::view {
namespace {

constexpr const char* kColumns[] = {"tick", "substep", "t",    "y_px", "y_py", "y_pz", "y_qw", "y_qx",     "y_qy",
                                    "y_qz", "x_px",    "x_py", "x_pz", "x_qw", "x_qx", "x_qy", "x_qz",     "fx",
                                    "fy",   "fz",      "tx",   "ty",   "tz",   "contacts", "gap", "tick_us"};
constexpr std::size_t kCount = std::size(kColumns);

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> cells;
  for (std::size_t comma; (comma = line.find(',')) != line.npos; line.remove_prefix(comma + 1))
    cells.push_back(line.substr(0, comma));
  cells.push_back(line);
  return cells;
}

std::vector<std::size_t> places(const std::vector<std::string_view>& header) {
  std::vector<std::size_t> order;
  for (const char* name : kColumns) {
    const auto at = std::find(header.begin(), header.end(), name);
    if (at == header.end()) throw Error(std::string("column ") + name + " is missing; this is no recording");
    order.push_back(static_cast<std::size_t>(at - header.begin()));
  }
  return order;
}

double number(std::string_view cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  // A denormal number is out of range for some readers and fine as zero.
  if (error == std::errc::result_out_of_range) return 0;
  if (error != std::errc() || end != cell.data() + cell.size())
    throw Error("\"" + std::string(cell) + "\" is not a number");
  return value;
}

Pose pose(const double* v) {
  return {Quat(v[3], v[4], v[5], v[6]).normalized(), Vec3(v[0], v[1], v[2])};
}

RecordFrame frame_of(const std::vector<std::string_view>& cells, const std::vector<std::size_t>& order) {
  double v[kCount];
  for (std::size_t i = 0; i < kCount; ++i) v[i] = number(cells[order[i]]);
  RecordFrame f;
  f.tick = static_cast<std::uint64_t>(v[0]);
  f.substep = static_cast<std::uint32_t>(v[1]);
  f.t = v[2];
  f.y = pose(v + 3);
  f.x = pose(v + 10);
  f.wrench = {Vec3(v[17], v[18], v[19]), Vec3(v[20], v[21], v[22])};
  f.contacts = static_cast<int>(v[23]);
  f.gap = v[24];
  f.tick_us = v[25];
  if (!f.x.p.allFinite() || !f.y.p.allFinite() || !f.x.q.coeffs().allFinite() || !f.y.q.coeffs().allFinite() ||
      !(std::abs(f.t) < 1e9))
    throw Error("a pose or time is not finite");
  return f;
}

}  // namespace

std::vector<RecordFrame> read_recording(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  if (!file || !std::getline(file, line)) throw Error(path + ": cannot be read as a recording");
  int number_of_line = 1;
  try {
    const std::vector<std::string_view> header = split(line);
    const std::size_t width = header.size();
    const std::vector<std::size_t> order = places(header);
    std::vector<RecordFrame> frames;
    while (std::getline(file, line)) {
      ++number_of_line;
      if (file.eof()) break;  // no line end: the writer was killed here
      const std::vector<std::string_view> cells = split(line);
      if (cells.size() != width) throw Error("has " + std::to_string(cells.size()) + " columns, not " + std::to_string(width));
      frames.push_back(frame_of(cells, order));
    }
    if (frames.empty()) throw Error("no rows");
    return frames;
  } catch (const Error& e) {
    throw Error(path + ":" + std::to_string(number_of_line) + ": " + e.what());
  }
}

}  // namespace tegotae::view
