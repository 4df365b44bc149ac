#include "import/step_lists.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "import/check_text.hpp"
#include "import/step_entities.hpp"

namespace tegotae {
namespace {

// In order. All lists of these are [1:?] or longer.
constexpr std::array<std::string_view, 51> kFilled = {"ANGULARITY_TOLERANCE",
                                                      "APPLIED_APPROVAL_ASSIGNMENT",
                                                      "APPLIED_DATE_AND_TIME_ASSIGNMENT",
                                                      "APPLIED_DATE_ASSIGNMENT",
                                                      "APPLIED_ORGANIZATION_ASSIGNMENT",
                                                      "APPLIED_PERSON_AND_ORGANIZATION_ASSIGNMENT",
                                                      "AUTO_DESIGN_APPROVAL_ASSIGNMENT",
                                                      "AUTO_DESIGN_GROUP_ASSIGNMENT",
                                                      "B_SPLINE_CURVE",
                                                      "B_SPLINE_CURVE_WITH_KNOTS",
                                                      "B_SPLINE_SURFACE",
                                                      "B_SPLINE_SURFACE_WITH_KNOTS",
                                                      "CAMERA_MODEL_D3_MULTI_CLIPPING_INTERSECTION",
                                                      "CAMERA_MODEL_D3_MULTI_CLIPPING_UNION",
                                                      "CARTESIAN_POINT",
                                                      "CC_DESIGN_APPROVAL",
                                                      "CIRCULAR_RUNOUT_TOLERANCE",
                                                      "COAXIALITY_TOLERANCE",
                                                      "COMPOSITE_TEXT",
                                                      "COMPOSITE_TEXT_WITH_EXTENT",
                                                      "CONCENTRICITY_TOLERANCE",
                                                      "CONNECTED_EDGE_SET",
                                                      "CONNECTED_FACE_SUB_SET",
                                                      "CONTEXT_DEPENDENT_INVISIBILITY",
                                                      "CURVE_BOUNDED_SURFACE",
                                                      "DATA_ENVIRONMENT",
                                                      "DERIVED_UNIT",
                                                      "DIRECTION",
                                                      "EDGE_BASED_WIREFRAME_MODEL",
                                                      "EDGE_LOOP",
                                                      "FACE_BASED_SURFACE_MODEL",
                                                      "GEOMETRIC_TOLERANCE_WITH_DATUM_REFERENCE",
                                                      "INTERSECTION_CURVE",
                                                      "INVISIBILITY",
                                                      "MEASURE_QUALIFICATION",
                                                      "PARALLELISM_TOLERANCE",
                                                      "PERPENDICULARITY_TOLERANCE",
                                                      "POLY_LOOP",
                                                      "QUALIFIED_REPRESENTATION_ITEM",
                                                      "RATIONAL_B_SPLINE_CURVE",
                                                      "RATIONAL_B_SPLINE_SURFACE",
                                                      "SEAM_CURVE",
                                                      "SHELL_BASED_SURFACE_MODEL",
                                                      "SUBFACE",
                                                      "SURFACE_CURVE",
                                                      "SURFACE_STYLE_PARAMETER_LINE",
                                                      "SYMMETRY_TOLERANCE",
                                                      "TESSELLATED_GEOMETRIC_SET",
                                                      "TEXT_STYLE_WITH_BOX_CHARACTERISTICS",
                                                      "TOTAL_RUNOUT_TOLERANCE",
                                                      "TRIMMED_CURVE"};

bool is_in_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Whether `text` has a list `()`. What follows a name, as in LENGTH_UNIT(), and what `text` begins with is none.
bool has_empty_list(std::string_view text) {
  char last = 'A';       // the last sign that is not a blank
  bool of_name = false;  // whether the parenthesis that was opened last follows a name
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (is_one_of(c, kBlank)) continue;
    if (c == '\'' || c == '"') {
      i = text.find(c, i + 1);
      if (i == text.npos) return false;
    }
    if (c == ')' && last == '(' && !of_name) return true;
    if (c == '(') of_name = is_in_name(last);
    last = c;
  }
  return false;
}

/// Whether OpenCASCADE cannot have an empty list in `values` of an entity of this kind.
bool is_unfilled(std::string_view kind, std::string_view values) {
  return std::binary_search(kFilled.begin(), kFilled.end(), kind) && has_empty_list(values);
}

/// The kind of `s` of which `is_unfilled` holds, as a part of its text; empty when there is none.
std::string_view unfilled_kind(const std::string& path, const StepStatement& s) {
  StepCursor at(path, s.id, s.value);
  const std::string_view kind = at.word();
  if (!kind.empty()) return is_unfilled(kind, at.rest()) ? kind : std::string_view();
  at.expect('(');
  while (!at.take(')')) {
    const std::string_view part = at.word();
    if (part.empty()) at.damaged("has no kind");
    const std::string_view values = at.rest();
    at.list([&] { at.skip(); });
    if (is_unfilled(part, values.substr(0, values.size() - at.rest().size()))) return part;
  }
  return {};
}

}  // namespace

std::string rename_unfilled(const std::string& path, std::string bytes) {
  if (!has_empty_list(bytes)) return bytes;
  std::vector<std::size_t> kinds;  // where they begin
  for (const StepStatement& s : step_statements(path, bytes)) {
    if (s.id == 0 || !has_empty_list(s.value)) continue;
    const std::string_view kind = unfilled_kind(path, s);
    if (!kind.empty()) kinds.push_back(static_cast<std::size_t>(kind.data() - bytes.data()));
  }
  std::string out;
  std::size_t from = 0;
  for (const std::size_t at : kinds) {
    out.append(bytes, from, at - from).append(kUnfilled);
    from = at;
  }
  return out.append(bytes, from);
}

}  // namespace tegotae
