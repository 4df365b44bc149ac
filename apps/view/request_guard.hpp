#pragma once

#include <chrono>
#include <mutex>
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
  /// Another token, for one request within a minute; the one before it is of no use any more. From any thread.
  std::string make_once();
  /// Whether the request brings that token, and nothing else speaks against it. From then on it is of no use. From any
  /// thread.
  bool take_once(const RequestOrigin& request);

 private:
  bool knows_host(std::string_view host) const;
  std::string foreign(const RequestOrigin& request) const;

  Address address_;
  std::string token_;
  std::mutex mutex_;
  std::string once_;  ///< empty: there is none
  std::chrono::steady_clock::time_point once_end_;
};

/// `bytes` random bytes of the system as hexadecimal digits.
std::string random_hex(std::size_t bytes);

}  // namespace tegotae::view
