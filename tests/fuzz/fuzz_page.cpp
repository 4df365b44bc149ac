// The page's commands: parse_command, LiveView::command and PageParts::edit, one command a line.
#include <atomic>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fuzz/fuzz.hpp"
#include "fuzz/mesh_seeds.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/import/load.hpp"
#include "view/live_view.hpp"
#include "view/page_parts.hpp"
#include "view/wire.hpp"

namespace tegotae {

namespace {

constexpr std::size_t kParts = 2;
constexpr double kFarthest = 110;  // m: 100 for the part's middle

SceneFile two_parts() {
  const std::string bytes = mesh_seeds("obj").front().bytes;
  const std::string path = write_input("tet.obj", bytes.data(), bytes.size());
  const auto mesh = std::make_shared<const TriangleMesh>(load_mesh(path, 1.0));
  SceneFile file{"two.toml", {}, {}, StylusScript({{0.0, Pose{}}})};
  for (std::size_t i = 0; i < kParts; ++i) {
    Part part;
    part.name = "part " + std::to_string(i);
    part.mesh = mesh;
    part.held = i == 1;
    part.pose.p.z() = 2.0 * static_cast<double>(i);
    file.scene.parts.push_back(part);
  }
  return file;
}

/// What a page can bring about, whatever it sends.
void look(view::LiveView& view, std::atomic<bool>& stop) {
  const auto status = nlohmann::json::parse(view.status());
  const auto& speed = status.at("speed");
  require(speed.is_null() || (speed.get<double>() >= 0.01 && speed.get<double>() <= 10), "the speed is in its range");
  require(status.at("paused").is_boolean(), "it is paused or not");
  const bool ended = stop;
  require(view.again() == ended, "what the page wants instead of a session ends that");
  require(!stop, "nothing but a new session ends this one");
}

void look(const view::PageParts& parts) {
  require(parts.all().size() == kParts, "no part is lost");
  require(parts.held() < kParts && !parts.removed(parts.held()), "one of the scene's parts is held");
  for (const Part& part : parts.in_scene()) {
    require(part.pose.p.allFinite() && part.pose.p.cwiseAbs().maxCoeff() < kFarthest, "parts are where they can be");
    require(std::abs(part.pose.q.norm() - 1) < 1e-9, "their rotations are such");
  }
}

void obey(view::LiveView& view, view::PageParts& parts, const std::string& line) {
  try {
    const nlohmann::json command = view::parse_command(line);
    // Without a session the view changes no parts, so they are asked themselves.
    if (command.is_object() && command.contains("part")) parts.edit(command);
    view.command(command);
  } catch (const Error& e) {
    require(std::string(e.what()).find('\n') == std::string::npos, "the error is one line");
  } catch (const nlohmann::json::exception&) {
    // The server answers that this is not a command.
  }
}

}  // namespace

std::vector<Seed> seeds() {
  return {{"commands",
           "{\"do\":\"pause\"}\n{\"do\":\"step\",\"ticks\":7}\n{\"do\":\"play\"}\n{\"do\":\"speed\",\"factor\":0.1}\n"
           "{\"do\":\"speed\",\"factor\":null}\n{\"do\":\"restart\"}\n{\"do\":\"hold\",\"part\":0}\n"
           "{\"do\":\"lead\",\"pose\":[0,0.1,-2e-3,1,0,0,0]}\n"},
          {"numbers",
           "{\"do\":\"step\",\"ticks\":1e300}\n{\"do\":\"step\",\"ticks\":-9223372036854775808}\n"
           "{\"do\":\"step\",\"ticks\":18446744073709551615}\n{\"do\":\"hold\",\"part\":-1}\n"
           "{\"do\":\"hold\",\"part\":1e30}\n{\"do\":\"speed\",\"factor\":-1e308}\n"
           "{\"do\":\"lead\",\"pose\":[1e308,0,0,1e308,1e308,1e-320,0]}\n"
           "{\"do\":\"lead\",\"pose\":[0,0,0,1e200,1e200,0,0]}\n{\"do\":\"lead\",\"pose\":[0,0,0,0,0,0,0]}\n"},
          {"wrong",
           "[]\n{\"do\":5}\n{\"do\":\"a\\nb\"}\n{\"do\":\"lead\",\"pose\":{\"a\":1}}\n{\"do\":\"step\"}\nnull\n"
           "{\"do\":\"hold\",\"part\":\"0\"}\n\xff\xfe\n"},
          {"edits",
           "{\"do\":\"hold\",\"part\":0}\n{\"do\":\"remove\",\"part\":1}\n{\"do\":\"add\",\"part\":1}\n"
           "{\"do\":\"move\",\"part\":1,\"by\":[0,0.01,-2],\"turn\":[0.1,0,-3]}\n"
           "{\"do\":\"move\",\"part\":1,\"by\":[1e308,0,0],\"turn\":[0,0,0]}\n{\"do\":\"move\",\"part\":1}\n"},
          {"deep", "{\"do\":[[[[[[1]]]]]]}\n"}};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static std::atomic<bool> stop{false};
  static const SceneFile file = two_parts();
  static view::LiveView view(file, true, true, true, stop);
  view::PageParts parts(file.scene);
  std::istringstream lines(std::string(reinterpret_cast<const char*>(data), size));
  for (std::string line; std::getline(lines, line);) {
    obey(view, parts, line);
    look(view, stop);
    look(parts);
  }
  return 0;
}

}  // namespace tegotae
