#include "study/study_command.hpp"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <thread>

#include "core/output_file.hpp"
#include "core/same_file.hpp"
#include "shared/format.hpp"
#include "shared/option_check.hpp"
#include "shared/run_options.hpp"
#include "study/driver.hpp"
#include "study/merge.hpp"
#include "study/outcome.hpp"
#include "study/replay_case.hpp"
#include "study/report.hpp"
#include "study/shard.hpp"
#include "study/study_file.hpp"
#include "tegotae/core/error.hpp"

namespace tegotae::study {
namespace {

namespace fs = std::filesystem;
using apps::format;

// Of `run`, for each processor: few enough that starting them costs nothing, many enough that none waits long at the
// end.
constexpr int kShardsPerProcessor = 8;
constexpr std::size_t kMaxNamed = 10;  // missing cases

/// A study, its scenes, and where its results are.
struct Opened {
  Study study;
  std::unique_ptr<Tasks> tasks;
  std::string out;
  TableLayout layout;
  MeshLoader load;
};

std::string default_out(const std::string& study) {
  const std::string without = fs::path(study).replace_extension().string();
  return without == study ? study + ".out" : without;
}

void open(const StudyOptions& o, Opened& s) {
  s.study = read_study(o.study);
  s.load = o.load;
  s.tasks = load_tasks(s.study, s.load);
  s.out = o.out.empty() ? default_out(o.study) : o.out;
  s.layout = layout_of(s.study, *s.tasks);
}

int say_interrupted() {
  std::cout << "interrupted; the same command continues from here" << std::endl;
  return apps::kRunFailed;
}

int run_shard(const StudyOptions& o) {
  const Shard shard = parse_shard(o.shard);
  Opened s;
  open(o, s);
  const std::string path = shard_folder(s.out) + "/" + shard_file(shard);
  refuse_to_replace(path, s.tasks->inputs());
  CaseTable table(path, s.layout);
  const std::vector<int> numbers = numbers_of(shard, case_count(s.study));
  const std::atomic<bool>& interrupted = apps::catch_interrupts();
  run_missing(s.study, *s.tasks, numbers, o.jobs, table, interrupted);
  if (interrupted) return say_interrupted();
  std::vector<Result> results;
  for (const int i : numbers) results.push_back(table.rows().at(i));
  std::cout << "shard " << o.shard << ": " << headline(results, "cases") << std::endl;
  return apps::kDone;
}

/// The numbers that are not there.
std::vector<int> missing(const std::map<int, Result>& rows, int cases) {
  std::vector<int> out;
  for (int i = 0; i < cases; ++i)
    if (rows.count(i) == 0) out.push_back(i);
  return out;
}

/// Makes the replays of the cases that are to be looked at first. Of which they are there; fewer when interrupted.
std::vector<int> make_replays(const Opened& s, const std::vector<Result>& results, int most,
                              const std::atomic<bool>& interrupted) {
  std::vector<int> made;
  for (const int number : worth_seeing(results, static_cast<std::size_t>(most))) {
    if (!replay_case(s.study, *s.tasks, number, s.out + "/" + case_folder(number), s.load, interrupted)) break;
    made.push_back(number);
  }
  std::sort(made.begin(), made.end());
  return made;
}

int merge(const Opened& s, int replays) {
  const int cases = case_count(s.study);
  std::map<int, Result> rows = read_shards(s.study, s.out, s.layout);
  const std::vector<int> left = missing(rows, cases);
  if (!left.empty()) {
    std::string list;
    for (std::size_t i = 0; i < std::min(kMaxNamed, left.size()); ++i)
      list += (i == 0 ? "" : ", ") + std::to_string(left[i]);
    std::cerr << "tegotae: " << shard_folder(s.out) << format(": %zu of %d cases are missing: ", left.size(), cases)
              << list << (left.size() > kMaxNamed ? " ..." : "") << "\n";
    return apps::kRunFailed;
  }
  rows.erase(rows.lower_bound(cases), rows.end());  // of more repeats than now
  std::vector<std::string> outputs;
  for (const char* name : {"/cases.csv", "/summary.json", "/report.html"}) outputs.push_back(s.out + name);
  refuse_to_replace(outputs, s.tasks->inputs());
  std::vector<Result> results;
  for (const auto& [number, r] : rows) results.push_back(r);
  write_file(outputs.front(), table_text(s.layout, rows));
  const std::atomic<bool>& interrupted = apps::catch_interrupts();
  const std::vector<int> made = make_replays(s, results, replays, interrupted);
  write_report(s.study, *s.tasks, results, made, s.out);
  std::cout << summary_text(results, "cases") << "table: " << outputs[0] << "\nreport: " << outputs[2] << "\n";
  for (const int number : made) std::cout << "replay: " << s.out << "/" << replay_page(number) << "\n";
  std::cout << std::flush;
  return interrupted ? say_interrupted() : apps::kDone;
}

int run_all(const StudyOptions& o) {
  const std::string driver = find_driver(o.study);
  Opened s;
  open(o, s);
  const int cases = case_count(s.study);
  const int processors = o.processors > 0 ? o.processors : static_cast<int>(std::thread::hardware_concurrency());
  const int shards = std::min(cases, o.shards > 0 ? o.shards : processors * kShardsPerProcessor);
  const std::map<int, Result> rows = read_shards(s.study, s.out, s.layout);
  DriverJob job{o.study, s.out, {}, processors, o.trusted};
  std::vector<bool> needed(static_cast<std::size_t>(shards), false);
  for (const int i : missing(rows, cases)) needed[static_cast<std::size_t>(i % shards)] = true;
  for (int i = 0; i < shards; ++i)
    if (needed[static_cast<std::size_t>(i)]) job.shards.push_back({i, shards});
  if (!job.shards.empty() && !drive(driver, job)) return say_interrupted();
  return merge(s, o.replays);
}

/// Makes a case again into `folder` and says where what is.
int run_one(const Opened& s, int number, const std::string& folder) {
  const std::optional<Replay> made = replay_case(s.study, *s.tasks, number, folder, s.load, apps::catch_interrupts());
  if (!made) return say_interrupted();
  const Result& r = made->result;
  std::cout << "case " << number << ": " << (r.reached ? "reached the goal" : "FAILED: " + r.why)
            << format(", %.2f s, at most %.2f N\n", r.time, r.force);
  for (const std::string& recording : made->recordings)
    std::cout << "tegotae replay " << recording << "\ntegotae review " << recording << "\n";
  std::cout << "replay: " << made->page << std::endl;
  return apps::kDone;
}

int run_cases(const StudyOptions& o) {
  Opened s;
  open(o, s);
  for (const int number : o.numbers)
    if (number >= case_count(s.study))
      throw Error(o.study + format(": has no case %d; its cases are 0 to %d", number, case_count(s.study) - 1));
  if (!o.to.empty() && o.numbers.size() > 1) throw Error("study case: --to is the folder of one case");
  for (const int number : o.numbers) {
    const int code = run_one(s, number, o.to.empty() ? s.out + "/" + case_folder(number) : o.to);
    if (code != apps::kDone) return code;
  }
  return apps::kDone;
}

CLI::App* add_part(StudyOptions& o, const char* name, const char* help) {
  CLI::App* part = o.self->add_subcommand(name, help);
  part->add_option("STUDY", o.study, "Study file (TOML)")->required();
  return part;
}

void add_out(CLI::App& app, StudyOptions& o) {
  app.add_option("--out", o.out, "Folder of the results (the study file without its ending)")->type_name("DIR");
}

}  // namespace

CLI::App* add_study(CLI::App& app, StudyOptions& o) {
  o.self = app.add_subcommand("study", "Run the cases of a study, all or a part of them, here or on many machines");
  o.self->require_subcommand(0, 1);
  o.self->add_option("STUDY", o.study, "Study file (TOML)");
  o.self->add_option("--shard", o.shard, "Only the I-th of N parts of the cases")->type_name("I/N");
  o.self->add_option("--jobs", o.jobs, "Cases at the same time (default: all processors); no result depends on it")
      ->check(apps::between(1, 1024))
      ->type_name("J");
  add_out(*o.self, o);
  o.run = add_part(o, "run", "Run all cases with HyperShell, and merge");
  o.run->add_option("--shards", o.shards, "Number of shards, one process for each (8 for each processor)")
      ->check(apps::between(1, 1000000))
      ->type_name("N");
  o.run->add_option("--processors", o.processors, "Shards at the same time (default: all processors)")
      ->check(apps::between(1, 1024))
      ->type_name("P");
  o.merge = add_part(o, "merge", "Make one table and the report of all parts");
  o.one = add_part(o, "case", "Make cases again, and record them");
  o.one->add_option("NUMBER", o.numbers, "Number of a case (may be several)")->required()->check(apps::at_least(0));
  o.one->add_option("--to", o.to, "Folder for scene, recording and replay")->type_name("DIR");
  for (CLI::App* part : {o.run, o.merge, o.one}) add_out(*part, o);
  for (CLI::App* part : {o.run, o.merge})
    part->add_option("--replays", o.replays, "Cases whose replay is made at once: the best, the worst, failed ones")
        ->check(apps::between(0, 1000))
        ->capture_default_str()
        ->type_name("N");
  return o.self;
}

int run_study(const StudyOptions& o) {
  if (o.run->parsed()) return run_all(o);
  if (o.merge->parsed()) {
    Opened s;
    open(o, s);
    return merge(s, o.replays);
  }
  if (o.one->parsed()) return run_cases(o);
  if (o.study.empty()) throw Error("study: name a study file (see --help)");
  return run_shard(o);
}

}  // namespace tegotae::study
