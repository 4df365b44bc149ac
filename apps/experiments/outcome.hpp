#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace tegotae::experiments {

/// Something that an experiment is to show.
struct Claim {
  std::string name;
  double value;
  std::string target;  ///< in words, e.g. "at most 1"
  std::string unit;
  bool holds;
};
Claim at_most(const std::string& name, double value, double limit, const std::string& unit);
Claim at_least(const std::string& name, double value, double limit, const std::string& unit);

struct Axis {
  std::string label;
  bool log = false;
  bool whole = false;    ///< a tick mark at every integer, and no other
  bool percent = false;  ///< shown from 0 to 100
};

/// A line or, with `points`, dots; `low` and `high` are the ends of error bars.
struct Series {
  std::string name;
  std::vector<double> x, y, low{}, high{};
  bool points = false;
  bool dash = false;
};

struct Mark {
  double x;
  std::string label;
};

/// `trace`: x may go back and forth.
struct Plot {
  std::string title;
  Axis x, y;
  std::vector<Series> series;
  bool trace = false;
  std::vector<Mark> marks{};
};

struct Table {
  std::string caption;
  std::vector<std::string> head;
  std::vector<std::vector<nlohmann::json>> rows{};
};

struct Section {
  std::string title, text;
  std::vector<Plot> plots{};
  std::vector<Table> tables{};
};

/// A CSV file: numbers, or names.
struct Csv {
  std::string name;  ///< of the file, without its ending
  std::vector<std::string> head;
  std::vector<std::vector<nlohmann::json>> rows{};
};

/// What an experiment has found.
struct Outcome {
  std::string title, intro;
  std::vector<Claim> claims{};
  std::vector<Section> sections{};
  std::vector<Csv> csv{};
};

/// `x` with `digits` significant ones.
double rounded(double x, int digits);
/// Every so many points of a series, so that about `most` are left.
void thin(Series& series, std::size_t most);

/// Writes the outcome of the experiment `name` to `folder`: CSV files, summary.json, report.html; `subtitle` goes into
/// the report. Throws Error naming what cannot be written.
void write_outcome(const Outcome& outcome, const std::string& name, const std::string& subtitle,
                   const std::string& folder);

}  // namespace tegotae::experiments
