#pragma once

#include <map>
#include <string>

#include "tegotae/record/recording.hpp"

namespace tegotae {

/// The info under the names that files use.
std::map<std::string, std::string> info_fields(const RecordingInfo& info);
/// The other way round; names that are not known are skipped.
RecordingInfo info_of(const std::map<std::string, std::string>& fields);

/// Writes the info of the CSV recording `path` beside it, or removes what an older recording left there when `info` is
/// empty. Throws Error.
void write_info(const RecordingInfo& info, const std::string& path);
/// Reads it; empty when there is none. Throws Error for a file that is something else.
RecordingInfo read_info(const std::string& path);

}  // namespace tegotae
