#pragma once

#include <map>
#include <string>

#include "tries/one_try.hpp"

namespace tegotae::tries {

/// The finished tries of a folder, in tries.csv: a comment line that tells the task, the header, a row a try in the
/// order of their numbers. Replaced as a whole after every try, so that it is never half written.
class TryTable {
 public:
  /// Reads what an earlier call left in `folder`. Throws Error when that was of another task.
  TryTable(const std::string& folder, const std::string& task);

  bool has(int number) const { return rows_.count(number) > 0; }
  const std::map<int, Result>& rows() const { return rows_; }
  /// Adds a try and writes the file. Throws Error.
  void add(const Result& result);

 private:
  void read();
  void write() const;

  std::string path_, task_;
  std::map<int, Result> rows_;
};

/// What makes two calls the same task: everything that the result of a try depends on, as text without a line's end.
std::string fingerprint(const Task& task);

}  // namespace tegotae::tries
