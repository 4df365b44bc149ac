#include <sys/utsname.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "bench/results.hpp"
#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::bench {
namespace {

namespace fs = std::filesystem;

const char* const kBegin = "<!-- begin generated -->\n";
const char* const kEnd = "<!-- end generated -->\n";

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";
}

std::string setting(const std::string& command, const Results& results) {
  utsname system{};
  uname(&system);
  bool fifo = true;
  for (const SceneFigures& s : results.rows) fifo = fifo && s.hand.fifo;
  char took[64];
  std::snprintf(took, sizeof took, "%.0f s", results.seconds);
  return "- Machine: " + processor() + ", " + std::to_string(std::thread::hardware_concurrency()) +
         " cores, one used; " + system.sysname + " " + system.release + "; the loop's thread " +
         (fifo ? "under SCHED_FIFO" : "at normal priority") +
         "\n"
#ifdef __clang__
         "- Compiler: clang "
#else
         "- Compiler: g++ "
#endif
         __VERSION__ ", release build for any x86-64\n- Command: `" +
         command + "` (took " + took + ")\n";
}

}  // namespace

void update_markdown(const std::string& path, const std::string& command, const Results& results) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw Error(path + ": cannot be read: " + std::strerror(errno));
  const std::string old(std::istreambuf_iterator<char>(in), {});
  const std::size_t begin = old.find(kBegin), end = old.find(kEnd);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw Error(path + ": has no lines \"<!-- begin generated -->\" and \"<!-- end generated -->\"");
  const fs::path plot = fs::path(path).replace_extension(".svg");
  refuse_to_replace(plot.string(), {path});
  write_file(plot.string(), growth_plot(results));
  write_file(path, old.substr(0, begin) + kBegin + "\n" + setting(command, results) + "\n" + tables(results) +
                       "\n![Median of the tick against the number of triangles](" + plot.filename().string() + ")\n\n" +
                       old.substr(end));
}

}  // namespace tegotae::bench
