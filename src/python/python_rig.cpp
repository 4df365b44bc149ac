#include "python/python_rig.hpp"

#include <atomic>
#include <set>
#include <utility>

#include "python/running.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::python {
namespace {

namespace nb = nanobind;

std::set<PythonRig*>& running() {
  static std::set<PythonRig*> rigs;
  return rigs;
}

}  // namespace

void add_running(PythonRig& rig) {
  running().insert(&rig);
}

void remove_running(PythonRig& rig) noexcept {
  running().erase(&rig);
}

void stop_all_running() {
  while (!running().empty()) {
    PythonRig* const rig = *running().begin();
    running().erase(rig);
    rig->stop();
  }
}

PythonRig::PythonRig(const Scene& scene, const Pen& pen, RigClock clock, double period)
    : pen_(nb::find(pen)), device_(pen.device()), python_(dynamic_cast<PythonDevice*>(device_.get())) {
  const Scene copy = scene;
  RigSettings settings;
  settings.clock = clock;
  settings.period = period;
  const nb::gil_scoped_release others_go_on;
  rig_ = std::make_unique<Rig>(copy, *device_, settings);
}

PythonRig::PythonRig(const Scene& scene, const std::string& device) {
  const Scene copy = scene;
  const nb::gil_scoped_release others_go_on;
  rig_ = std::make_unique<Rig>(copy, device);
}

PythonRig::~PythonRig() {
  remove_running(*this);
  const nb::gil_scoped_release others_go_on;  // a pen in Python ends
  rig_.reset();
}

PythonRig::Turn::Turn(PythonRig& rig) : rig_(rig) {
  if (rig.stepping_) throw Error("rig: it is stepping; request_stop() ends a run() from another thread or a callback");
  rig.stepping_ = std::this_thread::get_id();
}

PythonRig::Turn::~Turn() {
  rig_.stepping_.reset();
}

const Rig& PythonRig::at_rest() const {
  if (stepping_ && *stepping_ != std::this_thread::get_id())
    throw Error("rig: another thread is stepping it; only part, request_stop() and change() are for any thread");
  return *rig_;
}

void PythonRig::start() {
  const Turn turn(*this);
  if (running_) return;
  {
    const nb::gil_scoped_release others_go_on;
    rig_->start();
  }
  running_ = true;
  add_running(*this);
}

void PythonRig::stop() {
  const Turn turn(*this);
  if (!running_) return;
  running_ = false;
  remove_running(*this);
  {
    const nb::gil_scoped_release others_go_on;
    rig_->stop();
  }
  report_failure();
}

void PythonRig::report_failure() {
  if (pen_failed()) python_->rethrow();
}

void PythonRig::step(int count) {
  const Turn turn(*this);
  if (!running_) throw Error("rig: start() it first, or use it in a with statement");
  if (count == 1) {
    const nb::gil_scoped_release others_go_on;
    rig_->step();
  } else {
    step_alone(count);
  }
  report_failure();
}

void PythonRig::run(double seconds, nb::object callback) {
  const Turn turn(*this);
  if (!running_) throw Error("rig: start() it first, or use it in a with statement");
  if (callback.is_none()) {
    run_alone(seconds);
  } else {
    run_with(seconds, callback);
  }
  report_failure();
}

void PythonRig::step_alone(int count) {
  std::atomic<bool> ended{false};
  interruptible(
      [&] {
        for (int i = 0; i < count && !ended && !pen_failed(); ++i) rig_->step();
      },
      [&ended] { ended = true; });
}

void PythonRig::run_alone(double seconds) {
  interruptible(
      [&] {
        rig_->run(seconds, [this](Rig& r) {
          if (pen_failed()) r.request_stop();
        });
      },
      [this] { rig_->request_stop(); });
}

void PythonRig::run_with(double seconds, const nb::object& callback) {
  const nb::object self = nb::find(this);
  const nb::gil_scoped_release others_go_on;
  rig_->run(seconds, [&](Rig& r) {
    if (pen_failed()) r.request_stop();
    const nb::gil_scoped_acquire python;
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    callback(self);
  });
}

SceneChange PythonRig::change(const Scene& next) {
  Scene copy = next;
  const nb::gil_scoped_release others_go_on;
  return rig_->change(std::move(copy));
}

}  // namespace tegotae::python
