// What programs write: never over what they read, and whatever happens to it, no program dies or hangs of it.
#include <sys/stat.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

#include "apps/run_program.hpp"
#include "catch.hpp"
#include "spawn.hpp"

using namespace tegotae::test;
namespace fs = std::filesystem;

namespace {

/// `command` by bash, with $B for the folder of the programs and `folder` as the working one.
Output shell(const TempFolder& folder, const std::string& command) {
  const TempFolder texts;
  folder.write("command.sh", "B=" TEGOTAE_BIN_DIR "\n" + command + "\n");
  const std::string line = "cd " + (folder / "") + " && timeout -k 5 120 bash command.sh >" + (texts / "out") + " 2>" +
                           (texts / "err") + " </dev/null";
  const int status = std::system(line.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(texts / "out"),
          read_text(texts / "err")};
}

void check_named(const Output& o, const std::vector<std::string>& named) {
  INFO("stdout: " << o.out);
  INFO("stderr: " << o.err);
  CHECK(o.code == 2);
  for (const std::string& text : named) {
    INFO("named: " << text);
    CHECK(o.err.find(text) != std::string::npos);
  }
}

/// A small scene with a recording of it.
struct Recorded {
  TempFolder folder;
  Recorded() {
    write_small_scene(folder);
    REQUIRE(shell(folder, "$B/tegotae run scene.toml --fast --seconds 0.1 --record r.csv").code == 0);
  }
};

}  // namespace

TEST_CASE("an output that is an input of the same command is refused, by whatever name", "[outputs]") {
  const Recorded r;
  struct Case {
    std::string victim, command;  // @ stands for the victim's name
  };
  const Case cases[] = {
      {"scene.toml", "$B/tegotae run scene.toml --fast --seconds 0.1 --record @"},
      {"tet.obj", "$B/tegotae run scene.toml --fast --seconds 0.1 --record @"},
      {"path.csv", "$B/tegotae run scene.toml --fast --seconds 0.1 --record @"},
      {"r.csv", "$B/tegotae replay r.csv scene.toml --html @"},
      {"r.csv.info.json", "$B/tegotae replay r.csv scene.toml --html @"},
      {"scene.toml", "$B/tegotae replay r.csv --html @"},
      {"r.csv", "$B/tegotae review r.csv --out @"},
      {"scene.toml", "$B/tegotae review r.csv --out @"},
      {"tet.obj", "$B/tegotae review r.csv --out x.html --gltf @"},
      {"r.csv", "$B/tegotae review r.csv --out x.html --csv @"},
      {"path.csv", "$B/tegotae review r.csv --out x.html --script @"},
      {"meshes/tet.ply", "$B/tegotae import meshes/tet.ply -o ."},
  };
  fs::create_directory(r.folder / "meshes");
  REQUIRE(shell(r.folder,
                "$B/tegotae import tet.obj -o made && mv made/meshes/*.ply meshes/tet.ply && mv scene.toml s && "
                "cp s scene.toml && rm s")
              .code == 0);
  fs::create_symlink("r.csv", r.folder / "link.csv");
  fs::create_hard_link(r.folder / "scene.toml", r.folder / "hard.toml");
  for (const Case& c : cases) {
    std::vector<std::string> names = {c.victim, "./" + c.victim};
    if (c.victim == "r.csv") names.push_back("link.csv");
    if (c.victim == "scene.toml") names.push_back("hard.toml");
    const bool import = c.command.find("import") != std::string::npos;
    if (import) names.resize(1);
    for (const std::string& name : names) {
      std::string command = c.command;
      if (!import) command.replace(command.find('@'), 1, name);
      CAPTURE(command);
      const std::string before = read_text(r.folder / c.victim);
      if (import) fs::rename(r.folder / "scene.toml", r.folder / "aside");
      check_named(shell(r.folder, command), {"would be replaced"});
      if (import) fs::rename(r.folder / "aside", r.folder / "scene.toml");
      CHECK(!before.empty());
      CHECK(read_text(r.folder / c.victim) == before);
    }
  }
}

TEST_CASE("the buffer that a mesh of the scene names is an input", "[outputs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const float corners[] = {0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10};
  const std::uint16_t faces[] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  folder.write("a b.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners) +
                              std::string(reinterpret_cast<const char*>(faces), sizeof faces));
  folder.write("tet.gltf",
               R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
"buffers":[{"uri":"a%20b.bin","byteLength":72}],
"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":24}],
"accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","min":[0,0,0],"max":[10,10,10]},
{"bufferView":1,"componentType":5123,"count":12,"type":"SCALAR"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}]})");
  std::string scene = read_text(folder / "scene.toml");
  scene.replace(scene.find("tet.obj"), 7, "tet.gltf");
  folder.write("scene.toml", scene);
  const std::string run = "$B/tegotae run scene.toml --fast --seconds 0.1 --record ";
  REQUIRE(shell(folder, run + "r.csv").code == 0);
  const std::string before = read_text(folder / "a b.bin");
  for (const std::string name : {"'a b.bin'", "'./a b.bin'", "tet.gltf"})
    check_named(shell(folder, run + name), {"would be replaced"});
  check_named(shell(folder, "$B/tegotae review r.csv --out 'a b.bin'"), {"would be replaced"});
  CHECK(read_text(folder / "a b.bin") == before);
}

TEST_CASE("tries do not replace the scene's files, and two outputs are two files", "[outputs]") {
  const Recorded r;
  fs::create_directory(r.folder / "tries");
  fs::copy(r.folder / "path.csv", r.folder / "tries/best.csv");
  std::string scene = read_text(r.folder / "scene.toml");
  scene.replace(scene.find("path.csv"), 8, "tries/best.csv");
  r.folder.write("scene.toml", scene);
  check_named(shell(r.folder, "$B/tegotae try scene.toml --tries 1 --seconds 1"), {"best.csv", "would be replaced"});
  CHECK(read_text(r.folder / "tries/best.csv") == read_text(r.folder / "path.csv"));
  check_named(shell(r.folder, "$B/tegotae review r.csv --out x --csv ./x"), {"writes it twice"});
  CHECK_FALSE(fs::exists(r.folder / "x"));
  CHECK(shell(r.folder, "$B/tegotae review r.csv --out x --csv /dev/null --script /dev/null").code != 2);
  CHECK(fs::exists(r.folder / "x"));
}

TEST_CASE("a folder that cannot be made is named with the cause", "[outputs]") {
  const Recorded r;
  r.folder.write("file", "");
  for (const std::string command :
       {"tegotae plan scene.toml --to file", "tegotae plan scene.toml --all --to file",
        "tegotae try scene.toml --tries 1 --seconds 1 --out file", "tegotae import tet.obj --unit mm -o file",
        "tegotae experiment friction --quick --out file", "tegotae-models --out file",
        "tegotae-models --puzzles --out file", "peg_in_hole --fast --scene-out file"}) {
    CAPTURE(command);
    check_named(shell(r.folder, "$B/" + command), {"file", ": cannot be made: Not a directory"});
  }
}

TEST_CASE("standard output that cannot be written is told by every program", "[outputs]") {
  const TempFolder folder;
  write_small_scene(folder);
  for (const std::string command :
       {"tegotae run scene.toml --fast --seconds 0.1", "tegotae run scene.toml --fast --seconds 0.1 --json",
        "tegotae check tet.obj", "tegotae --help", "tegotae import tet.obj -o made", "peg_in_hole --help",
        "tegotae-device --help", "tegotae-models --help", "tegotae-load-mesh --help", "tegotae-load-mesh --version",
        "demo --help", "demo --version", "families --help", "stress --help"}) {
    CAPTURE(command);
    check_named(shell(folder, "$B/" + command + " >/dev/full"), {"standard output could not be written"});
  }
  // A reader that is gone.
  check_named(
      shell(folder, "$B/tegotae run scene.toml --fast --seconds 0.1 | { exec 0<&-; sleep 3; }; exit ${PIPESTATUS[0]}"),
      {"standard output could not be written"});
}

TEST_CASE("a recording that cannot go on ends no run, and what was lost is told", "[outputs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const auto whole_run = [](const Output& o, int ticks, const std::string& cause) {
    check_named(o, {cause, "it has the first ", " rows"});
    const auto j = nlohmann::json::parse(o.out);
    CHECK(j.at("ticks").get<int>() >= ticks);
    CHECK(j.at("record_failure").get<std::string>().find(cause) != std::string::npos);
  };
  SECTION("a limit of size") {
    whole_run(shell(folder, "ulimit -f 20; $B/tegotae run scene.toml --fast --seconds 0.5 --json --record r.csv"), 500,
              "File too large");
    CHECK(fs::file_size(folder / "r.csv") == 20 * 1024);
    whole_run(shell(folder, "ulimit -f 20; $B/tegotae run scene.toml --fast --seconds 0.5 --json --record r.mcap"), 500,
              "File too large");
  }
  SECTION("a reader that goes, beside a servo in its own thread") {
    whole_run(
        shell(folder, "mkfifo p; head -c 3000 p >/dev/null & $B/tegotae run scene.toml --seconds 1 --json --record p"),
        10, "Broken pipe");
  }
  SECTION("a reader that does not read") {
    whole_run(shell(folder,
                    "mkfifo p; sleep 60 <p & $B/tegotae run scene.toml --fast --seconds 1 --json --record p; "
                    "code=$?; kill %1; exit $code"),
              1000, "the reader of the pipe does not read");
  }
  SECTION("no reader") {
    check_named(shell(folder, "mkfifo p; $B/tegotae run scene.toml --fast --record p"), {"pipe without a reader"});
    check_named(shell(folder, "mkfifo q; $B/tegotae replay r.csv --html q"), {"r.csv"});
  }
  SECTION("a full disk from the beginning") {
    check_named(shell(folder, "$B/tegotae run scene.toml --fast --record /dev/full"), {"/dev/full", "No space left"});
  }
}

TEST_CASE("a disk that is full while a run goes on", "[outputs]") {
  const TempFolder folder;
  write_small_scene(folder);
  fs::create_directory(folder / "disk");
  const Output o = shell(folder,
                         "unshare -m bash -c 'mount -t tmpfs -o size=64k t disk || exit 77; "
                         "$0/tegotae run scene.toml --fast --seconds 1 --json --record disk/r.csv' $B || "
                         "exit $?");
  if (o.code == 77 || o.err.find("unshare") != std::string::npos) {
    std::cout << "SKIPPED: no mount namespace here\n";
    return;
  }
  check_named(o, {"No space left", "it has the first "});
  CHECK(nlohmann::json::parse(o.out).at("ticks") == 1000);
}

TEST_CASE("a report that has no room leaves the one that stood there", "[outputs]") {
  const Recorded r;
  struct Case {
    std::string file, command;
  };
  const Case cases[] = {
      {"page.html", "$0/tegotae review r.csv --out disk/page.html"},
      {"path.csv", "$0/tegotae review r.csv --out /dev/null --csv disk/path.csv"},
      {"page.html", "$0/tegotae replay r.csv scene.toml --html disk/page.html"},
      {"order.csv", "$0/tegotae plan scene.toml --all --iterations 1 --to disk"},
      {"path.csv", "$0/tegotae plan scene.toml --iterations 1 --to disk"},
  };
  fs::create_directory(r.folder / "disk");
  for (const Case& c : cases) {
    CAPTURE(c.command);
    const Output o =
        shell(r.folder, "unshare -m bash -c 'mount -t tmpfs -o size=64k t disk || exit 77; echo old >disk/" + c.file +
                            "; head -c 60K /dev/zero >disk/fill; while echo >>disk/rest; do :; done 2>/dev/null; " +
                            c.command + " >/dev/null; code=$?; cat disk/" + c.file +
                            "; ls -A disk | tr \"\\n\" \" \"; exit $code' $B");
    if (o.code == 77 || o.err.find("unshare") != std::string::npos) {
      std::cout << "SKIPPED: no mount namespace here\n";
      return;
    }
    check_named(o, {"disk/" + c.file, "No space left"});
    CHECK(o.out == "old\nfill " + (c.file < "rest" ? c.file + " rest " : "rest " + c.file + " "));
  }
}

TEST_CASE("/dev/shm without room is an error and no signal", "[outputs]") {
  const TempFolder folder;
  write_small_scene(folder);
  for (const std::string command :
       {"tegotae-device --type simulated --script path.csv --name outputs-full", "tegotae run scene.toml --seconds 0.2",
        "tegotae run scene.toml --seconds 0.2 --fast"}) {
    CAPTURE(command);
    const Output o = shell(folder,
                           "unshare -m bash -c 'mount -t tmpfs -o size=8k,mode=1777 t /dev/shm || exit 77; "
                           "head -c 8192 /dev/zero >/dev/shm/fill; $0/" +
                               command + "' $B");
    if (o.code == 77 || o.err.find("unshare") != std::string::npos) {
      std::cout << "SKIPPED: no mount namespace here\n";
      return;
    }
    check_named(o, {"/dev/shm", "No space left"});
  }
}

TEST_CASE("a program without standard descriptors writes into none of its files", "[outputs]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string run = "$B/tegotae run scene.toml --fast --seconds 0.1 --record ";
  REQUIRE(shell(folder, run + "good.csv").code == 0);
  for (const std::string how : {"<&- >&-", "<&- >&- 2>&-", ">&-", ">&- 2>&-"}) {
    CAPTURE(how);
    CHECK(shell(folder, run + "r.csv " + how).code == 0);
    CHECK(read_text(folder / "r.csv") == read_text(folder / "good.csv"));
    CHECK(shell(folder, run + "r.csv --view " + how + " & sleep 1; kill -INT $!; wait $!").code != 139);
    // The device says much on its way; its segment stays one that others can read.
    const std::string name = "outputs-closed-" + std::to_string(::getpid());
    const Output status = shell(folder, "$B/tegotae-device --type simulated --script path.csv --name " + name + " " +
                                            how + " &\nfor i in $(seq 200); do $B/tegotae-device --name " + name +
                                            " --status --json 2>err && break; sleep 0.05; done\nkill -INT $!; wait $!");
    INFO(status.err);
    CHECK(status.out.find("\"name\":\"/" + name) != std::string::npos);
    CHECK(status.code == 0);
  }
}
