#include "client/port_address.hpp"

#include <charconv>

namespace opentmcl::client {

namespace {

constexpr std::string_view tcp_scheme = "tcp://";
constexpr std::string_view simulated_scheme = "sim:";

Error wrong(std::string_view text, const char* expected) {
  return {ErrorKind::usage, "no such kind of port: \"" + std::string(text) + "\"; expected " + expected, {}};
}

Result<PortAddress> parse_tcp(std::string_view text) {
  const std::string_view rest = text.substr(tcp_scheme.size());
  const std::size_t colon = rest.rfind(':');
  if (colon == std::string_view::npos) return wrong(text, "tcp://HOST:PORT");
  std::string_view host = rest.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    return wrong(text, "an IPv6 address in brackets, as in tcp://[::1]:5160");
  }
  const std::string_view digits = rest.substr(colon + 1);
  unsigned port = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), port);
  if (host.empty() || error != std::errc{} || end != digits.data() + digits.size() || port == 0 || port > 65535) {
    return wrong(text, "tcp://HOST:PORT with a PORT from 1 to 65535");
  }
  return PortAddress(TcpAddress{std::string(host), port});
}

}  // namespace

Result<PortAddress> parse_port_address(std::string_view text) {
  if (text.substr(0, tcp_scheme.size()) == tcp_scheme) return parse_tcp(text);
  if (text.substr(0, simulated_scheme.size()) == simulated_scheme) {
    return PortAddress(SimulatedAddress{std::string(text.substr(simulated_scheme.size()))});
  }
  if (text.find('/') != std::string_view::npos && text.find("://") == std::string_view::npos) {
    return PortAddress(SerialAddress{std::string(text)});
  }
  return wrong(text, "a path such as /dev/ttyACM0, tcp://HOST:PORT, or sim:pd1161");
}

}  // namespace opentmcl::client
