#include "review/review.hpp"

#include <Eigen/Geometry>
#include <charconv>
#include <cmath>

#include "broadphase/bounding_spheres.hpp"
#include "shared/pose_option.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/loop/haptic_loop.hpp"
#include "view/follower.hpp"
#include "view/replay.hpp"

namespace tegotae::review {
namespace {

double clearance_at(const Scene& scene, const Pose& X) {
  ClearanceProbe probe(scene);
  std::vector<Clearance> out;
  probe.at(X, 0, out);
  return out.empty() ? 0 : out.front().distance;
}

/// How far the middle of the held part's box is from the middle of that around all others, m.
double from_the_middle(const Scene& scene, const Pose& X) {
  Eigen::AlignedBox3d held, others;
  for (const Part& part : scene.parts)
    for (const Vec3& v : part.mesh->vertices) part.held ? held.extend(X * v) : others.extend(part.pose * v);
  return held.isEmpty() || others.isEmpty() ? 0 : (held.center() - others.center()).norm();
}

/// Whether the goal is farther in than the start.
bool leads_inwards(const Scene& scene, const Pose& from, const Pose& to) {
  // In a fit the part has nothing but play around it at both ends, which says nothing.
  constexpr double kPlay = 0.1;  // of the distance
  const double change = clearance_at(scene, to) - clearance_at(scene, from);
  if (std::abs(change) > kPlay * (to.p - from.p).norm()) return change < 0;
  return from_the_middle(scene, to) <= from_the_middle(scene, from);
}

/// Where the recording says that the part was to go; none: it says nothing.
std::optional<Pose> recorded_goal(const Review& r) {
  const std::string& goal = r.recording.info.goal;
  if (goal.empty()) return std::nullopt;
  try {
    return apps::parse_pose(goal, r.file.scene);
  } catch (const Error& e) {
    throw Error(r.path + ": the goal that it names: " + e.what());
  }
}

/// A number of a recording's info; empty: it says none.
std::optional<double> recorded_number(const std::string& path, const std::string& text) {
  if (text.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0) || !std::isfinite(value))
    throw Error(path + ": the goal that it names: " + text + " is neither a tolerance nor a time");
  return value;
}

/// What the run was judged by. Who asks about another goal wants to know whether it ever was there.
GoalRule recorded_rule(const Review& r) {
  const RecordingInfo& info = r.recording.info;
  GoalRule rule{recorded_number(r.path, info.goal_tolerance), recorded_number(r.path, info.judged_after)};
  // Until there was a tolerance, only tries named their goal.
  if (!info.goal.empty() && info.goal_tolerance.empty()) rule.judged_after = 0;
  return rule;
}

/// The recording may be a part of a run only.
void tell_scene_changes(const RecordingInfo& info, Review& r) {
  if (r.verdict.outcome == Outcome::does_not_go && r.findings.start.intersecting == 0 && !info.continued_by.empty()) {
    r.verdict.outcome = Outcome::open;
    r.verdict.headline = "It had not arrived when the scene changed";
  }
  for (const std::string& text : view::scene_changes(info)) r.verdict.evidence.push_back({Evidence::Kind::plain, text});
}

}  // namespace

Review review_recording(const std::string& path, Recording recording, SceneFile file, const ReviewQuestions& questions,
                        const Progress& progress) {
  Review r{path, std::move(file), std::move(recording), Vec3::Zero(), {}, {}, {}, {}, {}};
  const std::vector<RecordFrame>& rows = r.recording.frames;
  if (rows.empty()) throw Error(path + ": has no rows");
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (rows[i].t < rows[i - 1].t)
      throw Error(path + ": row " + std::to_string(i + 1) + ": its time is earlier than that of the row before");
  r.scan = scan_path(r.file.scene, path, rows, progress, questions.band ? questions.band->high : 0);
  r.center = r.scan.center;
  r.file.scene.coupling = r.scan.coupling;
  for (Part& part : r.file.scene.parts)
    if (part.held) part.pose = rows.front().x;
  const std::optional<Pose> to = questions.goal ? questions.goal : recorded_goal(r);
  if (to) {
    r.file.script = StylusScript({{0, rows.front().x}, {1, *to}});
    r.file.scene.scale = 1;
  }
  if (2 * r.scan.astray > rows.size())
    throw Error(path + ": does not fit this scene: the part would intersect another one for " +
                std::to_string(r.scan.astray) + " of " + std::to_string(rows.size()) + " rows");
  if (progress) progress("asking for intersections", 0, 0);
  r.findings = find(r.file, rows, r.scan, r.center, questions.goal ? GoalRule() : recorded_rule(r));
  const Pose& end = r.file.script.pose(r.file.script.end());
  const bool inwards = leads_inwards(r.file.scene, rows.front().x, end);
  r.verdict = judge(r.findings, r.file.scene, inwards, r.scan, r.recording.damage);
  tell_scene_changes(r.recording.info, r);
  const ExitFindings& exit = r.findings.exit;
  const bool pulled = r.findings.goal && !exit.at_first && (exit.at_goal || !inwards);
  r.assembly = assembly_force(r, questions.friction, pulled, progress);
  if (questions.band) r.band = find_band(*questions.band, rows, r.scan);
  return r;
}

Verdict verdict_with_figures(const Review& r) {
  Verdict v = r.verdict;
  const auto add = [&v](const std::vector<std::string>& lines) {
    for (const std::string& text : lines) v.evidence.push_back({Evidence::Kind::plain, text});
  };
  add(assembly_force_text(r.assembly));
  if (r.band) add(band_text(*r.band, r.findings.clearances, r.file.scene));
  return v;
}

}  // namespace tegotae::review
