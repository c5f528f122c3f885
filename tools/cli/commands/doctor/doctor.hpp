// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "idl/dds/identity.hpp"

/// The checks of `cohort doctor`, which are independent of each other.
namespace cohort::tool {

/// The command line of `cohort doctor`; see docs/troubleshooting.md.
struct DoctorCommand {
  std::string server{};  ///< empty: a server on this machine
  bool expects_server = false;
  std::vector<std::uint32_t> domains{};  ///< the server's; empty: 0
  std::uint32_t domain() const { return domains.empty() ? 0 : domains.front(); }
  std::string network = "127.0.0.1";
  std::filesystem::path secure{};  ///< folder of all identities, or of one; empty: without security
  bool json = false;
};

enum class Health { ok, warning, problem };

struct Finding {
  std::string
      check;  ///< a word: interface, ports, firewall, server, buffers, clock, limits, processor, library, security
  Health health = Health::ok;
  std::string found;
  std::string advice{};  ///< instructions; empty if nothing is wrong
};

// Checks of the machine. `proc` and `sys` are the kernel's file systems /proc and /sys.
Finding check_buffers(const std::filesystem::path& proc);
Finding check_limits(const std::filesystem::path& proc, const std::filesystem::path& sys);
Finding check_clock(const std::filesystem::path& sys);
Finding check_processor(const std::filesystem::path& sys);
Finding check_library();

// Checks of the network. `address` is the address to serve on.
std::vector<Finding> check_interfaces(const std::string& address);
/// `participants`: indices of the server's participants; one without security.
Finding check_ports(std::uint32_t domain, const std::string& address, const std::vector<std::uint32_t>& participants);
Finding check_firewall(std::uint32_t domain, const std::string& address);
/// `is_expected`: whether a missing answer is a problem.
Finding check_server(const DoctorCommand& command, const std::optional<wire::Identity>& identity, bool is_expected);

/// Checks a folder of identities, or the folder of one identity.
std::vector<Finding> check_security(const std::filesystem::path& folder);

/// Returns the process that has a UDP port of this machine, as "process 123 (cohort)". Returns an empty string if the
/// port is free, and "another user's process" if the kernel does not name it.
std::string holder_of_port(std::uint16_t port);

}  // namespace cohort::tool
