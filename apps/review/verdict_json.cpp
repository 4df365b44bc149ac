#include "review/verdict_json.hpp"

#include <nlohmann/json.hpp>

namespace tegotae::review {
namespace {

const char* word(Outcome outcome) {
  return outcome == Outcome::goes ? "goes" : outcome == Outcome::does_not_go ? "does not go" : "open";
}
const char* word(Evidence::Kind kind) {
  return kind == Evidence::Kind::good ? "good" : kind == Evidence::Kind::bad ? "bad" : "plain";
}

}  // namespace

nlohmann::json verdict_json(const Verdict& v) {
  nlohmann::json out = {{"outcome", word(v.outcome)}, {"headline", v.headline}, {"evidence", nlohmann::json::array()}};
  for (const Evidence& e : v.evidence) out["evidence"].push_back({{"kind", word(e.kind)}, {"text", e.text}});
  return out;
}

}  // namespace tegotae::review
