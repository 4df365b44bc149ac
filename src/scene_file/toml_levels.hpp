#pragma once

#include <string>

namespace tegotae {

/// Throws Error `path:line: ...` when keys, headers or brackets of the TOML `text` go deeper than any scene does, or it
/// is longer than any: the parser and what it makes are recursive, and would end the process on its stack.
void check_toml_levels(const std::string& text, const std::string& path);

}  // namespace tegotae
