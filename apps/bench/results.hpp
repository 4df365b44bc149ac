#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bench/measure_fcl.hpp"
#include "bench/measure_friction.hpp"
#include "bench/measure_lag.hpp"
#include "bench/measure_loop.hpp"
#include "bench/measure_lp.hpp"
#include "bench/measure_seat.hpp"
#include "bench/measure_start.hpp"

namespace tegotae::bench {

/// Building the patch hierarchies of a scene's distinct meshes.
struct BuildFigures {
  double us_per_triangle = 0;  ///< CPU time
  double bytes_per_triangle = 0;
};

/// A run with a tick budget.
struct BudgetFigures {
  double budget;  ///< s
  LoopFigures loop;
  std::int64_t checked = 0;
  std::int64_t intersecting = 0;
};

/// A run with friction, at hand speed.
struct FrictionFigures {
  double mu = 0;
  LoopFigures loop;
  std::int64_t checked = 0;
  std::int64_t intersecting = 0;
};

/// Everything measured on one scene.
struct SceneFigures {
  std::string scene;
  Targets targets{};
  double depth = 0;  ///< that a peg is to reach, m; 0: no peg
  std::size_t held_triangles = 0;
  std::size_t fixed_triangles = 0;
  LoopFigures hand;  ///< at hand speed: what the targets are about
  LoopFigures fast;
  LagFigures hand_lag, fast_lag;  ///< of these runs, against the same without a budget
  FclFigures fcl;
  BuildFigures build;
  std::int64_t checked = 0;       ///< committed poses that FCL was asked about after the runs
  std::int64_t intersecting = 0;  ///< of them
  std::vector<BudgetFigures> budgets;
  std::optional<FrictionFigures> friction;
  std::optional<SeatFigures> seat;  ///< of a scene with a seat
  SeatTargets seat_targets{};
};

struct Results {
  std::vector<SceneFigures> rows;
  std::vector<StartFigures> starts;  ///< empty: not asked for
  std::vector<LpFigures> lp;
  std::vector<FrictionSolveFigures> friction_solves;  ///< empty: not asked for
  double seconds = 0;                                 ///< the whole took
};

/// One line: {"rows": [...], "lp": [...]}; what was not measured is null.
std::string json_line(const Results& results);
/// Tables for people: GitHub markdown, which reads well on a terminal too.
std::string tables(const Results& results);
/// Median of the tick against the number of triangles at ratio 0.99, as SVG.
std::string growth_plot(const Results& results);
/// Replaces the part of the file at `path` between its "begin generated" and "end generated" lines by the machine, the
/// compiler, `command`, the tables and the plot, which is written beside the file. Throws Error when it cannot.
void update_markdown(const std::string& path, const std::string& command, const Results& results);

}  // namespace tegotae::bench
