#pragma once

#include <cstdint>
#include <vector>

namespace tegotae {

/// How a tree of poses is grown: towards a pose of the room, of the other tree, of a path that is known, by what led to
/// a pose, or by a motion about or along an axis: any, or one of the world or of the part.
enum class GrowingMotion : std::uint8_t { anywhere, other_tree, known_path, repeat, shift, turn, screw };

struct GrowingPath {
  GrowingMotion motion;
  int axis = 0;     ///< 0: any; 1 to 3: of the world; 4 to 6: of the part
  double sign = 1;  ///< of a turn, and of a shift along an axis that is not any
  double share;     ///< of the iterations, where all ways are as good
  double hope;      ///< how often it led on lately, 0 to 1
};

/// All of them. Ways that led on lately are chosen more often.
class GrowingPaths {
 public:
  /// `known`: whether there is a path that is known.
  explicit GrowingPaths(bool known);
  /// The one at `at`, from 0 to 1, of all shares.
  GrowingPath& choose(double at);
  /// What came of an iteration that went a way.
  static void report(GrowingPath& way, bool led_on);

 private:
  std::vector<GrowingPath> ways_;
};

}  // namespace tegotae
