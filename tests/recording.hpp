// Reads recordings as another program would: columns by name.
#pragma once

#include <cstdlib>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "apps/run_program.hpp"
#include "tegotae/core/pose.hpp"

namespace tegotae::test {

struct RecordedRow {
  double t = 0;
  Pose x;  ///< of the held part's file frame
  int contacts = 0;
};

/// The rows of the recording at `path`. Throws std::out_of_range when a column is missing.
inline std::vector<RecordedRow> read_recording(const std::string& path) {
  std::istringstream in(read_text(path));
  std::string line, cell;
  std::getline(in, line);
  std::istringstream header(line);
  std::map<std::string, std::size_t> column;
  while (std::getline(header, cell, ',')) column.emplace(cell, column.size());
  std::vector<RecordedRow> rows;
  std::vector<double> v;
  while (std::getline(in, line)) {
    std::istringstream cells(line);
    v.clear();
    while (std::getline(cells, cell, ','))
      v.push_back(std::strtod(cell.c_str(), nullptr));  // stod refuses denormal numbers
    const auto at = [&](const char* name) { return v.at(column.at(name)); };
    RecordedRow row;
    row.t = at("t");
    row.x.q = Quat(at("x_qw"), at("x_qx"), at("x_qy"), at("x_qz")).normalized();
    row.x.p = Vec3(at("x_px"), at("x_py"), at("x_pz"));
    row.contacts = static_cast<int>(at("contacts"));
    rows.push_back(row);
  }
  return rows;
}

}  // namespace tegotae::test
