// tegotae.h over Rig. Every function ends in guarded(), through which no exception goes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <new>
#include <string>

#include "core/valid_pose.hpp"
#include "loop/scene_parts.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/core/version.hpp"
#include "tegotae/device/simulated_device.hpp"
#include "tegotae/import/load.hpp"
#include "tegotae/scene_file/scene_file.hpp"
#include "tegotae/session/rig.hpp"
#include "tegotae/tegotae.h"

using namespace tegotae;

struct tegotae_scene {
  Scene scene;
};

struct tegotae_rig {
  InputGuide guide;
  std::unique_ptr<SimulatedDevice> pen;  ///< null: another process's
  std::unique_ptr<Rig> rig;
};

namespace {

constexpr int kFailed = -1;

std::string& last_error() noexcept {
  thread_local std::string text;
  return text;
}

void set_last_error(const char* why) noexcept {
  try {
    last_error() = why;
  } catch (const std::bad_alloc&) {  // not even enough memory for the text
    last_error().clear();
  }
}

/// What `body` returns, or `failed` with the reason for tegotae_last_error().
template <class Result, class Body>
Result guarded(Result failed, const Body& body) noexcept {
  try {
    return body();
  } catch (const std::exception& e) {
    set_last_error(e.what());
  } catch (...) {
    set_last_error("unknown error");
  }
  return failed;
}

template <class T>
T& required(T* object, const char* what) {
  if (object == nullptr) throw Error(std::string(what) + " must not be NULL");
  return *object;
}

Pose pose_of(const double* values) {
  required(values, "pose");
  const Quat q(values[3], values[4], values[5], values[6]);
  const Pose pose{q.normalized(), Vec3(values[0], values[1], values[2])};
  if (!(q.norm() > 0) || !is_valid(pose)) throw Error("pose: not finite, without rotation, or beyond 10 km");
  return pose;
}

void store(const Pose& pose, double* out) {
  const double values[7] = {pose.p.x(), pose.p.y(), pose.p.z(), pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()};
  std::copy(values, values + 7, out);
}

void store(const Vec3& v, double* out) {
  std::copy(v.data(), v.data() + 3, out);
}

TriangleMesh mesh_of(const std::string& name, const double* vertices, std::size_t vertex_count,
                     const std::uint32_t* triangles, std::size_t triangle_count) {
  required(vertices, "vertices");
  required(triangles, "triangles");
  TriangleMesh mesh;
  mesh.name = name;
  for (std::size_t i = 0; i < vertex_count; ++i) {
    mesh.vertices.emplace_back(vertices[3 * i], vertices[3 * i + 1], vertices[3 * i + 2]);
    if (!mesh.vertices.back().allFinite() || mesh.vertices.back().cwiseAbs().maxCoeff() > kFarthestVertex)
      throw Error("part \"" + name + "\": a vertex is not finite, or beyond 1000 km");
  }
  for (std::size_t i = 0; i < triangle_count; ++i) {
    mesh.triangles.push_back({triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]});
    for (const std::uint32_t v : mesh.triangles.back())
      if (v >= vertex_count) throw Error("part \"" + name + "\": a triangle names a vertex that is not there");
  }
  return weld(mesh);
}

}  // namespace

extern "C" {

const char* tegotae_version(void) {
  return TEGOTAE_VERSION_STRING;
}

const char* tegotae_last_error(void) {
  return last_error().c_str();
}

tegotae_scene* tegotae_scene_create(void) {
  return guarded<tegotae_scene*>(nullptr, [] { return new tegotae_scene; });
}

tegotae_scene* tegotae_scene_load(const char* path) {
  return guarded<tegotae_scene*>(nullptr, [path]() -> tegotae_scene* {
    required(path, "path");
#ifdef TEGOTAE_HAS_IO
    return new tegotae_scene{load_scene(path).scene};
#else
    throw Error(std::string(path) + ": this library was built without file formats (TEGOTAE_IO)");
#endif
  });
}

int64_t tegotae_scene_notes(const tegotae_scene* scene, char* text, size_t capacity) {
  return guarded<int64_t>(kFailed, [&] {
    std::string all;
    for (const std::string& note : notes_of(required(scene, "scene").scene)) all += note + '\n';
    if (capacity == 0) return static_cast<int64_t>(all.size());
    const std::size_t copied = std::min(all.size(), capacity - 1);
    std::copy_n(all.data(), copied, &required(text, "text"));
    text[copied] = '\0';
    return static_cast<int64_t>(all.size());
  });
}

int64_t tegotae_scene_add(tegotae_scene* scene, const char* name, const double* vertices, size_t vertex_count,
                          const uint32_t* triangles, size_t triangle_count, const double pose[7], int held) {
  return guarded<int64_t>(kFailed, [&] {
    Scene& s = required(scene, "scene").scene;
    required(name, "name");
    TriangleMesh mesh = mesh_of(name, vertices, vertex_count, triangles, triangle_count);
    const Pose X = pose_of(pose);
    const PartId id = held != 0 ? s.add_held(name, std::move(mesh), X) : s.add_fixed(name, std::move(mesh), X);
    return static_cast<int64_t>(id.index);
  });
}

int tegotae_scene_move(tegotae_scene* scene, uint32_t part, const double pose[7]) {
  return guarded(kFailed, [&] {
    Scene& s = required(scene, "scene").scene;
    if (part >= s.parts.size()) throw Error("the scene has no part " + std::to_string(part));
    s.parts[part].pose = pose_of(pose);
    return 0;
  });
}

void tegotae_scene_destroy(tegotae_scene* scene) {
  delete scene;
}

tegotae_rig* tegotae_rig_create(const tegotae_scene* scene, const char* device, int clock) {
  return guarded<tegotae_rig*>(nullptr, [&]() -> tegotae_rig* {
    const Scene& s = required(scene, "scene").scene;
    if (clock != TEGOTAE_CLOCK_REAL && clock != TEGOTAE_CLOCK_SIMULATED) throw Error("unknown clock");
    auto made = std::make_unique<tegotae_rig>();
    if (device != nullptr) {
      if (clock != TEGOTAE_CLOCK_REAL)
        throw Error("a device in another process has its own clock; it cannot run in simulated time");
      made->rig = std::make_unique<Rig>(s, device);
      return made.release();
    }
    made->pen = std::make_unique<SimulatedDevice>(SimulatedDeviceSettings(), StylusScript({{0, held_part(s).pose}}));
    made->pen->follow(made->guide);
    RigSettings settings;
    settings.clock = clock == TEGOTAE_CLOCK_REAL ? RigClock::real : RigClock::simulated;
    made->rig = std::make_unique<Rig>(s, *made->pen, settings);
    return made.release();
  });
}

void tegotae_rig_destroy(tegotae_rig* rig) {
  delete rig;
}

int tegotae_rig_start(tegotae_rig* rig) {
  return guarded(kFailed, [&] {
    required(rig, "rig").rig->start();
    return 0;
  });
}

int tegotae_rig_step(tegotae_rig* rig, struct tegotae_tick* tick) {
  return guarded(kFailed, [&] {
    Rig& r = *required(rig, "rig").rig;
    const TickReport& report = r.step();
    if (tick == nullptr) return 0;
    store(report.proxy.X, tick->part);
    store(r.pen().state.pose, tick->pen);
    store(r.pen().wrench.force, tick->force);
    store(r.pen().wrench.torque, tick->torque);
    tick->gap = report.gap;
    tick->lag = report.lag;
    tick->contacts = static_cast<int32_t>(r.contacts().size());
    tick->touching = report.proxy.touching ? 1 : 0;
    tick->connected = r.connected() ? 1 : 0;
    tick->lag_reason = static_cast<int32_t>(report.lag_reason);
    return 0;
  });
}

int tegotae_rig_stop(tegotae_rig* rig) {
  return guarded(kFailed, [&] {
    required(rig, "rig").rig->stop();
    return 0;
  });
}

int64_t tegotae_rig_contacts(const tegotae_rig* rig, struct tegotae_contact* contacts, size_t capacity) {
  return guarded<int64_t>(kFailed, [&] {
    const std::vector<ContactPoint>& all = required(rig, "rig").rig->contacts();
    if (capacity > 0) required(contacts, "contacts");
    for (std::size_t i = 0; i < std::min(capacity, all.size()); ++i) {
      const ContactPoint& c = all[i];
      tegotae_contact& out = contacts[i];
      out.part = c.part.index;
      out.began = c.ticks == 0 ? 1 : 0;
      store(c.point_a, out.point_a);
      store(c.point_b, out.point_b);
      store(c.normal, out.normal);
      out.gap = c.gap;
      out.force = c.force.value_or(std::numeric_limits<double>::quiet_NaN());
      store(c.friction, out.friction);
      out.slides = c.slides ? 1 : 0;
    }
    return static_cast<int64_t>(all.size());
  });
}

int tegotae_rig_part(const tegotae_rig* rig, double pose[7]) {
  return guarded(kFailed, [&] {
    required(pose, "pose");
    store(required(rig, "rig").rig->part(), pose);
    return 0;
  });
}

int tegotae_rig_lead(tegotae_rig* rig, const double pose[7]) {
  return guarded(kFailed, [&] {
    tegotae_rig& r = required(rig, "rig");
    if (!r.pen) throw Error("the pen belongs to another process; only its own hand moves it");
    r.guide.lead(pose_of(pose));
    return 0;
  });
}

int tegotae_rig_change(tegotae_rig* rig, const tegotae_scene* scene, double seconds) {
  return guarded(kFailed, [&] {
    SceneChange change = required(rig, "rig").rig->change(required(scene, "scene").scene);
    if (!(seconds > 0)) return 0;
    change.wait(seconds);
    if (change.cancel()) throw Error("the held part blocks the change, or no thread steps the rig");
    if (change.state() == ChangeState::replaced) throw Error("a later change replaced this one before it was in force");
    return 0;
  });
}

}  // extern "C"
