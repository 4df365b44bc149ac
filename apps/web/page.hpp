#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tegotae::apps {

/// The self-contained report page with `report` in it: {title, subtitle?, intro?, claims?: [{name, value, target, unit,
/// holds}], sections: [{title, text?, plots?, tables?}]}; plots as in web/src/common/plot.js, tables {caption?, head,
/// rows}. Numbers that are not finite come out as gaps.
std::string report_page(const nlohmann::json& report);

}  // namespace tegotae::apps
