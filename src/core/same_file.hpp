#pragma once

#include <string>
#include <vector>

namespace tegotae {

/// Throws Error when writing to `path` would replace one of `inputs`: the same file, by whatever name or link.
void refuse_to_replace(const std::string& path, const std::vector<std::string>& inputs);

/// The same of several outputs, which must also be different files. Empty paths are none.
void refuse_to_replace(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

}  // namespace tegotae
