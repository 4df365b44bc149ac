#pragma once

#include <utility>

#include "tegotae/device/input_source.hpp"
#include "tegotae/device/script.hpp"

namespace tegotae {

/// A hand that does what a script says, whatever it feels.
class ScriptHand final : public InputSource {
 public:
  explicit ScriptHand(StylusScript script) : script_(std::move(script)) {}

  double begin() const noexcept override { return script_.begin(); }
  Pose start() const noexcept override { return script_.pose(script_.begin()); }
  HandTarget target(double t, const Pose&) noexcept override { return {script_.pose(t), script_.velocity(t)}; }

 private:
  StylusScript script_;
};

}  // namespace tegotae
