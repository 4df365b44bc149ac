#include "stress_record.hpp"

#include <algorithm>
#include <filesystem>
#include <iomanip>

#include "models/write_obj.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::test {
namespace {

const std::string& created(const std::string& folder) {
  std::filesystem::create_directories(folder);
  return folder;
}

void write_key(std::ofstream& out, double t, const Pose& Y) {
  out << t << ',' << Y.p.x() << ',' << Y.p.y() << ',' << Y.p.z() << ',' << Y.q.w() << ',' << Y.q.x() << ',' << Y.q.y()
      << ',' << Y.q.z() << '\n';
}

}  // namespace

StressRecord::StressRecord(const std::string& folder, const StressScene& scene, unsigned seed)
    : stem_(scene.name + "_" + std::to_string(seed)),
      script_(created(folder) + "/" + stem_ + "_pen.csv"),
      recorder_(folder + "/" + stem_ + ".csv", RecordMode::synchronous) {
  write_scene(folder, scene);
  const Part& held =
      *std::find_if(scene.scene.parts.begin(), scene.scene.parts.end(), [](const Part& p) { return p.held; });
  script_ << std::setprecision(17) << "t,px,py,pz,qw,qx,qy,qz\n";
  write_key(script_, 0, held.pose);
  RecordFrame frame;
  frame.x = frame.y = held.pose;
  recorder_.push(frame);
}

void StressRecord::write_scene(const std::string& folder, const StressScene& scene) {
  std::ofstream toml(folder + "/" + stem_ + ".toml");
  toml << std::setprecision(17);
  for (std::size_t i = 0; i < scene.scene.parts.size(); ++i) {
    const Part& part = scene.scene.parts[i];
    std::string file = scene.sources[i].file, unit = scene.sources[i].unit;
    if (file.empty()) {
      file = stem_ + "_" + part.name + ".obj";
      unit = "mm";
      write_obj(*part.mesh, folder + "/" + file);
    }
    const Quat& q = part.pose.q;
    const Vec3& p = part.pose.p;
    toml << "[[part]]\nname = \"" << part.name << "\"\nmesh = \"" << file << "\"\nunit = \"" << unit
         << "\"\nposition = [" << p.x() << ", " << p.y() << ", " << p.z() << "]\norientation = [" << q.w() << ", "
         << q.x() << ", " << q.y() << ", " << q.z() << "]\n"
         << (part.held ? "held = true\n\n" : "\n");
  }
  toml << "[device]\nscript = \"" << stem_ << "_pen.csv\"\n";
  if (!toml.flush()) throw Error(folder + ": the scene file cannot be written");
}

void StressRecord::add(int tick, const Pose& Y, const TickReport& report) {
  RecordFrame frame;
  frame.tick = static_cast<std::uint64_t>(tick) + 1;
  frame.t = 1e-3 * (tick + 1);
  frame.y = Y;
  frame.contacts = report.contacts;
  frame.gap = report.gap;
  for (const Pose& X : report.substeps) {
    frame.x = X;
    recorder_.push(frame);
    ++frame.substep;
  }
  write_key(script_, frame.t, Y);
}

void StressRecord::close() {
  recorder_.close();
  if (!script_.flush()) throw Error(stem_ + "_pen.csv cannot be written");
}

}  // namespace tegotae::test
