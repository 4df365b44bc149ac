#pragma once

#include <random>
#include <string>

#include "fuzz/fuzz.hpp"

namespace tegotae {

/// `bytes` with a change of what they say that leaves them JSON, a GLB file or XML: another number (none, huge, not
/// whole), another name or reference (also to itself), a key, an element or its attribute missing, twice, or in the
/// place of another. Bytes that are none of that come back as they are.
std::string structured_mutation(const std::string& bytes, Grammar grammar, std::mt19937& random);

}  // namespace tegotae
