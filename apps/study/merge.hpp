#pragma once

#include <string>

#include "study/case_table.hpp"

namespace tegotae::study {

/// The folder of a study's shards.
std::string shard_folder(const std::string& out);

/// All cases that the shards in the folder have, however the study was cut. Throws Error `file:line: reason` for a
/// table of another study, and for a case that has two results, or other parameters than the study gives it.
std::map<int, Result> read_shards(const Study& study, const std::string& out, const TableLayout& layout);

}  // namespace tegotae::study
