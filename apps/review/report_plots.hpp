#pragma once

#include <nlohmann/json_fwd.hpp>

#include "review/review.hpp"

namespace tegotae::review {

/// The plots over time, as web/src/common/plot.js has them.
nlohmann::json report_plots(const Review& review);

}  // namespace tegotae::review
