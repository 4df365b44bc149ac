#pragma once

#include <string>
#include <string_view>

namespace tegotae::apps {

/// `bytes` in base 64, with padding (RFC 4648).
std::string base64(std::string_view bytes);

}  // namespace tegotae::apps
