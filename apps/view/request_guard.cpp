#include "view/request_guard.hpp"

#include <sys/random.h>

#include <vector>

#include "tegotae/core/error.hpp"

namespace tegotae::view {
namespace {

constexpr std::size_t kTokenBytes = 16;
constexpr auto kOnceValid = std::chrono::minutes(1);

/// Takes a time that does not depend on where they differ.
bool same(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

}  // namespace

std::string random_hex(std::size_t bytes) {
  std::vector<unsigned char> random(bytes);
  if (getrandom(random.data(), bytes, 0) != static_cast<ssize_t>(bytes))
    throw Error("the system provides no random numbers");
  std::string text;
  for (const unsigned char byte : random) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 15];
  }
  return text;
}

RequestGuard::RequestGuard(const Address& address) : address_(address), token_(random_hex(kTokenBytes)) {}

bool RequestGuard::knows_host(std::string_view host) const {
  const std::string port = ":" + std::to_string(address_.port);
  if (host == address_.text()) return true;
  if ((address_.host == "127.0.0.1" || address_.host == "[::1]") && host == "localhost" + port) return true;
  // A server on all interfaces accepts any numeric address of the machine, but no name: a name can point anywhere.
  return address_.wildcard() && host.size() > port.size() && host.substr(host.size() - port.size()) == port &&
         host.substr(0, host.size() - port.size()).find_first_not_of("0123456789.[]abcdefABCDEF:") == host.npos;
}

std::string RequestGuard::foreign(const RequestOrigin& request) const {
  if (!knows_host(request.host)) return "this server does not have that name";
  if (!request.origin.empty() && request.origin != "http://" + std::string(request.host)) return "this is not its page";
  if (!request.site.empty() && request.site != "same-origin" && request.site != "none") return "this is not its page";
  return "";
}

std::string RequestGuard::refusal(const RequestOrigin& request) const {
  const std::string why = foreign(request);
  if (!why.empty()) return why;
  if (!same(request.token, token_)) return "the token is missing or wrong; open the address that the program printed";
  return "";
}

std::string RequestGuard::make_once() {
  const std::lock_guard<std::mutex> lock(mutex_);
  once_end_ = std::chrono::steady_clock::now() + kOnceValid;
  return once_ = random_hex(kTokenBytes);
}

bool RequestGuard::take_once(const RequestOrigin& request) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (once_.empty() || !foreign(request).empty() || !same(request.token, once_)) return false;
  once_.clear();
  return std::chrono::steady_clock::now() < once_end_;
}

}  // namespace tegotae::view
