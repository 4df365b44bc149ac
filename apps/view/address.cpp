#include "view/address.hpp"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdint>
#include <cstring>

#include "tegotae/core/error.hpp"

namespace tegotae::view {

Address parse_address(const std::string& text) {
  const auto fail = [&] {
    throw Error("\"" + text + "\" is not an address to listen on; write an IP address and a port, like 127.0.0.1:8080");
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

std::string why_not_listening(const Address& address, bool server_has_six) {
  sockaddr_storage place{};
  const auto port = htons(static_cast<std::uint16_t>(address.port));
  const bool six = address.host.front() == '[';
  if (six && !server_has_six) return "the page's server has no IPv6 here; take an address like 127.0.0.1";
  if (six) {
    auto& at = reinterpret_cast<sockaddr_in6&>(place);
    at.sin6_family = AF_INET6;
    at.sin6_port = port;
    inet_pton(AF_INET6, address.host.substr(1, address.host.size() - 2).c_str(), &at.sin6_addr);
  } else {
    auto& at = reinterpret_cast<sockaddr_in&>(place);
    at.sin_family = AF_INET;
    at.sin_port = port;
    inet_pton(AF_INET, address.host.c_str(), &at.sin_addr);
  }
  const int fd = socket(place.ss_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const int yes = 1;  // or a connection that just ended would count as somebody
  const bool can =
      fd >= 0 && setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) == 0 &&
      bind(fd, reinterpret_cast<const sockaddr*>(&place), six ? sizeof(sockaddr_in6) : sizeof(sockaddr_in)) == 0 &&
      listen(fd, 1) == 0;
  const int error = errno;
  if (fd >= 0) close(fd);
  if (can) return {};
  switch (error) {
    case EADDRINUSE:
      return "another program listens there; take another port, or none for any that is free";
    case EADDRNOTAVAIL:
      return "this machine has no such address; 0.0.0.0 stands for all that it has";
    case EACCES:
      return "ports below 1024 are not for every user; take a higher one";
    case EAFNOSUPPORT:
      return "this machine has no IPv6; take an address like 127.0.0.1";
    default:
      return std::strerror(error);
  }
}

std::vector<std::string> machine_addresses(bool six) {
  std::vector<std::string> found;
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return found;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != (six ? AF_INET6 : AF_INET)) continue;
    if ((i->ifa_flags & IFF_LOOPBACK) != 0 || (i->ifa_flags & IFF_UP) == 0) continue;
    const void* bytes = six ? static_cast<const void*>(&reinterpret_cast<const sockaddr_in6*>(i->ifa_addr)->sin6_addr)
                            : static_cast<const void*>(&reinterpret_cast<const sockaddr_in*>(i->ifa_addr)->sin_addr);
    // An address of its link alone needs the name of an interface of the other machine.
    if (six && IN6_IS_ADDR_LINKLOCAL(static_cast<const in6_addr*>(bytes))) continue;
    char text[INET6_ADDRSTRLEN];
    if (inet_ntop(i->ifa_addr->sa_family, bytes, text, sizeof text) != nullptr)
      found.push_back(six ? "[" + std::string(text) + "]" : text);
  }
  freeifaddrs(list);
  return found;
}

}  // namespace tegotae::view
