#pragma once

namespace tegotae {

/// Extension of the format that this program fuzzes.
extern const char* const kFormat;

}  // namespace tegotae
