#pragma once

#include <string>
#include <vector>

namespace tegotae::view {

/// Where to listen.
struct Address {
  std::string host = "127.0.0.1";  ///< an IP address; of IPv6 with its brackets
  int port = 0;                    ///< 0: any that is free
  std::string text() const { return host + ":" + std::to_string(port); }
  /// Every address of the machine.
  bool wildcard() const { return host == "0.0.0.0" || host == "[::]"; }
};

/// Reads "127.0.0.1", "127.0.0.1:8080" or "[::1]:8080". Throws Error.
Address parse_address(const std::string& text);

/// Why nobody can listen there now, and what to do; empty when one can.
std::string why_not_listening(const Address& address, bool server_has_six);

/// The addresses by which others may reach this machine, none of the loopback; those of IPv6 with their brackets.
std::vector<std::string> machine_addresses(bool six);

}  // namespace tegotae::view
