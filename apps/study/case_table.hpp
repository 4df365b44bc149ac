#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "study/run_case.hpp"

namespace tegotae::study {

/// What a table of cases is of.
struct TableLayout {
  std::string task;                     ///< Tasks::fingerprint()
  std::string number;                   ///< name of the first column: "try" or "case"
  std::string numbers;                  ///< the same of many
  std::vector<std::string> parameters;  ///< parameter_columns()
};

/// The row of a case, without the line's end.
std::string row_text(const Result& r);
/// The complete table.
std::string table_text(const TableLayout& layout, const std::map<int, Result>& rows);

/// The finished cases of a file: a comment line with the fingerprint, the header, a row a case in the order of their
/// numbers. The file is replaced atomically, so that a killed process leaves no half of it; two processes that make the
/// same cases may share the file. Every number of processes and interruptions leads to the same bytes.
class CaseTable {
 public:
  /// Reads what an earlier call left at `path`. Throws Error `file:line: reason` when that is of something else.
  CaseTable(std::string path, TableLayout layout);

  bool has(int number) const { return rows_.count(number) > 0; }
  const std::map<int, Result>& rows() const { return rows_; }
  /// Adds a case. Writes the file, but with no more than a tenth of the time. Throws Error.
  void add(const Result& result);
  /// Writes the file when something in it is not written yet. Throws Error.
  void flush();

 private:
  void read();
  bool read_row(const std::string& line, Result& r) const;

  std::string path_;
  TableLayout layout_;
  std::map<int, Result> rows_;
  bool written_ = true;
  std::chrono::steady_clock::time_point next_{};
};

}  // namespace tegotae::study
