#include "record/recording_info.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/output_file.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae {

namespace {
constexpr struct {
  const char* name;
  std::string RecordingInfo::*text;
} kFields[] = {{"scene", &RecordingInfo::scene},
               {"held", &RecordingInfo::held},
               {"resolver", &RecordingInfo::resolver},
               {"program", &RecordingInfo::program},
               {"suspended", &RecordingInfo::filtered},
               {"follows", &RecordingInfo::continues},
               {"goes_on", &RecordingInfo::continued_by},
               {"guide", &RecordingInfo::guide},
               {"goal", &RecordingInfo::goal},
               {"goal_tolerance", &RecordingInfo::goal_tolerance},
               {"judged_after", &RecordingInfo::judged_after}};
}  // namespace

std::string recording_info_path(const std::string& path) {
  return path + ".info.json";
}

std::map<std::string, std::string> info_fields(const RecordingInfo& info) {
  std::map<std::string, std::string> fields;
  for (const auto& f : kFields)
    if (!(info.*f.text).empty()) fields[f.name] = info.*f.text;
  return fields;
}

RecordingInfo info_of(const std::map<std::string, std::string>& fields) {
  RecordingInfo info;
  for (const auto& f : kFields) {
    const auto found = fields.find(f.name);
    if (found != fields.end()) info.*f.text = found->second;
  }
  return info;
}

void write_info(const RecordingInfo& info, const std::string& path) {
  std::error_code absent;
  if (!std::filesystem::is_regular_file(path, absent)) return;  // /dev/null and pipes have nothing beside them
  const std::string beside = recording_info_path(path);
  const auto fields = info_fields(info);
  if (fields.empty()) {
    std::filesystem::remove(beside, absent);
    return;
  }
  OutputFile file(beside);
  file.write(nlohmann::json(fields).dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
  file.close();
}

RecordingInfo read_info(const std::string& path) {
  const std::string beside = recording_info_path(path);
  std::ifstream in(beside);
  if (!in) return {};
  const nlohmann::json json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object())
    throw Error(ErrorKind::file, beside + ": is not the info of a recording (a JSON object of texts); remove it",
                {beside, 0, {}, {}});
  std::map<std::string, std::string> fields;
  for (const auto& [name, value] : json.items())
    if (value.is_string()) fields[name] = value.get<std::string>();
  return info_of(fields);
}

}  // namespace tegotae
