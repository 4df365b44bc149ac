#pragma once

#include <nlohmann/json_fwd.hpp>

#include "review/review.hpp"

namespace tegotae::review {

/// The tables [{title, text, head, rows}], as web/src/common/dom.js has them.
nlohmann::json report_tables(const Review& review);

}  // namespace tegotae::review
