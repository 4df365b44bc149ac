// Where the server listens, what slow clients can do to the run, and what a page sees of another process's pen.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "catch.hpp"
#include "spawn.hpp"
#include "view/watcher.hpp"

using namespace tegotae::test;

namespace {

/// The addresses (hexadecimal, as the kernel prints them) on which somebody listens on `port`.
std::vector<std::string> listening(int port) {
  std::vector<std::string> found;
  char wanted[8];
  std::snprintf(wanted, sizeof wanted, ":%04X", static_cast<unsigned>(port));
  for (const char* table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream file(table);
    std::string number, local, remote, state, rest;
    while (file >> number >> local >> remote >> state && std::getline(file, rest)) {
      const std::size_t colon = local.find(':');
      if (state == "0A" && colon != local.npos && local.substr(colon) == wanted)
        found.push_back(local.substr(0, colon));
    }
  }
  return found;
}

}  // namespace

TEST_CASE("it listens on the loopback alone, unless told otherwise") {
  Served s({"peg_in_hole", "--view", "--json"});
  CHECK(listening(s.port) == std::vector<std::string>{"0100007F"});
  Served everywhere({"peg_in_hole", "--view", "--view-address", "0.0.0.0", "--json"});
  CHECK(listening(everywhere.port) == std::vector<std::string>{"00000000"});
  CHECK(ask(everywhere.port, get(everywhere, "/scene")) == 200);
  CHECK(ask(everywhere.port, {"GET", "/scene", "", everywhere.host(), "", "", ""}) == 403);
  check_going_on(s);
  check_going_on(everywhere);
  check_end(s);
  check_end(everywhere);
}

TEST_CASE("clients that send a byte at a time") {
  Served s({"peg_in_hole", "--view", "--json"});
  Watcher watcher(s);
  const std::string requests[] = {text_of(get(s, "/scene")), text_of(command(s, std::string(1500, ' ')))};
  // More than there are threads to serve them.
  std::vector<std::unique_ptr<Connection>> slow;
  for (int i = 0; i < 50; ++i) slow.push_back(std::make_unique<Connection>(s.port));
  long last = watcher.next();
  for (std::size_t at = 0; at < 60; ++at) {
    for (std::size_t i = 0; i < slow.size(); ++i) slow[i]->send(requests[i % 2].substr(at, 1));
    const long tick = watcher.next();
    CHECK(tick > last);
    last = tick;
  }
  slow.clear();
  check_going_on(s);
  check_end(s);
}

TEST_CASE("a page sees the force, the tick times and the servo's lateness of another process's pen") {
  const std::string name = "view-test-" + std::to_string(::getpid());
  Program device({TEGOTAE_BIN_DIR "/tegotae-device", "--type", "simulated", "--name", name, "--script",
                  TEGOTAE_MODELS_DIR "/insert_0.94.csv"});
  device.line();
  Served s(
      {"tegotae", "run", TEGOTAE_MODELS_DIR "/peg_in_hole_0.94.toml", "--device", "shm:" + name, "--view", "--json"});
  Watcher watcher(s);
  bool late = false, ticked = false;
  // The servo tells ten times a second; a frame comes thirty times.
  for (int i = 0; i < 300 && !(late && ticked); ++i) {
    REQUIRE(watcher.next() >= 0);
    ticked |= watcher.row()[25] > 0;
    late |= std::isfinite(watcher.row()[26]) && watcher.row()[26] > 0;
  }
  CHECK(ticked);
  CHECK(late);
  check_end(s);
  CHECK(device.end(SIGINT) == 0);
}

TEST_CASE("strangers who keep hundreds of connections do not keep the page from who has the token") {
  Served s({"peg_in_hole", "--view", "--json"});
  const std::string request = text_of(get(s, "/scene"));
  std::vector<std::unique_ptr<Connection>> strangers;
  // Silent ones, and some that begin a request and never end it.
  for (int i = 0; i < 300; ++i) {
    strangers.push_back(std::make_unique<Connection>(s.port, 0, 100));
    if (i % 3 == 0) strangers.back()->send(request.substr(0, static_cast<std::size_t>(i % 60)));
  }
  // Many times ten seconds, were each of them waited for by one of twenty threads.
  for (int i = 0; i < 3; ++i) CHECK(ask(s.port, get(s, "/scene")) == 200);
  Watcher watcher(s);
  CHECK(watcher.next() >= 0);
  for (int i = 0; i < 100; ++i) strangers.push_back(std::make_unique<Connection>(s.port, 0, 100));
  // Who has brought the token is not taken for one of them, and the end waits for nobody.
  long last = watcher.next();
  for (int i = 0; i < 60; ++i) {
    const long tick = watcher.next();
    CHECK(tick > last);
    last = tick;
  }
  check_end(s);
}

TEST_CASE("nobody without the token is answered, whatever is asked for") {
  Served s({"peg_in_hole", "--view", "--json"});
  for (const char* method : {"OPTIONS", "HEAD", "PUT", "TRACE", "GET"}) {
    CAPTURE(method);
    const Connection connection(s.port);
    connection.send(std::string(method) + " /command HTTP/1.1\r\nHost: " + s.host() +
                    "\r\nOrigin: http://elsewhere\r\nAccess-Control-Request-Method: POST\r\n"
                    "Access-Control-Request-Headers: X-Tegotae-Token\r\nContent-Length: 0\r\n\r\n");
    const std::string answer = connection.receive();
    INFO(answer);
    CHECK(answer.rfind("HTTP/1.1 4", 0) == 0);
    CHECK(answer.find("Access-Control-Allow") == std::string::npos);
  }
  check_going_on(s);
  check_end(s);
}

TEST_CASE("a page that is open to other machines says so, and where it is for them") {
  Served s({"peg_in_hole", "--view", "--view-address", "0.0.0.0", "--json"});
  check_going_on(s);
  check_end(s);
  CHECK(s.err().find("warning: Anybody who can reach this machine") != std::string::npos);
  CHECK(s.err().find("http://0.0.0.0") == std::string::npos);
  Served own({"peg_in_hole", "--view", "--json"});
  check_going_on(own);
  check_end(own);
  CHECK(own.err().find("warning") == std::string::npos);
}

TEST_CASE("anything can be looked at: a mesh, a scene that holds nothing, a recording") {
  const TempFolder folder, temporary;
  write_small_scene(folder);
  std::string scene = read_text(folder / "scene.toml");
  scene.replace(scene.find("held = true"), 11, "held = false");
  folder.write("loose.toml", scene);
  REQUIRE(run_program("tegotae", "run --fast --record " + (folder / "r.csv") + " " + (folder / "scene.toml")).code ==
          0);
  ::setenv("TMPDIR", (temporary / "").c_str(), 1);
  for (const std::string file : {"tet.obj", "loose.toml", "r.csv"}) {
    CAPTURE(file);
    Served s({"tegotae", "view", folder / file, "--unit", "mm"});
    CHECK(ask(s.port, get(s, "/scene")) == 200);
    s.interrupt();
    CHECK(s.wait() == 0);
    CHECK((s.out().find("Nothing is held: pick a part in the page") != std::string::npos) == (file != "r.csv"));
    // What was made of a mesh is gone with the page.
    for (const auto& left : std::filesystem::directory_iterator(temporary / ""))
      CHECK(left.path().filename().string().rfind("tegotae-view", 0) != 0);
  }
  ::unsetenv("TMPDIR");
}

TEST_CASE("a report on a script is made for who has the token, of scripts that can be read") {
  Served s({"tegotae", "run", TEGOTAE_MODELS_DIR "/peg_in_hole_0.94.toml", "--view", "--fast", "--json"});
  const auto review = [](const Served& served, const std::string& script) {
    return Request{"POST", "/review", served.token, served.host(), "http://" + served.host(), script, ""};
  };
  Request stranger = review(s, "t");
  stranger.token = "";
  CHECK(ask(s.port, stranger) == 403);
  std::string answer;
  CHECK(ask(s.port, review(s, "t,px,py,pz,qw,qx,qy,qz\n0,0,0,x,1,0,0,0\n"), &answer) == 400);
  CHECK_THAT(answer, Catch::Contains("x"));
  CHECK(ask(s.port, review(s, "")) == 404);
  CHECK(ask(s.port, review(s, std::string((4u << 20) + 1, ' '))) == 413);
  // A program without reports says so.
  Served peg({"peg_in_hole", "--view", "--fast", "--json"});
  CHECK(ask(peg.port, review(peg, "t,px,py,pz,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n")) == 404);
}
