#include "view/address.hpp"

#include <arpa/inet.h>

#include <charconv>

#include "tegotae/core/error.hpp"

namespace tegotae::view {

Address parse_address(const std::string& text) {
  const auto fail = [&] {
    throw Error("\"" + text + "\" is no address to listen on; write an IP address and a port, like 127.0.0.1:8080 or " +
                "[::1]:8080");
  };
  Address address;
  const std::size_t colon = text.find(':', text.find(']') == std::string::npos ? 0 : text.find(']'));
  address.host = text.substr(0, colon);
  if (colon != std::string::npos) {
    const char* end = text.data() + text.size();
    const auto [at, error] = std::from_chars(text.data() + colon + 1, end, address.port);
    if (error != std::errc() || at != end || address.port < 0 || address.port > 65535) fail();
  }
  unsigned char bytes[sizeof(in6_addr)];
  const std::string& host = address.host;
  const bool six = host.size() > 2 && host.front() == '[' && host.back() == ']' &&
                   inet_pton(AF_INET6, host.substr(1, host.size() - 2).c_str(), bytes) == 1;
  if (!six && inet_pton(AF_INET, host.c_str(), bytes) != 1) fail();
  return address;
}

}  // namespace tegotae::view
