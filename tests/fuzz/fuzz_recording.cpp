// Recordings, CSV and MCAP: read_recording. A CSV file has its info in a file beside it, so the input has two parts.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "fuzz/fuzz.hpp"
#include "tegotae/core/error.hpp"
#include "tegotae/record/recorder.hpp"
#include "tegotae/record/recording.hpp"

namespace tegotae {

namespace {

// What stands between the recording and its info.
const std::string kCut = "\n--info--\n";

std::string file_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A recording of three frames, written by Recorder under a name that chooses its format.
std::string written(const std::string& name) {
  const std::string path = (scratch_folder() / name).string();
  Recorder recorder(path, RecordMode::synchronous);
  for (int i = 0; i < 3; ++i) {
    RecordFrame frame;
    frame.tick = static_cast<std::uint64_t>(i);
    frame.t = 0.001 * i;
    frame.x.p.z() = -0.1 * i;
    frame.gap = i == 0 ? INFINITY : 1e-5;
    recorder.push(frame);
  }
  recorder.close();
  return file_bytes(path);
}

}  // namespace

std::vector<Seed> seeds() {
  const std::string csv = written("seed.csv"), mcap = written("seed.mcap");
  return {{"csv", csv},
          {"csv_with_info", csv + kCut + R"({"scene":"a.toml","held":"peg","resolver":"qp","program":"x"})"},
          {"csv_bad_info", csv + kCut + "{]"},
          {"csv_cut", csv.substr(0, csv.size() - 20)},
          {"mcap", mcap},
          {"mcap_cut", mcap.substr(0, 3 * mcap.size() / 4)},
          {"header_only", csv.substr(0, csv.find('\n') + 1)}};
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  const std::size_t cut = bytes.find(kCut);
  const std::string path = write_input("input.csv", bytes.data(), std::min(cut, bytes.size()));
  const std::string info = recording_info_path(path);
  std::filesystem::remove(info);
  if (cut != std::string::npos) std::ofstream(info, std::ios::binary) << bytes.substr(cut + kCut.size());
  try {
    const Recording recording = read_recording(path);
    require(recording.frames.size() <= size, "no more frames than bytes");
    require(recording.damage.find('\n') == std::string::npos, "the damage is one line");
  } catch (const Error& e) {
    const std::string what = e.what();
    require(what.rfind(path, 0) == 0 || what.rfind(info, 0) == 0, "the error begins with the file");
    require(what.find('\n') == std::string::npos, "the error is one line");
  }
  return 0;
}

}  // namespace tegotae
