// Families of parts that mate, judged without the loop's own word. Exit code 0: nothing was found; 1: something; 2:
// wrong use. A case that fails is one line, with the command that repeats it. See `families --help`.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "families/selection.hpp"
#include "shared/guarded_main.hpp"
#include "tegotae/core/error.hpp"

using namespace tegotae;
using namespace tegotae::test;

namespace {

void print(const SelectedCase& c, const CaseResult& r, bool quiet, const char* program) {
  if (quiet && r.findings.empty()) return;
  std::printf("%s %s:", r.findings.empty() ? "ok  " : "FAIL", describe(r.parameters, c.options).c_str());
  for (const Finding& f : r.findings)
    std::printf(" %s %s, expected %s;", f.what.c_str(), f.seen.c_str(), f.expected.c_str());
  std::printf(" waits %d ticks, off after %d, %d cut, loop %.1f s, judges %.1f s", r.waited, r.lifted, r.cut,
              r.seconds_loop, r.seconds_judges);
  if (!r.findings.empty()) std::printf(" | %s %s", program, arguments(c.parameters, c.options).c_str());
  std::printf("\n");
}

int run(const std::vector<SelectedCase>& cases, bool quiet, const char* program) {
  int failed = 0;
  double loop = 0, judges = 0;
  for (const SelectedCase& c : cases) {
    const CaseResult r = run_case(c.parameters, c.options);
    print(c, r, quiet, program);
    failed += !r.findings.empty();
    loop += r.seconds_loop;
    judges += r.seconds_judges;
  }
  std::printf("%zu cases, %d failed; loop %.0f s, judges %.0f s\n", cases.size(), failed, loop, judges);
  return failed > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Families of parts that mate, judged without the loop's own word.", "families"};
  SelectedCase one;
  FamilyParameters& p = one.parameters;
  bool daily = false, quiet = false;
  int seeds = 0;
  app.add_option("--family", p.family, "One case of this family")->check(CLI::IsMember(family_names()));
  app.add_option("--seed", p.seed, "Of the case")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--triangles", p.triangles, "Of each side")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--clearance", p.clearance, "m")->check(CLI::NonNegativeNumber)->capture_default_str();
  app.add_option("--size", p.size, "Of the held part, m")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--near", p.near, "Fixed parts")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_flag("--real-time", one.options.real_time, "With the default tick budget, not in virtual time");
  app.add_option("--trace", one.options.trace, "File for a line of CSV a tick of the one case");
  app.add_flag("--daily", daily, "The selection of every day");
  app.add_option("--seeds", seeds, "All families at so many seeds")->check(CLI::PositiveNumber);
  app.add_flag("--quiet", quiet, "Only what fails, and the sum");
  return apps::guarded_main(app, argc, argv, [&] {
    setlinebuf(stdout);
    if (p.family.empty() == (!daily && seeds == 0)) throw Error("one of --family, --daily and --seeds is needed");
    std::vector<SelectedCase> cases;
    if (!p.family.empty()) cases = {one};
    if (daily) cases = daily_cases();
    if (seeds > 0) cases = all_cases(seeds, one.options.real_time);
    return run(cases, quiet, argv[0]);
  });
}
