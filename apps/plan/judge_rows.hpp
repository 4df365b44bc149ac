#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "plan/judge.hpp"

namespace tegotae::plan {

/// What figures of a scene come from, in a word: this program's file, the options, and the parts of the scene. Throws
/// Error.
std::string judged_from(const JudgedScene& scene, const JudgeOptions& options);

/// Figures that were made, in a file, so that a run that was ended goes on where it was.
class JudgeRows {
 public:
  /// `path` empty: nothing is kept. A file that is not there is empty. Throws Error.
  explicit JudgeRows(std::string path);

  /// Those of a scene, if they come from the same.
  std::optional<JudgedFigures> find(const std::string& scene, const std::string& from) const;
  /// Writes the file anew. Throws Error.
  void keep(const std::string& scene, const std::string& from, const JudgedFigures& figures);

 private:
  std::string path_;
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::object();
};

}  // namespace tegotae::plan
