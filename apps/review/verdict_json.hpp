#pragma once

#include <nlohmann/json_fwd.hpp>

#include "review/verdict.hpp"

namespace tegotae::review {

/// `outcome` ("goes", "does not go", "open"), `headline`, `evidence`: a list of `kind` ("good", "bad", "plain"),
/// `text`.
nlohmann::json verdict_json(const Verdict& verdict);

}  // namespace tegotae::review
