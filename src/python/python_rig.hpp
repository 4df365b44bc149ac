#pragma once

#include <nanobind/nanobind.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "python/pen.hpp"
#include "tegotae/session/rig.hpp"

namespace tegotae::python {

/// A Rig that Python cannot break: what a thread may not do while another one steps is an Error. The GIL guards who
/// steps, so all calls but those that say otherwise are made with it held.
class PythonRig {
 public:
  PythonRig(const Scene& scene, const Pen& pen, RigClock clock, double period);
  /// The device of another process.
  PythonRig(const Scene& scene, const std::string& device);
  ~PythonRig();
  PythonRig(const PythonRig&) = delete;
  PythonRig& operator=(const PythonRig&) = delete;

  void start();
  void stop();
  void step(int count);
  void run(double seconds, nanobind::object callback);
  void request_stop() noexcept { rig_->request_stop(); }  ///< from any thread
  SceneChange change(const Scene& next);                  ///< from any thread

  /// The rig, to read what its last step did. Throws Error while another thread steps.
  const Rig& at_rest() const;
  const Rig& from_any_thread() const { return *rig_; }  ///< for Rig::part

  // For the garbage collector.
  const nanobind::object& pen() const { return pen_; }
  void forget_pen() { pen_ = nanobind::object(); }

 private:
  /// While it lives this thread alone may call the rig.
  class Turn {
   public:
    explicit Turn(PythonRig& rig);
    ~Turn();
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    PythonRig& rig_;
  };
  void step_alone(int count);
  void run_alone(double seconds);
  void run_with(double seconds, const nanobind::object& callback);
  bool pen_failed() const { return python_ && python_->failed(); }
  void report_failure();

  nanobind::object pen_;                     // keeps what a pen in Python calls
  std::shared_ptr<Device> device_;           // null: another process's
  PythonDevice* python_ = nullptr;           // the same where it is written in Python
  std::unique_ptr<Rig> rig_;                 // after the device: it goes first
  std::optional<std::thread::id> stepping_;  // the thread that has the turn
  bool running_ = false;
};

}  // namespace tegotae::python
