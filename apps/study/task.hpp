#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "study/routes.hpp"
#include "study/study.hpp"
#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::study {

/// What an operator is to do in one scene.
struct Task {
  SceneFile file;
  Vec3 center;  ///< of mass of the held part, m, file frame
  std::vector<Route> routes;
};

/// The scenes of a study, and the tasks in them, each made when it is first asked for. From any thread.
class Tasks {
 public:
  /// `files`: the study's scenes, in its order. Throws Error when one does not fit the study.
  Tasks(const Study& study, std::vector<SceneFile> files);

  const SceneFile& file(const Case& c) const;
  /// The tasks of a case, one after the other: one, or of an order one for each of its parts. Throws Error for a scene
  /// in which nothing can be tried.
  std::vector<std::shared_ptr<const Task>> of(const Case& c);
  /// Everything that the result of a case depends on, beside its number: as text without a line's end.
  std::string fingerprint() const;
  /// All that was read.
  std::vector<std::string> inputs() const;

 private:
  std::shared_ptr<const Task> task(std::size_t scene, std::size_t order, std::size_t step);
  Task make(std::size_t scene, std::size_t order, std::size_t step) const;

  const Study& study_;
  std::vector<SceneFile> files_;
  std::mutex mutex_;
  std::map<std::vector<std::size_t>, std::shared_ptr<const Task>> made_;  // by scene, order, step
};

/// Reads the scenes of a study, their meshes by `load`, and makes their tasks' source. Shows how far it is, and what
/// the files lack.
std::unique_ptr<Tasks> load_tasks(const Study& study, const MeshLoader& load);

}  // namespace tegotae::study
