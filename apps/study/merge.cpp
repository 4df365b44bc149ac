#include "study/merge.hpp"

#include <algorithm>
#include <filesystem>

#include "tegotae/core/error.hpp"

namespace tegotae::study {

namespace fs = std::filesystem;

std::string shard_folder(const std::string& out) {
  return out + "/shards";
}

std::map<int, Result> read_shards(const Study& study, const std::string& out, const TableLayout& layout) {
  std::vector<std::string> paths;
  std::error_code failed;
  for (const auto& entry : fs::directory_iterator(shard_folder(out), failed))
    if (entry.path().extension() == ".csv") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  std::map<int, Result> rows;
  std::map<int, std::string> from;
  for (const std::string& path : paths) {
    const CaseTable table(path, layout);
    for (const auto& [number, r] : table.rows()) {
      if (r.parameters != parameter_cells(study, make_case(study, number)))
        throw Error(path + ": case " + std::to_string(number) +
                    " has other parameters than the study gives it; delete its line");
      const auto [there, added] = rows.emplace(number, r);
      if (added) {
        from[number] = path;
      } else if (row_text(there->second) != row_text(r)) {
        throw Error("case " + std::to_string(number) + " has another result in " + path + " than in " + from[number] +
                    ": the machines do not compute the same; make one of them again with the other's build");
      }
    }
  }
  return rows;
}

}  // namespace tegotae::study
