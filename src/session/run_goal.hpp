#pragma once

#include <string>

#include "tegotae/scene_file/scene_file.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae {

inline double script_length(const SceneFile& file) {
  return file.script.end() - file.script.begin();
}
/// Whether a run is over when its script is; else a person or an InputSource moves the pen as long as they like.
inline bool follows_script(const RunSettings& settings) {
  return settings.device.empty() && settings.hand == nullptr;
}

/// The fewest digits that read back as `x`.
std::string exact_text(double x);
/// As RecordingInfo::goal.
std::string goal_text(const Pose& X);

/// Where a scene's script takes the held part, and how far that has come.
class RunGoal {
 public:
  /// `center` is the held part's center of mass in its file frame, m.
  RunGoal(const SceneFile& file, const Vec3& center);
  /// The same with another tolerance (m), as a recording names it.
  RunGoal(const SceneFile& file, const Vec3& center, double tolerance) : RunGoal(file, center) {
    tolerance_ = tolerance;
  }

  /// RunSummary::depth_m when the held part is at `X`.
  double depth(const Pose& X) const { return direction_.dot(X * center_ - from_); }
  /// Whether the held part is where the script ends, as RunSummary::completed says.
  bool reached(const Pose& X) const;
  /// What is missing from `X` to where the script ends, of the center of mass.
  Displacement missing(const Pose& X) const { return displacement(X, end_, center_); }
  const Pose& end() const { return end_; }                        ///< X_WF of the held part where the script ends
  double way() const { return (end_ * center_ - from_).norm(); }  ///< straight, m
  double tolerance() const { return tolerance_; }                 ///< of reached(), m

 private:
  Vec3 center_;
  Pose end_;                       // of the script, scaled
  Vec3 from_;                      // center of mass where the script starts
  Vec3 direction_ = Vec3::Zero();  // from there to where the script ends; zero when it ends where it starts
  double tolerance_;               // m
};

}  // namespace tegotae
