#include "bench/results.hpp"
#include "shared/latency_json.hpp"

namespace tegotae::bench {
namespace {

using Json = nlohmann::ordered_json;

using apps::json_number;

void add(const LoopFigures& f, Json& j) {
  j["tick_us"] = apps::to_json(f.tick_us);
  j["tick_cpu_us"] = apps::to_json(f.tick_cpu_us);
  j["contacts"] = f.contacts;
  j["contacts_max"] = f.contacts_max;
  j["limits"] = f.limits;
  j["resolves"] = f.resolves;
  j["near_parts"] = f.candidate_parts;
  j["cut"] = f.cut;
  j["overflow"] = f.overflow;
  j["ticks"] = f.ticks;
  j["ticks_in_contact"] = f.in_contact;
  j["depth_m"] = json_number(f.depth);
  j["fifo"] = f.fifo;
}

Json to_json(const LagFigures& f) {
  return {{"p50_m", f.p50},
          {"p99_m", f.p99},
          {"max_m", f.most},
          {"force_rms_n", f.force_rms},
          {"force_error_rms_n", f.error_rms},
          {"force_error_share", json_number(f.error_share)},
          {"force_error_max_n", f.error_most},
          {"ticks", f.ticks}};
}

Json to_json(const SeatFigures& f) {
  return {{"rest_us", apps::to_json(f.rest_us)},
          {"moving_us", apps::to_json(f.moving_us)},
          {"arrival_ms", json_number(f.arrival_ms)},
          {"above_seat_m", json_number(f.above_seat)},
          {"slide_mm_s", json_number(f.slide_mm_s)},
          {"off_ms", json_number(f.off_ms)},
          {"cut", f.cut},
          {"ticks", f.ticks}};
}

Json to_json(const SceneFigures& s) {
  Json j;
  j["scene"] = s.scene;
  j["triangles"] = {s.held_triangles, s.fixed_triangles};
  add(s.hand, j);
  j["fcl_us"] = {{"p50", json_number(s.fcl.us.p50)}, {"p99", json_number(s.fcl.us.p99)}};
  j["fcl_poses"] = s.fcl.poses;
  j["fcl_overlapping"] = s.fcl.overlap;
  j["fcl_pairs"] = s.fcl.pairs;
  j["lag"] = to_json(s.hand_lag);
  add(s.fast, j["fast"]);
  j["fast"]["lag"] = to_json(s.fast_lag);
  j["build_us_per_triangle"] = s.build.us_per_triangle;
  j["bytes_per_triangle"] = s.build.bytes_per_triangle;
  j["checked"] = s.checked;
  j["intersecting"] = s.intersecting;
  if (s.friction) {
    j["friction"] = {
        {"mu", s.friction->mu}, {"checked", s.friction->checked}, {"intersecting", s.friction->intersecting}};
    add(s.friction->loop, j["friction"]);
  }
  if (s.seat) j["seat"] = to_json(*s.seat);
  for (const BudgetFigures& b : s.budgets) {
    Json row;
    row["budget_us"] = 1e6 * b.budget;
    add(b.loop, row);
    row["checked"] = b.checked;
    row["intersecting"] = b.intersecting;
    j["budgets"].push_back(row);
  }
  return j;
}

Json to_json(const LpTimes& t) {
  return {{"us", json_number(t.us)},
          {"qp_us", json_number(t.qp_us)},
          {"glpk_us", json_number(t.glpk_us)},
          {"pivots", t.iterations},
          {"gap", t.gap},
          {"failed", t.failed}};
}

}  // namespace

std::string json_line(const Results& results) {
  Json j;
  j["rows"] = Json::array();
  for (const SceneFigures& s : results.rows) j["rows"].push_back(to_json(s));
  for (const StartFigures& f : results.starts)
    j["starts"].push_back(
        {{"format", f.format}, {"triangles", f.triangles}, {"first_s", f.first_s}, {"second_s", f.second_s}});
  j["lp"] = Json::array();
  for (const LpFigures& f : results.lp) {
    Json row = {{"n", f.n}};
    row.update(to_json(f.peg));
    row["ball"] = to_json(f.ball);
    j["lp"].push_back(row);
  }
  for (const FrictionSolveFigures& f : results.friction_solves)
    j["friction_solves"].push_back(
        {{"contacts", f.contacts}, {"p50_us", f.us.p50}, {"p99_us", f.us.p99}, {"exact", f.exact}});
  j["seconds"] = results.seconds;
  return j.dump();
}

}  // namespace tegotae::bench
