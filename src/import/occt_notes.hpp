#pragma once

#include <XSControl_WorkSession.hxx>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace tegotae {

/// Bodies that the file hides (INVISIBILITY) and that are read all the same, each "#17". After the transfer;
/// `tessellated` are those that were taken out of the text.
std::vector<std::string> hidden_bodies(const Handle(XSControl_WorkSession) & session,
                                       const std::set<std::uint64_t>& tessellated);

/// Items of shapes that are curves without faces; `reached` as from of_shape(). Each "#17 is a GEOMETRIC_CURVE_SET".
std::vector<std::string> bare_curves(const Handle(XSControl_WorkSession) & session, const std::vector<bool>& reached);

/// Shapes of products, and representations that place them, that state no unit of length, each "#17".
std::vector<std::string> without_unit(const Handle(XSControl_WorkSession) & session, const std::vector<bool>& reached);

/// Those of them that state no unit of angle and have a conical face, each "#17".
std::vector<std::string> without_angle(const Handle(XSControl_WorkSession) & session, const std::vector<bool>& reached);

}  // namespace tegotae
