#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tegotae::study {

/// One thing in which cases differ: values that each make cases of their own, or a range from which each case draws
/// one.
struct Axis {
  enum class Draw {
    none,
    uniform,   ///< every value is as likely
    tolerance  ///< normal, three standard deviations to each bound, none beyond
  };
  std::string name;                ///< "scene", "order", "operator", "offset", "tilt", "mu", "inward PART"
  std::vector<std::string> texts;  ///< one of texts, numbers, draw
  std::vector<double> numbers;
  Draw draw = Draw::none;
  double low = 0, high = 0;  ///< of what is drawn

  /// How many cases it makes of one.
  std::size_t size() const;
  /// The column of a table of cases in which its value stands; empty: the result has it in one of its own.
  std::string column() const;
};

/// A table of cases: every combination of the axes' values, `repeats` times.
struct Study {
  std::string path;                 ///< of its file; empty: the tries of one scene
  std::vector<std::string> scenes;  ///< paths of scene files
  std::string hold;                 ///< name of the part to hold; empty: the scene's
  std::string goal;                 ///< a pose, "out", or empty: where the scene's script ends
  double seconds = 20;              ///< that an operator has, s
  std::uint64_t seed = 1;
  int repeats = 1;
  std::vector<Axis> axes;
  std::vector<std::vector<std::string>> orders;  ///< names of parts that go out one after the other
};

/// What a case has of an axis.
struct Value {
  std::size_t index = 0;  ///< among the axis' values
  std::string text;       ///< for a table
  double number = 0;
};

struct Case {
  int number = 0;                       ///< from 0
  int repeat = 0;                       ///< of its combination, from 0
  std::map<std::string, Value> values;  ///< by the name of the axis

  /// The value of an axis; null: the study has no such axis.
  const Value* find(const std::string& axis) const;
};

/// How many cases the study has: each combination of the axes' values, `repeats` times.
int case_count(const Study& study);

/// The case with this number: the same for the same axes and seed, however many repeats there are.
Case make_case(const Study& study, int number);

/// The columns in which a table has the axes' values, and a case's values for them.
std::vector<std::string> parameter_columns(const Study& study);
std::vector<std::string> parameter_cells(const Study& study, const Case& c);

/// Everything of a study but its scenes, that can change the result of a case: as text.
std::string axes_text(const Study& study);

/// The shortest digits that read back as the same number.
std::string digits(double value);

}  // namespace tegotae::study
