#include "record/record_file.hpp"

#include "record/csv_file.hpp"
#include "record/mcap_file.hpp"

namespace tegotae {

std::unique_ptr<RecordFile> open_record_file(const std::string& path, const RecordingInfo& info) {
  const std::string ending = ".mcap";
  const bool mcap =
      path.size() >= ending.size() && path.compare(path.size() - ending.size(), ending.size(), ending) == 0;
  if (mcap) return std::make_unique<McapFile>(path, info);
  return std::make_unique<CsvFile>(path, info);
}

}  // namespace tegotae
