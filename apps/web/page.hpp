#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tegotae::apps {

/// The self-contained report page with `report` in it: {title, subtitle?, intro?, claims?: [{name, value, target, unit,
/// holds}], sections: [{title, text?, plots?, graph?, tables?}]}; plots as in web/src/common/plot.js, graph {nodes:
/// [{text, layer}], arrows: [[from, to]]}, tables {caption?, head, rows, text?}, whose cells are texts, numbers, {text,
/// class?, href?} or {command, files} as in web/src/common/command.js, and `text` the places of the columns of words.
/// Numbers that are not finite come out as gaps.
std::string report_page(const nlohmann::json& report);

/// The review page with its data (a view::Bundle's bytes) inside, self-contained.
std::string review_page(const std::string& bundle);

/// The view page for a server: its scripts and styles carry `nonce`, and its data come over the network.
std::string view_page(const std::string& nonce);
/// The view page with its data (a view::Bundle's bytes) inside, to be opened without a server.
std::string view_file(const std::string& bundle);

}  // namespace tegotae::apps
