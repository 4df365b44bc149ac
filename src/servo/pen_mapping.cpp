#include "servo/pen_mapping.hpp"

#include <algorithm>

namespace tegotae {

void PenMapping::anchor(const Vec3& pen, const Quat& pen_q, const Vec3& part, const Quat& part_q) noexcept {
  pen_anchor_ = pen;
  pen_anchor_q_ = pen_q;
  part_anchor_ = part;
  part_anchor_q_ = part_q;
}

bool PenMapping::update(const DeviceState& pen, const Vec3& pen_center, const MappingCommand& command) noexcept {
  const Pose& P = pen.pose;
  if (!started_) {
    started_ = true;
    anchor(P * pen_center, P.q, P * pen_center, P.q);
    pen_ = P;
    Y_ = {P.q, P * pen_center - P.q * command.center};
    pen_center_ = pen_center;
    center_ = command.center;
  }
  const bool pressed = (pen.buttons & settings_.clutch_buttons) != 0;
  const Clutch clutch = std::max(command.clutch, pressed ? settings_.clutch_by_button : Clutch::none);
  const bool changed = command.scale != scale_ || clutch != clutch_;
  if (changed || pen_center != pen_center_ || command.center != center_) {
    // From where both were last, so that nothing of the pen's way since is lost.
    anchor(pen_ * pen_center, pen_.q, Y_ * command.center, Y_.q);
    scale_ = command.scale;
    clutch_ = clutch;
    pen_center_ = pen_center;
    center_ = command.center;
  }
  const bool another = command.attachment != attachment_;
  if (another) {
    attachment_ = command.attachment;
    home_counter_ = 0;
  }
  const bool home = command.home_counter != home_counter_;
  home_counter_ = command.home_counter;
  if (home && home_counter_ != 0) anchor(P * pen_center, P.q, command.home * center_, command.home.q);

  const bool turns = clutch_ != Clutch::all;
  const bool moves = clutch_ == Clutch::none;
  const Quat q = turns ? Quat((P.q * pen_anchor_q_.conjugate() * part_anchor_q_).normalized()) : part_anchor_q_;
  const Vec3 at = moves ? Vec3(part_anchor_ + scale_ * (P * pen_center - pen_anchor_)) : part_anchor_;
  Y_ = {q, at - q * center_};
  velocity_ = {moves ? Vec3(scale_ * pen.velocity.v) : Vec3::Zero(), turns ? pen.velocity.w : Vec3::Zero()};
  pen_ = P;
  return changed || another || (home && home_counter_ != 0);
}

}  // namespace tegotae
