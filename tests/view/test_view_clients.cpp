// Clients of every kind against a run in real time: who may not gets nothing, and whatever they do, the run goes on and
// ends as it should. Nothing is timed; ticks are counted.
#include <random>
#include <thread>

#include "catch.hpp"
#include "view/watcher.hpp"

using namespace tegotae::test;
using Catch::Contains;

namespace {

std::string garbage(std::mt19937& random, std::size_t most) {
  std::string bytes(random() % most + 1, '\0');
  for (char& b : bytes) b = static_cast<char>(random());
  return bytes;
}

}  // namespace

TEST_CASE("only the page of this address with its token is served") {
  Served s({"peg_in_hole", "--view", "--json"});
  std::string answer;
  CHECK(ask(s.port, {"GET", "/?token=" + s.token, "", s.host(), "", "", ""}, &answer) == 200);
  CHECK_THAT(answer, Contains("Content-Security-Policy: default-src 'none'") && Contains("frame-ancestors 'none'"));
  CHECK(ask(s.port, get(s, "/scene")) == 200);
  CHECK(ask(s.port, get(s, "/stream")) == 200);
  CHECK(ask(s.port, get(s, "/etc/passwd")) == 404);
  CHECK(ask(s.port, get(s, "/../../etc/passwd")) != 200);

  for (const char* path :
       {"/", "/?token=", "/?token=00000000000000000000000000000000", "/scene", "/stream", "/command"}) {
    INFO(path);
    CHECK(ask(s.port, {"GET", path, "", s.host(), "", "", ""}) == 403);
    CHECK(ask(s.port, {"GET", path, std::string(32, '0'), s.host(), "", "", ""}) == 403);
  }
  for (const char* path : {"/scene", "/stream"}) {
    INFO(path);
    CHECK(ask(s.port, {"GET", path, s.token, s.host(), "http://evil.example", "", ""}) == 403);
    CHECK(ask(s.port, {"GET", path, s.token, "evil.example:" + std::to_string(s.port), "", "", ""}) == 403);
    CHECK(ask(s.port, {"GET", path, s.token, s.host(), "", "", "Sec-Fetch-Site: cross-site\r\n"}) == 403);
    CHECK(ask(s.port, {"GET", path + std::string("?token=") + s.token, "", s.host(), "", "", ""}) == 403);
  }
  Request foreign = command(s, R"({"do":"restart"})");
  foreign.origin = "http://127.0.0.1:1";
  CHECK(ask(s.port, foreign) == 403);
  check_going_on(s);
  check_end(s);
}

TEST_CASE("commands are bounded and checked") {
  Served s({"peg_in_hole", "--view", "--fast", "--json"});
  CHECK(ask(s.port, command(s, R"({"do":"step","ticks":5})")) == 200);
  CHECK(ask(s.port, command(s, R"({"do":"lead","pose":[0,0,0.045,1,0,0,0]})")) == 200);
  for (const char* bad : {"",
                          "{",
                          "[]",
                          "null",
                          "7",
                          R"({"do":7})",
                          R"({"do":"fly"})",
                          R"({"do":"lead"})",
                          R"({"do":"lead","pose":[1,2]})",
                          R"({"do":"lead","pose":[1,2,3,0,0,0,0]})",
                          R"({"do":"lead","pose":[1e300,2,3,1,0,0,0]})",
                          R"({"do":"lead","pose":["a",2,3,1,0,0,0]})",
                          R"({"do":"hold","part":99})",
                          R"({"do":"hold","part":-1})",
                          R"({"do":"step"})",
                          R"({"do":"remove"})",
                          R"({"do":"add","part":"x"})",
                          R"({"do":"add","part":0})",
                          R"({"do":"move","part":0})",
                          R"({"do":"move","part":0,"by":[1,2],"turn":[0,0,0]})",
                          R"({"do":"move","part":0,"by":[0,0,0],"turn":[0,1e300,0]})",
                          R"({"do":"step","ticks":1e300})",
                          R"({"do":"hold","part":0.5})",
                          R"({"do":"a\nb"})",
                          R"({"do":"speed","factor":"x"})",
                          R"([[[[[[1]]]]]])",
                          "{\"do\":\"\xff\xfe\"}"}) {
    INFO(bad);
    CHECK(ask(s.port, command(s, bad)) == 400);
  }
  CHECK(ask(s.port, command(s, std::string(1000, '[') + std::string(1000, ']'))) == 400);
  CHECK(ask(s.port, command(s, std::string(5000, ' '))) == 413);
  Request endless = command(s, "");
  endless.extra = "Transfer-Encoding: chunked\r\n";
  CHECK(ask(s.port, endless) != 200);
  Request lying = command(s, "");
  lying.method = "PUT";
  lying.extra = "Content-Length: 99999999999\r\n";
  CHECK(ask(s.port, lying) != 200);
  CHECK(ask(s.port, command(s, R"({"do":"play"})")) == 200);
  check_going_on(s);
  check_end(s);
}

TEST_CASE("virtual time stands until it is told to go, and steps") {
  Served s({"peg_in_hole", "--view", "--fast", "--json"});
  CHECK(ask(s.port, command(s, R"({"do":"step","ticks":7})")) == 200);
  Watcher watcher(s);
  CHECK(watcher.next() <= 6);
  CHECK(ask(s.port, command(s, R"({"do":"step","ticks":3})")) == 200);
  long tick = 0;
  while (tick < 9) tick = watcher.next();
  CHECK(tick == 9);  // ten ticks, from 0
  s.interrupt();
  CHECK(s.wait() == 0);
  CHECK(nlohmann::json::parse(s.out()).at("ticks") == 10);
}

TEST_CASE("clients that never read") {
  Served s({"peg_in_hole", "--view", "--json"});
  std::vector<std::unique_ptr<Connection>> deaf;
  for (int i = 0; i < 4; ++i) {
    deaf.push_back(std::make_unique<Connection>(s.port, 2048));
    CHECK(deaf.back()->send(text_of(get(s, "/stream"))));
    // And one that asks for more than fits into any buffer.
    deaf.push_back(std::make_unique<Connection>(s.port, 2048));
    std::string many;
    for (int k = 0; k < 300; ++k) many += text_of(get(s, "/scene"));
    deaf.back()->send(many);
  }
  check_going_on(s);
  CHECK(ask(s.port, get(s, "/scene")) == 200);
  check_end(s);  // also with the deaf ones still there
}

TEST_CASE("more pages than may watch are told so") {
  Served s({"peg_in_hole", "--view", "--json"});
  std::vector<std::unique_ptr<Watcher>> watchers;
  for (int i = 0; i < 8; ++i) {
    watchers.push_back(std::make_unique<Watcher>(s));
    CHECK(watchers.back()->next() >= 0);
  }
  CHECK(ask(s.port, get(s, "/stream")) == 503);
  CHECK(watchers.front()->next() >= 0);
  watchers.clear();
  // Those who went are noticed when they do not take the next frame.
  int status = 0;
  for (int i = 0; i < 50 && status != 200; ++i) {
    ::usleep(100'000);
    status = ask(s.port, get(s, "/stream"));
  }
  CHECK(status == 200);
  check_end(s);
}

TEST_CASE("garbage") {
  Served s({"peg_in_hole", "--view", "--json"});
  Watcher watcher(s);
  std::mt19937 random(20240607);
  const long before = watcher.next();
  for (int i = 0; i < 150; ++i) {
    const Connection connection(s.port, 0, 50);
    if (!connection.open()) continue;
    std::string bytes;
    switch (i % 6) {
      case 0:
        bytes = garbage(random, 3000);
        break;
      case 1:
        bytes = "GET /" + garbage(random, 200) + " HTTP/1.1\r\n\r\n";
        break;
      case 2:
        bytes = "GET / HTTP/1.1\r\nHost: " + std::string(20000, 'a') + "\r\n\r\n";
        break;
      case 3:
        bytes = text_of(command(s, garbage(random, 500)));
        break;
      case 4:  // half a body, then gone
        bytes = text_of(command(s, std::string(1000, ' ')));
        bytes.resize(bytes.size() - 500);
        break;
      default: {
        Request upgrade = get(s, "/stream");
        upgrade.extra =
            "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n";
        bytes = text_of(upgrade) + "\x82\xff\x00\x00\x00\x00\x7f\x00\x00\x00" + garbage(random, 500);
      }
    }
    connection.send(bytes);
    if (i % 2 == 0) connection.receive(100);
  }
  CHECK(watcher.next() > before);
  check_going_on(s);
  check_end(s);
}

TEST_CASE("fifty at once") {
  Served s({"peg_in_hole", "--view", "--json"});
  Watcher watcher(s);
  const long before = watcher.next();
  std::vector<std::thread> crowd;
  for (int i = 0; i < 50; ++i)
    crowd.emplace_back([&s, i] {
      std::mt19937 random(static_cast<unsigned>(i));
      for (int k = 0; k < 4; ++k) {
        switch ((i + k) % 4) {
          case 0:
            ask(s.port, get(s, "/scene"));
            break;
          case 1:
            ask(s.port, command(s, R"({"do":"lead","pose":[0,0,0.045,1,0,0,0]})"));
            break;
          case 2:
            ask(s.port, get(s, "/stream"));
            break;
          default: {
            const Connection c(s.port);
            c.send(garbage(random, 1000));
          }
        }
      }
    });
  for (std::thread& t : crowd) t.join();
  CHECK(watcher.next() > before);
  check_going_on(s);
  check_end(s);
}

TEST_CASE("the page is told which parts are suspended, until they have come free") {
  const TempFolder folder;
  write_small_scene(folder);
  // Drawn into each other by some millimeters, then pulled apart.
  folder.write("path.csv",
               "t,px,py,pz,qw,qx,qy,qz\n0,0.002,0,0,1,0,0,0\n2,0.002,0,0,1,0,0,0\n3,0.002,0,0.02,1,0,0,0\n");
  std::string scene = read_text(folder / "scene.toml");
  scene.replace(scene.find("[0, 0, 0.02]"), 12, "[0.002, 0, 0]");
  folder.write("scene.toml", scene + "[contact]\ninitial_overlap = \"ignore\"\n");
  Served s({"tegotae", "run", "--view", "--json", folder / "scene.toml"});
  Watcher watcher(s);
  const auto suspended = [&] {
    while (watcher.status().empty() && watcher.next() >= 0) {
    }
    return nlohmann::json::parse(watcher.status()).at("suspended");
  };
  CHECK(suspended() == nlohmann::json::array({"block"}));
  for (int i = 0; i < 1000 && !suspended().empty(); ++i) watcher.next();
  CHECK(suspended().empty());
  check_end(s);
}
