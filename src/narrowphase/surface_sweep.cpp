#include "narrowphase/surface_sweep.hpp"

#include <algorithm>
#include <cmath>

#include "tegotae/core/clock.hpp"

namespace tegotae {
namespace {

/// Helpers are asked where there is so much to do.
constexpr std::uint32_t kWorthHelp = 4;

}  // namespace

SurfaceSweep::SurfaceSweep(std::shared_ptr<const PatchTree> a, const Vec3& center,
                           const std::vector<CellFront::FixedPart>& fixed, std::shared_ptr<const Facing> facing,
                           std::shared_ptr<const Backing> backing, std::uint32_t blocking, int helpers)
    : model_(std::make_shared<const SweepModel>(std::move(a), center, fixed, std::move(facing), std::move(backing))),
      worker_(model_) {
  near_.reserve(fixed.size());
  outside_.assign(fixed.size(), false);
  blocking_.reserve(blocking);
  for (int i = 0; i <= helpers; ++i) tasks_.push_back(std::make_unique<SweepTask>(SweepWorker::most_pieces(*model_)));
  if (helpers > 0) helpers_ = std::make_unique<SweepHelpers>(model_, helpers);
}

void SurfaceSweep::begin(const Pose& X, const Displacement& d, const std::vector<std::uint32_t>& near,
                         const std::vector<bool>& outside, const SweepAim& aim) noexcept {
  drop_task();
  question_.X = X;
  question_.d = d;
  near_.assign(near.begin(), near.end());
  for (std::size_t i = 0; i < near.size(); ++i) outside_[i] = model_->facing && outside[i];
  question_.clearance = aim.clearance;
  question_.kept = std::max(aim.kept, aim.clearance);
  question_.kept_far = std::max(aim.kept_far, question_.kept);
  question_.far = aim.far;
  const double length = d.dp.norm() + model_->reach * d.dr.norm();
  question_.worth = aim.worth / length;
  blocked_within_ = aim.blocked_within / length;
  near_within_ = aim.near_within / length;
  question_.drawn = model_->backing ? aim.drawn : std::nullopt;
  under_way_ = true;
  start_looks();
}

void SurfaceSweep::start_looks() {
  blocking_.clear();
  end_ = faces_end_ = {1, false};
  searched_ = 0;
  met_at_once_ = met_near_ = false;
  start_look(Look::sample);
}

void SurfaceSweep::start_look(Look look) {
  // Of what was drawn, blocks have told as much as faces would.
  const bool drawn_again = question_.drawn && !(question_.look == Look::blocks && look == Look::faces);
  question_.look = look;
  start_layer(drawn_again ? Layer::walls : Layer::faces);
}

void SurfaceSweep::start_layer(Layer layer) {
  const bool no_walls = layer == Layer::walls && !model_->walls[static_cast<std::size_t>(*question_.drawn)];
  question_.layer = no_walls ? Layer::moved_faces : layer;
  at_ = 0;
}

bool SurfaceSweep::go_on(std::int64_t deadline_ns) noexcept {
  while (under_way_) {
    if (!(end_.share > 0) || near_.empty()) {
      under_way_ = false;
    } else if (task_ == nullptr) {
      start_part();
    } else if (worker_.work(*task_, deadline_ns)) {
      finish_part();
    }
    if (past(deadline_ns)) break;
  }
  if (!under_way_ && end_.early) blocking_.clear();
  return !under_way_;
}

double SurfaceSweep::progress() const {
  const bool last = question_.look != Look::sample && question_.layer == Layer::faces && at_ + 1 == near_.size();
  return last && task_ != nullptr ? task_->taken() : 0;
}

void SurfaceSweep::start_part() {
  question_.part = near_[at_];
  question_.outside = outside_[at_];
  question_.pieces = SweepWorker::pieces(*model_, question_);
  // Each helper is inside one at most.
  task_ = std::find_if(tasks_.begin(), tasks_.end(), [](const auto& task) { return task->is_empty(); })->get();
  task_->open(question_, end_, faces_end_, searched_);
  if (!worker_.begin(*task_)) {
    drop_task();
    next_part();
  } else if (helpers_ && question_.pieces >= kWorthHelp) {
    helpers_->offer(*task_);
  }
}

void SurfaceSweep::drop_task() {
  if (task_ == nullptr) return;
  if (helpers_) helpers_->withdraw();
  task_->close();
  task_ = nullptr;
}

void SurfaceSweep::finish_part() {
  end_ = task_->end.value();
  faces_end_ = task_->faces_end.value();
  searched_ = task_->searched.load();
  const SweepTask::Ending ending = task_->ending();
  collect_met();
  drop_task();
  if (ending == SweepTask::Ending::not_solid) {
    question_.drawn.reset();
    start_looks();
  } else if (ending == SweepTask::Ending::many_faces) {
    end_ = faces_end_;
    start_look(Look::faces);
  } else {
    next_part();
  }
}

void SurfaceSweep::collect_met() {
  std::array<SweepTask::Met, SweepTask::kMostMet> met;
  // It is all nearer than what was met before, which had ended the motion that was looked at.
  const std::size_t count = std::min(task_->met(met), blocking_.capacity());
  blocking_.resize(std::min(blocking_.size(), blocking_.capacity() - count));
  blocking_.insert(blocking_.begin(), count, {});
  for (std::size_t i = 0; i < count; ++i) blocking_[i] = {near_[at_], met[i].a, met[i].b};
}

void SurfaceSweep::next_part() {
  if (++at_ < near_.size()) return;
  if (question_.layer != Layer::faces) {
    start_layer(question_.layer == Layer::walls ? Layer::moved_faces : Layer::faces);
  } else if (question_.look == Look::sample && end_.share < blocked_within_ && !blocking_.empty()) {
    end_.share = 0;
    met_at_once_ = true;
    under_way_ = false;
  } else if (question_.look == Look::sample) {
    met_near_ = end_.share < near_within_ && !blocking_.empty();
    start_look(std::isfinite(question_.worth) ? Look::blocks : Look::faces);
  } else {
    under_way_ = false;
  }
}

}  // namespace tegotae
