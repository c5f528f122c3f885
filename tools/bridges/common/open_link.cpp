// SPDX-License-Identifier: Apache-2.0
#include <charconv>
#include <string_view>
#include <vector>

#include "tools/bridges/common/link.hpp"
#include "tools/bridges/common/serial.hpp"
#include "tools/bridges/common/sockets.hpp"

namespace cohort::bridges {
namespace {

std::vector<std::string> parts_of(std::string_view place) {
  std::vector<std::string> parts;
  for (;;) {
    const auto colon = place.find(':');
    parts.emplace_back(place.substr(0, colon));
    if (colon == std::string_view::npos) return parts;
    place.remove_prefix(colon + 1);
  }
}

template <class Number>
Number number_in(const std::string& text, const std::string& what, const std::string& place) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty())
    throw std::runtime_error("'" + place + "': '" + text + "' is not a " + what);
  return number;
}

}  // namespace

std::unique_ptr<Link> open_link(const std::string& place) {
  const std::vector<std::string> parts = parts_of(place);
  const std::string& kind = parts.front();
  const auto port = [&](std::size_t part) { return number_in<std::uint16_t>(parts[part], "port", place); };
  if (kind == "tcp" && parts.size() == 3) return listen_for_tcp(parts[1], port(2));
  if (kind == "udp" && parts.size() == 3) return open_udp(parts[1], port(2), std::nullopt);
  if (kind == "udp" && parts.size() == 5) return open_udp(parts[1], port(2), endpoint_of(parts[3], port(4)));
  if (kind == "serial" && parts.size() >= 3) {  // names of /dev/serial/by-path have colons
    const auto begin = kind.size() + 1;
    return open_serial(place.substr(begin, place.rfind(':') - begin), number_in<unsigned>(parts.back(), "rate", place));
  }
  if (kind == "pty" && parts.size() <= 2) return make_pty(parts.size() == 2 ? parts[1] : "");
  throw std::runtime_error("'" + place +
                           "': expected a link tcp:ADDRESS:PORT, udp:ADDRESS:PORT[:PEER_ADDRESS:PEER_PORT], "
                           "serial:DEVICE:BAUD or pty[:PATH]");
}

}  // namespace cohort::bridges
