// Every bad input is one line on stderr that names it, exit code 2, and no crash.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>

#include "apps/refusal.hpp"
#include "apps/run_program.hpp"
#include "catch.hpp"
#include "text.hpp"

using namespace tegotae::test;

namespace {

/// Stands in a folder as long as it lives.
class InFolder {
 public:
  explicit InFolder(const std::string& folder) { std::filesystem::current_path(folder); }
  ~InFolder() { std::filesystem::current_path(before_); }
  InFolder(const InFolder&) = delete;
  InFolder& operator=(const InFolder&) = delete;

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
};

}  // namespace

TEST_CASE("meshes that cannot be used are refused", "[bad_input]") {
  const TempFolder folder;
  write_small_scene(folder);
  folder.write("empty.obj", "");
  folder.write("empty.stl", "");
  folder.write("no_triangles.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  folder.write("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  folder.write("range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n");
  folder.write("nan.obj", "v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("huge.obj", "v 0 0 1e30\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("part.step",
               "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n");
  folder.write("text.obj", "this is not a mesh\n");
  folder.write("truncated.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n");
  // A binary STL that announces 12 triangles and has one.
  std::string stl(80, ' ');
  stl += std::string("\x0c\0\0\0", 4) + std::string(50, '\0');
  folder.write("truncated.stl", stl);
  for (const std::string mesh : {"missing.obj", "empty.obj", "empty.stl", "no_triangles.obj", "range.obj", "range.off",
                                 "nan.obj", "huge.obj", "part.step", "text.obj", "truncated.ply", "truncated.stl"}) {
    INFO(mesh);
    check_refused(run_program("tegotae", "check " + (folder / mesh)), {mesh});
    folder.write("bad.toml", replaced(read_text(folder / "scene.toml"), "tet.obj", mesh));
    check_refused(run_program("tegotae", "run --fast " + (folder / "bad.toml")), {"bad.toml:4: part.mesh: ", mesh});
  }
}

TEST_CASE("scenes that cannot be run are refused", "[bad_input]") {
  const TempFolder folder;
  write_small_scene(folder);
  folder.write("bad.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.02,1,0,0,0\n1,0,0,oops,1,0,0,0\n");
  folder.write("back.csv", "t,px,py,pz,qw,qx,qy,qz\n1,0,0,0.02,1,0,0,0\n0,0,0,0.02,1,0,0,0\n");
  folder.write("zero.csv", "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0.02,0,0,0,0\n");
  folder.write("header.csv", "time,x\n0,0\n");
  folder.write("no_rows.csv", "t,px,py,pz,qw,qx,qy,qz\n");
  const std::string good = read_text(folder / "scene.toml");
  struct Case {
    std::string scene;
    std::vector<std::string> named;
  };
  const Case cases[] = {
      {good + "[contact]\nlmin = 1\n", {"bad.toml:13: contact.lmin: "}},
      {good + "[contact]\nl_min = \"small\"\n", {"bad.toml:13: contact.l_min: "}},
      {good + "[coupling]\nstiffness = -1\n", {"bad.toml:13: coupling.stiffness: "}},
      {good + "[contact]\nresolver = \"magic\"\n", {"bad.toml:13: contact.resolver: ", "magic"}},
      {good + "[contact\n", {"bad.toml:12: not valid TOML"}},
      {replaced(good, "held = true", "held = false"), {"bad.toml:2: part: no part is held"}},
      {replaced(good, "\"block\"", "\"block\"\nheld = true"), {"bad.toml:", "part.held: "}},
      {good + "type = \"pen\"\n", {"bad.toml:12: device.type: ", "pen"}},
      {replaced(good, "path.csv", "none.csv"), {"bad.toml:11: device.script: ", "none.csv"}},
      {replaced(good, "path.csv", "bad.csv"), {"bad.toml:11: device.script: ", "bad.csv:3"}},
      {replaced(good, "path.csv", "back.csv"), {"bad.toml:11: device.script: ", "back.csv:3"}},
      {replaced(good, "path.csv", "zero.csv"), {"bad.toml:11: device.script: ", "zero.csv:2"}},
      {replaced(good, "path.csv", "header.csv"), {"bad.toml:11: device.script: ", "header.csv:1"}},
      {replaced(good, "path.csv", "no_rows.csv"), {"bad.toml:11: device.script: ", "no_rows.csv"}},
      // The two parts in one place: all faces of the one meet those of the other.
      {replaced(good, "[0, 0, 0.02]", "[0.001, 0.001, 0.001]"),
       {"bad.toml: ", "block", "peg", "intersect", "triangle pairs"}},
  };
  for (const Case& c : cases) {
    INFO(c.scene);
    folder.write("bad.toml", c.scene);
    check_refused(run_program("tegotae", "run --fast " + (folder / "bad.toml")), c.named);
    // A scene without a held part may be looked at; --hold can name one later.
    if (c.named.front().find("no part is held") == std::string::npos)
      check_refused(run_program("tegotae", "check " + (folder / "bad.toml")), c.named);
  }
  check_refused(run_program("tegotae", "run --fast " + (folder / "none.toml")), {"none.toml: no such file"});
  check_refused(run_program("tegotae", "run --fast --hold lid " + (folder / "scene.toml")),
                {"no part is named lid (there are block, peg)"});
  // A file of parts is told from a damaged scene, whatever is in it and however its ending is written.
  for (const std::string part :
       {"tet.obj", "pump.STEP", "pump.stp", "a.glb", "a.gltf", "a.3mf", "a.Stl", "a.ply", "a.off"}) {
    if (part != "tet.obj") folder.write(part, "anything");
    check_refused(run_program("tegotae", "run --fast " + (folder / part)),
                  {part + ": a file of parts has no script", "`tegotae view "});
    check_refused(run_program("tegotae", "try " + (folder / part)), {part + ": is a file of parts", "tegotae import"});
  }
  check_refused(run_program("tegotae", "run --fast " + (folder / "path.csv")),
                {"path.csv: is a recording or a script, not a scene", "`tegotae view "});
  folder.write("README.md", "# Parts\nNone.\n");
  check_refused(run_program("tegotae", "run --fast " + (folder / "README.md")),
                {"README.md:", "not valid TOML", "is this a scene file?"});
}

TEST_CASE("a file that is not there is named so by every command that takes one", "[bad_input]") {
  const TempFolder folder;
  const std::string out = folder / "out";
  for (const std::string file : {"none.step", "none.obj", "none.glb", "none.toml", "none"}) {
    const std::string path = folder / file;
    for (const std::string& command :
         {"run " + path, "run --fast " + path, "run --view " + path, "view " + path, "check " + path,
          "import " + path + " -o " + out, "try " + path, "plan " + path, "plan --all " + path, "study " + path}) {
      INFO(command);
      check_refused(run_program("tegotae", command), {file, "no such file"});
    }
  }
  for (const std::string command : {"replay ", "review ", "view "})
    check_refused(run_program("tegotae", command + (folder / "none.csv")), {"none.csv", "no such file"});
  // Where a command is wanted, what is named like a file is taken for one that is to be looked at.
  for (const std::string file : {"none.step", "none.toml", "none.csv", "none"})
    check_refused(run_program("tegotae", folder / file), {file, "no such file"});
  check_refused(run_program("tegotae", "gone.step"), {"gone.step: no such file"});
  CHECK(run_program("tegotae", "--help").out.find("tegotae FILE is tegotae view FILE") != std::string::npos);
}

TEST_CASE("a file of no known kind is refused with the kinds that are read", "[bad_input]") {
  const TempFolder folder;
  std::string bytes;
  for (int i = 0; i < 4096; ++i) bytes += static_cast<char>((i * i * 37 + 11 * i) >> 3);
  for (const std::string file : {"picture.bin", "picture.toml", "picture", "picture.jpg"}) {
    folder.write(file, bytes);
    const std::string path = folder / file;
    for (const std::string& command :
         {"run --fast " + path, "view " + path, path, "try " + path, "plan " + path, "study " + path})
      check_refused(run_program("tegotae", command), {file, "binary", ".toml", ".step", ".3mf", ".mcap"});
    for (const std::string& command : {"check " + path, "import " + path + " -o " + (folder / "out")})
      check_refused(run_program("tegotae", command), {file, file == "picture.toml" ? "" : "stl, obj, ply"});
  }
  // Text is not binary, whatever letters it has.
  folder.write("word.toml", "name = \"K\xc3\xb6rper \xe6\x89\x8b\"\n");
  check_refused(run_program("tegotae", "run --fast " + (folder / "word.toml")), {"word.toml", "unknown key"});
}

TEST_CASE("scripts longer than any run are refused, long ones named, and --seconds ends both before", "[bad_input]") {
  const TempFolder folder;
  write_small_scene(folder);
  const auto run = [&](const std::string& end, const std::string& more) {
    folder.write("long.csv", "t,px,py,pz,qw,qx,qy,qz\n1000,0,0,0.05,1,0,0,0\n" + end + ",0,0,0.05,1,0,0,0\n");
    return run_program("tegotae",
                       "run --fast " + (folder / "scene.toml") + " --script " + (folder / "long.csv") + more);
  };
  for (const char* end : {"1e9", "1e15", "1e300"}) {
    check_refused(run(end, ""), {"the stylus script lasts", "longest run"});
    const Output cut = run(end, " --seconds 0.01");
    CHECK(cut.code == 0);
    CHECK(cut.err.find("note: the script") == std::string::npos);
  }
  const std::string usage = " --seconds 0.01";
  CHECK(run("5000", usage).err.find("note: the script") == std::string::npos);
}

TEST_CASE("bad usage is refused", "[bad_input]") {
  const TempFolder folder;
  write_small_scene(folder);
  const std::string scene = folder / "scene.toml";
  check_refused(run_program("tegotae", ""), {"no command is given", "run", "view", "--help"});
  check_refused(run_program("tegotae", "dance"), {"no command dance", "run", "review", "--help"});
  check_refused(run_program("tegotae", "run"), {"SCENE"});
  check_refused(run_program("tegotae", "check"), {"FILE"});
  check_refused(run_program("tegotae", "run --frobnicate " + scene), {"frobnicate"});
  check_refused(run_program("tegotae", "run --seconds -1 " + scene), {"--seconds"});
  check_refused(run_program("tegotae", "run --seconds nan " + scene), {"--seconds"});
  check_refused(run_program("tegotae", "run --seconds 1e300 " + scene), {"--seconds"});
  check_refused(run_program("tegotae", "run --seconds soon " + scene), {"--seconds"});
  check_refused(run_program("tegotae", "run --fast --resolver magic " + scene), {"magic"});
  check_refused(run_program("tegotae", "run --fast --record " + (folder / "none/rec.csv") + " " + scene),
                {"none/rec.csv"});
  check_refused(run_program("tegotae", "run --fast --record " + (folder / "") + " " + scene), {});
  check_refused(run_program("peg_in_hole", "--ratio 1.2"), {"--ratio"});
  check_refused(run_program("peg_in_hole", "--ratio 0"), {"--ratio"});
  check_refused(run_program("peg_in_hole", "--ratio nan"), {"--ratio"});
  check_refused(run_program("peg_in_hole", "--fast --resolver magic"), {"magic"});
  check_refused(run_program("peg_in_hole", "--fast --record " + (folder / "none/rec.csv")), {"none/rec.csv"});
  check_refused(run_program("peg_in_hole", "extra"), {"extra"});
}

TEST_CASE("a file whose name begins like an option is named with the way to give it", "[bad_input]") {
  const TempFolder folder;
  write_small_scene(folder);
  folder.write("-dash.obj", read_text(folder / "tet.obj"));
  const InFolder in(folder / "");
  for (const std::string command : {"check", "import -o out", "run --fast scene.toml"})
    check_refused(run_program("tegotae", command + " -dash.obj"), {"-dash.obj begins like an option", "./-dash.obj"});
  CHECK(run_program("tegotae", "check ./-dash.obj").code == 0);
  CHECK(run_program("tegotae", "check -- -dash.obj").code == 0);
  check_refused(run_program("tegotae", "check -none.obj"), {"see --help"});
}

TEST_CASE("pipes that cannot be read twice are refused and not waited for", "[bad_input]") {
  const TempFolder folder;
  write_small_scene(folder);
  for (const std::string name : {"pipe.obj", "pipe", "pipe.csv"}) REQUIRE(mkfifo((folder / name).c_str(), 0600) == 0);
  for (const std::string name : {"pipe.obj", "pipe"})
    check_refused(run_program("tegotae", "import " + (folder / name) + " -o " + (folder / "out")),
                  {name + ":", "is not a regular file"});
  check_refused(run_program("tegotae", "run --fast " + (folder / "scene.toml") + " --guide " + (folder / "pipe.csv")),
                {"pipe.csv: is not a regular file"});
}

TEST_CASE("an address that cannot be listened on says why", "[bad_input]") {
  const TempFolder folder;
  write_small_scene(folder);
  const int taken = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof at;
  REQUIRE(bind(taken, reinterpret_cast<const sockaddr*>(&at), size) == 0);
  REQUIRE(listen(taken, 1) == 0);
  REQUIRE(getsockname(taken, reinterpret_cast<sockaddr*>(&at), &size) == 0);
  const auto view = [&](const std::string& address) {
    return run_program("tegotae", "view " + (folder / "scene.toml") + " --no-browser --view-address " + address);
  };
  const std::string busy = "127.0.0.1:" + std::to_string(ntohs(at.sin_port));
  check_refused(view(busy), {"cannot listen on " + busy, "another program listens there", "another port"});
  close(taken);
  // An address that is for documentation and no machine's (RFC 5737).
  check_refused(view("192.0.2.1:8080"), {"cannot listen on 192.0.2.1:8080", "this machine has no such address"});
}

TEST_CASE("help and version are not errors", "[bad_input]") {
  for (const std::string program : {"demo", "tegotae", "tegotae-device", "peg_in_hole", "tegotae-models",
                                    "tegotae-load-mesh", "families", "stress", "tegotae bench", "tegotae experiment"}) {
    for (const std::string flag : {"--help", "--version"}) {
      const Output o = run_program(program, flag);
      CHECK(o.code == 0);
      CHECK(o.err == "");
      CHECK(o.out != "");
    }
  }
  CHECK(run_program("tegotae", "run --help").out.find("--resolver") != std::string::npos);
}

TEST_CASE("no program ends in a crash for an argument that it does not know", "[bad_input]") {
  const TempFolder folder;  // where none of the files is that examples look for
  const InFolder in(folder / "");
  for (const std::string program :
       {"first_touch", "example_driver", "demo", "families", "stress", "tegotae-models", "tegotae-load-mesh"})
    for (const std::string argument : {"--help", "--version", "--frobnicate", "a.step"}) {
      INFO(program << " " << argument);
      const Output o = run_program(program, argument);
      CHECK(o.code <= 2);
      CHECK(o.out + o.err != "");
    }
}
