#pragma once

#include <TDF_Label.hxx>
#include <string>

namespace tegotae {

/// The name of a product or an instance, UTF-8; empty without one.
std::string name_of(const TDF_Label& label);

/// Whether nobody gave this name: it is empty, refers to a label of OpenCASCADE, or says the kind of a shape or the
/// writing program and nothing more but numbers ("SOLID", "COMPOUND_2", "Open CASCADE STEP translator 7.6 1").
bool is_default_name(const std::string& name);

}  // namespace tegotae
