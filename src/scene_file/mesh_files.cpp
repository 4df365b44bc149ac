#include "scene_file/mesh_files.hpp"

#include <atomic>
#include <exception>

#include "core/parallel_for.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

void MeshFiles::add(std::size_t part, const TomlTable& t, const std::string& file, double unit_in_m) {
  const auto [place, added] = place_.try_emplace({file, unit_in_m}, files_.size());
  if (added) files_.push_back({file, unit_in_m, t, {}});
  files_[place->second].parts.push_back(part);
}

void MeshFiles::read(const SceneOptions& options, std::vector<Part>& parts) const {
  const auto n = static_cast<int>(files_.size());
  std::vector<std::exception_ptr> failures(files_.size());
  std::atomic<int> failed{n};  // the first in order that is known
  const auto read_one = [&](int i) {
    if (i > failed) return;
    const auto place = static_cast<std::size_t>(i);
    const File& file = files_[place];
    try {
      const auto mesh = std::make_shared<const TriangleMesh>(options.load(file.path, file.unit_in_m));
      for (const std::size_t part : file.parts) parts[part].mesh = mesh;
    } catch (...) {
      failures[place] = std::current_exception();
      for (int known = failed; i < known && !failed.compare_exchange_weak(known, i);) continue;
    }
  };
  const auto total = static_cast<std::size_t>(n);
  if (options.progress) options.progress(0, total);
  parallel_for(n, 0, read_one, [&](int done) {
    if (options.progress) options.progress(static_cast<std::size_t>(done), total);
  });
  if (failed == n) return;
  const auto first = static_cast<std::size_t>(failed.load());
  try {
    std::rethrow_exception(failures[first]);
  } catch (const Error& e) {
    files_[first].named_by.fail("mesh", e.what());
  }
}

}  // namespace tegotae
