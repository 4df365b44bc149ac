#include "study/case_table.hpp"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/output_file.hpp"
#include "shared/csv_cell.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::study {
namespace {

namespace fs = std::filesystem;

const char* const kColumns =
    "operator,route,offset_m,tilt_rad,reached,time_s,depth_m,force_n,torque_nm,stuck_s,intersecting,x_m,y_m,z_m,"
    "blocked_by,clearance_m,why";
constexpr std::size_t kResultCells = 17;
constexpr int kWriteShare = 9;  // times as long as a write took, nothing is written after it
const char* const kEnding = ".partial";

/// The cells of a line; none where its quotes are not those of a table.
std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> out;
  for (std::size_t at = 0;;) {
    std::string text;
    if (at < line.size() && line[at] == '"') {
      for (++at;; ++at) {
        if (at == line.size()) return {};
        if (line[at] == '"' && (at + 1 == line.size() || line[at + 1] != '"')) break;
        if (line[at] == '"') ++at;
        text += line[at];
      }
      ++at;
    } else {
      const std::size_t comma = std::min(line.find(',', at), line.size());
      text = line.substr(at, comma - at);
      if (text.find('"') != std::string::npos) return {};
      at = comma;
    }
    out.push_back(text);
    if (at == line.size()) return out;
    if (line[at] != ',') return {};
    ++at;
  }
}

template <typename Number>
bool read_number(const std::string& text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(static_cast<double>(value));
}

std::string header(const TableLayout& layout) {
  std::string text = layout.number;
  for (const std::string& name : layout.parameters) text += ',' + apps::csv_cell(name);
  return text + ',' + kColumns;
}

std::string host() {
  char name[256] = {};
  if (::gethostname(name, sizeof name - 1) != 0) return "host";
  return name;
}

/// What a process of this machine was writing beside `path`.
std::string partial_start(const std::string& path) {
  return fs::path(path).filename().string() + "." + host() + "-";
}

/// Removes what processes of this machine that are gone were writing.
void remove_left(const std::string& path) {
  const std::string start = partial_start(path);
  std::error_code ignored;  // what is left does no harm
  for (const auto& entry : fs::directory_iterator(fs::path(path).parent_path() / ".", ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(start, 0) != 0 || entry.path().extension() != kEnding) continue;
    pid_t process = 0;
    const char* const end = name.data() + name.size() - std::string(kEnding).size();
    const auto [last, error] = std::from_chars(name.data() + start.size(), end, process);
    if (error != std::errc() || last != end || process <= 0) continue;
    if (::kill(process, 0) != 0 && errno == ESRCH) fs::remove(entry.path(), ignored);
  }
}

/// For a file that processes of several machines may replace; what a killed one leaves is found by remove_left().
void replace_shared(const std::string& path, const std::string& text) {
  const std::string partial = partial_start(path) + std::to_string(::getpid()) + kEnding;
  write_file_by((fs::path(path).parent_path() / partial).string(), path, text);
}

}  // namespace

std::string row_text(const Result& r) {
  std::string text = std::to_string(r.number);
  for (const std::string& parameter : r.parameters) text += ',' + apps::csv_cell(parameter);
  text += ',' + apps::csv_cell(r.who) + ',' + apps::csv_cell(r.route);
  for (const double x : {r.offset, r.tilt}) text += ',' + digits(x);
  text += r.reached ? ",1" : ",0";
  for (const double x : {r.time, r.depth, r.force, r.torque, r.stuck}) text += ',' + digits(x);
  text += ',' + std::to_string(r.intersecting);
  for (const double x : r.place_W) text += ',' + digits(x);
  return text + ',' + apps::csv_quoted(r.blocked_by) + ',' + digits(r.clearance) + ',' + apps::csv_quoted(r.why);
}

std::string table_text(const TableLayout& layout, const std::map<int, Result>& rows) {
  std::string text = "# " + layout.task + '\n' + header(layout) + '\n';
  for (const auto& [number, result] : rows) text += row_text(result) + '\n';
  return text;
}

CaseTable::CaseTable(std::string path, TableLayout layout) : path_(std::move(path)), layout_(std::move(layout)) {
  const fs::path folder = fs::path(path_).parent_path();
  make_folder(folder.empty() ? "." : folder.string());
  remove_left(path_);
  if (fs::exists(path_)) read();
}

void CaseTable::read() {
  std::ifstream in(path_, std::ios::binary);
  std::string line;
  std::getline(in, line);
  // Also of an empty file: what was cut off tells nothing of what it holds.
  if (in.eof()) throw Error(path_ + ":1: ends before its first " + layout_.number + "; delete the file");
  if (line != "# " + layout_.task)
    throw Error(path_ + ":1: holds " + layout_.numbers +
                " of another scene, settings, parameters, goal, seed, time or version; choose another "
                "--out or delete it");
  std::getline(in, line);
  if (in.eof()) throw Error(path_ + ":2: ends before its first " + layout_.number + "; delete the file");
  if (line != header(layout_)) throw Error(path_ + ":2: has other columns; choose another --out or delete it");
  for (int number = 3; std::getline(in, line); ++number) {
    Result r;
    // A line without an end is half a line.
    if (in.eof() || !read_row(line, r))
      throw Error(path_ + ":" + std::to_string(number) + ": is not a " + layout_.number + "; delete the line");
    rows_[r.number] = r;
  }
}

bool CaseTable::read_row(const std::string& line, Result& r) const {
  const std::vector<std::string> all = cells(line);
  const std::size_t first = 1 + layout_.parameters.size();
  if (all.size() != first + kResultCells || !read_number(all[0], r.number) || r.number < 0) return false;
  r.parameters.assign(all.begin() + 1, all.begin() + static_cast<std::ptrdiff_t>(first));
  const std::string* c = &all[first];
  int reached = 0;
  if (!read_number(c[4], reached) || !read_number(c[10], r.intersecting)) return false;
  r.who = c[0];
  r.route = c[1];
  r.reached = reached != 0;
  r.blocked_by = c[14];
  r.why = c[16];
  const std::pair<std::size_t, double*> numbers[] = {
      {2, &r.offset}, {3, &r.tilt},  {5, &r.time},         {6, &r.depth},        {7, &r.force},
      {8, &r.torque}, {9, &r.stuck}, {11, &r.place_W.x()}, {12, &r.place_W.y()}, {13, &r.place_W.z()}};
  // Infinite where there is no other part.
  r.clearance = INFINITY;
  if (c[15] != digits(INFINITY) && !read_number(c[15], r.clearance)) return false;
  return std::all_of(std::begin(numbers), std::end(numbers),
                     [&](const auto& n) { return read_number(c[n.first], *n.second); });
}

void CaseTable::add(const Result& result) {
  rows_[result.number] = result;
  written_ = false;
  if (std::chrono::steady_clock::now() >= next_) flush();
}

void CaseTable::flush() {
  if (written_) return;
  const auto begin = std::chrono::steady_clock::now();
  replace_shared(path_, table_text(layout_, rows_));
  written_ = true;
  const auto end = std::chrono::steady_clock::now();
  next_ = end + kWriteShare * (end - begin);
}

}  // namespace tegotae::study
