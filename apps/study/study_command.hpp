#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tegotae/scene_file/scene_file.hpp"

namespace tegotae::study {

struct StudyOptions {
  std::string study;  ///< path of the study file
  std::string out;    ///< folder; empty: beside the study file, with its name
  std::string shard = "1/1";
  int jobs = 0;              ///< of a shard
  int shards = 0;            ///< of `run`; 0: fits study and processors
  int processors = 0;        ///< of `run`; 0: all
  int replays = 5;           ///< of `merge` and `run`: how many cases get their page at once
  std::vector<int> numbers;  ///< of `case`
  std::string to;            ///< of `case`: folder of one; empty: in `out`
  MeshLoader load;           ///< reads the meshes
  bool trusted = false;      ///< shards of `run` read theirs in their own process
  CLI::App* self = nullptr;
  CLI::App* run = nullptr;
  CLI::App* merge = nullptr;
  CLI::App* one = nullptr;  ///< `case`
};

/// The subcommand `study`.
CLI::App* add_study(CLI::App& app, StudyOptions& options);

/// Does what its command line asks for. Returns the exit code. Throws Error.
int run_study(const StudyOptions& options);

}  // namespace tegotae::study
