#pragma once

#include <string>
#include <string_view>

#include "view/address.hpp"

namespace tegotae::view {

/// What a request says about where it comes from; empty: it does not say.
struct RequestOrigin {
  std::string_view host;    ///< Host
  std::string_view origin;  ///< Origin
  std::string_view site;    ///< Sec-Fetch-Site
  std::string_view token;
};

/// Who may talk to the server: who knows the token, calls it by its own address (other names are attempts to rebind
/// one), and is no other site's page.
class RequestGuard {
 public:
  /// `address`: where the server listens, with its real port. Makes a token of 128 random bits.
  explicit RequestGuard(const Address& address);

  const std::string& token() const { return token_; }
  /// Empty when the request may pass, or why not.
  std::string refusal(const RequestOrigin& request) const;

 private:
  bool knows_host(std::string_view host) const;

  Address address_;
  std::string token_;
};

/// `bytes` random bytes of the system as hexadecimal digits.
std::string random_hex(std::size_t bytes);

}  // namespace tegotae::view
