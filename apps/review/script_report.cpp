#include "review/script_report.hpp"

#include <optional>

#include "core/output_file.hpp"
#include "loop/scene_parts.hpp"
#include "review/review.hpp"
#include "shared/temporary_folder.hpp"
#include "tegotae/core/version.hpp"
#include "tegotae/session/session.hpp"

namespace tegotae::review {

std::string script_report(SceneFile file, const std::string& script) {
  const apps::TemporaryFolder folder;
  const std::string csv = (folder.path() / "hand.csv").string();
  write_file(csv, script);
  const StylusScript own = file.script;
  file.script = read_script(csv);
  held_part(file.scene).pose = file.script.pose(file.script.begin());
  RunSettings settings;
  settings.real_time = false;
  settings.record = (folder.path() / "hand.mcap").string();
  settings.program = "tegotae " TEGOTAE_VERSION_STRING;
  run_session(file, settings);
  // A script that rests goes nowhere; then the hand's own end is taken.
  ReviewQuestions questions;
  if (own.end() > own.begin()) questions.goal = own.pose(own.end());
  return report_html(review_recording("hand.mcap", read_recording(settings.record), std::move(file), questions, {}),
                     {});
}

}  // namespace tegotae::review
