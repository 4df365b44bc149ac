#pragma once

#include <nanobind/nanobind.h>

#include <memory>
#include <string>

#include "python/python_device.hpp"
#include "tegotae/device/script.hpp"
#include "tegotae/device/simulated_device.hpp"

namespace tegotae::python {

/// What a rig may be given for a pen.
class Pen {
 public:
  virtual ~Pen() = default;
  /// The device for one rig.
  virtual std::shared_ptr<Device> device() const = 0;
};

/// The simulated pen whose hand follows a script. Each rig gets one of its own, at the script's beginning.
class ScriptPen final : public Pen {
 public:
  ScriptPen(const SimulatedDeviceSettings& how, StylusScript way) : settings(how), script(std::move(way)) {}
  std::shared_ptr<Device> device() const override { return std::make_shared<SimulatedDevice>(settings, script); }

  SimulatedDeviceSettings settings;
  StylusScript script;
};

/// A pen written in Python.
class PythonPen final : public Pen {
 public:
  PythonPen(nanobind::object hand, const PythonDeviceSettings& settings)
      : hand_(std::make_shared<PythonDevice>(std::move(hand), settings)) {}
  std::shared_ptr<Device> device() const override { return hand_; }
  PythonDevice& hand() const { return *hand_; }

 private:
  std::shared_ptr<PythonDevice> hand_;
};

}  // namespace tegotae::python
