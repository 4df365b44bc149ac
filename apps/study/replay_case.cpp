#include "study/replay_case.hpp"

#include <filesystem>

#include "core/same_file.hpp"
#include "shared/format.hpp"
#include "shared/status_line.hpp"
#include "study/case_scene.hpp"
#include "study/report.hpp"
#include "view/replay.hpp"

namespace tegotae::study {

std::optional<Replay> replay_case(const Study& study, Tasks& tasks, int number, const std::string& folder,
                                  const MeshLoader& load, const std::atomic<bool>& stop) {
  const Case c = make_case(study, number);
  const std::size_t steps = tasks.of(c).size();
  Replay made;
  made.page = folder + "/" + std::filesystem::path(replay_page(number)).filename().string();
  const std::vector<std::string> inputs = tasks.inputs();
  refuse_to_replace(made.page, inputs);
  const RecordTo record_to = [&](SceneFile& file, std::size_t step) {
    const std::string to = steps == 1 ? folder : folder + "/step-" + std::to_string(step + 1);
    file.path = write_case_scene(file, c, to, inputs);
    made.recordings.push_back(to + "/recording.mcap");
    refuse_to_replace(made.recordings.back(), inputs);
    return made.recordings.back();
  };
  apps::StatusLine status;
  status.say(apps::format("running case %d", number));
  const std::optional<Result> result = run_case(study, tasks, c, stop, record_to);
  if (!result) return std::nullopt;
  made.result = *result;
  const auto progress = [&](const char* what, std::size_t done, std::size_t total) { status.show(what, done, total); };
  view::write_replay(view::replay_bundle(made.recordings.back(), {}, made.page, view::kMaxFrames, progress, load),
                     made.page);
  return made;
}

}  // namespace tegotae::study
