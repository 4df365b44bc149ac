#include "record/csv_reader.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "record/csv_row.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {

constexpr const char* kLagReasonColumn = "lag_reason";  // the last of kRecordHeader

/// Calls `cell(number, text)` for every cell of a line.
template <class Cell>
void split(std::string_view line, Cell cell) {
  for (std::size_t number = 0;; ++number) {
    const std::size_t comma = line.find(',');
    cell(number, line.substr(0, comma));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

std::vector<std::string> names_of(std::string_view header) {
  std::vector<std::string> names;
  split(header.substr(0, header.find_last_not_of("\r\n") + 1),
        [&](std::size_t, std::string_view name) { names.emplace_back(name); });
  return names;
}

class CsvReader {
 public:
  CsvReader(const std::string& path, std::string_view text) : path_(path), rest_(text) {}

  Recording read() {
    Recording out;
    bool header = false;
    while (!rest_.empty()) {
      ++line_;
      const std::size_t end = rest_.find('\n');
      if (end == std::string_view::npos) {
        // Rows are written with their end of line: a row without one is a row that was cut.
        if (!header) fail("", "no header row");
        out.damage = "the last row (line " + std::to_string(line_) + ") is cut";
        return out;
      }
      std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(end + 1);
      if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
      if (line.empty() || line.front() == '#') continue;
      if (!header) {
        take_header(line);
        header = true;
      } else {
        out.frames.push_back(frame(line));
      }
    }
    if (!header) fail("", "no header row");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& column, const std::string& reason) const {
    throw Error(ErrorKind::file,
                path_ + ":" + std::to_string(line_) + ": " + (column.empty() ? "" : column + ": ") + reason,
                {path_, static_cast<int>(line_), column, {}});
  }

  void take_header(std::string_view line) {
    const std::vector<std::string> found = names_of(line);
    columns_ = found.size();
    for (const std::string& name : names_) {
      const auto at = std::find(found.begin(), found.end(), name);
      // Recordings of earlier versions do not tell why the part lagged.
      if (at == found.end() && name == kLagReasonColumn) continue;
      if (at == found.end()) fail(name, "this column is missing; is this a recording?");
      place_.push_back(static_cast<std::size_t>(at - found.begin()));
    }
    cells_.resize(columns_);
  }

  template <class Number>
  void take(std::size_t column, Number& value) const {
    const std::string_view text = cells_[place_[column]];
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail(names_[column], "\"" + std::string(text.substr(0, 40)) + "\" is not a number");
  }

  RecordFrame frame(std::string_view line) {
    std::size_t count = 0;
    split(line, [&](std::size_t i, std::string_view text) {
      if (i < columns_) cells_[i] = text;
      ++count;
    });
    if (count != columns_)
      fail("", "the row has " + std::to_string(count) + " cells instead of " + std::to_string(columns_));
    RecordFrame f;
    std::size_t column = 0;
    const auto next = [&](auto& value) { take(column++, value); };
    const auto vector = [&](Vec3& v) {
      for (int i = 0; i < 3; ++i) next(v[i]);
    };
    const auto pose = [&](Pose& X) {
      vector(X.p);
      for (double* q : {&X.q.w(), &X.q.x(), &X.q.y(), &X.q.z()}) next(*q);
    };
    next(f.tick);
    next(f.substep);
    next(f.t);
    pose(f.y);
    pose(f.x);
    vector(f.wrench.force);
    vector(f.wrench.torque);
    next(f.contacts);
    next(f.gap);
    next(f.tick_us);
    if (column < place_.size()) {
      int reason = 0;
      next(reason);
      if (reason < 0 || reason >= kLagReasons) fail(kLagReasonColumn, std::to_string(reason) + " is not a lag reason");
      f.lag_reason = static_cast<LagReason>(reason);
    }
    return f;
  }

  const std::string& path_;
  std::string_view rest_;
  std::size_t line_ = 0;
  const std::vector<std::string> names_ = names_of(kRecordHeader);  // in the order in which frame() takes them
  std::vector<std::size_t> place_;                                  // of each in a row of this file
  std::size_t columns_ = 0;
  std::vector<std::string_view> cells_;
};

}  // namespace

Recording read_csv(const std::string& path, const std::string& text) {
  return CsvReader(path, text).read();
}

}  // namespace tegotae
