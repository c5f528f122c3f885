#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "idl/dds/identity.hpp"

/// What `cohort doctor` looks at, each check by itself.
namespace cohort::tool {

/// `cohort doctor`: docs/troubleshooting.md.
struct DoctorCommand {
  std::string server{};  ///< empty: one on this machine
  bool expects_server = false;
  std::uint32_t domain = 0;
  std::string network = "127.0.0.1";
  std::filesystem::path secure{};  ///< of all identities, or of one; empty: without security
  bool json = false;
};

enum class Health { ok, warning, problem };

struct Finding {
  std::string
      check;  ///< a word: interface, ports, firewall, server, buffers, clock, limits, processor, library, security
  Health health = Health::ok;
  std::string found;
  std::string advice{};  ///< what to do; empty if all is well
};

// The machine. `proc` and `sys` are where the kernel shows itself, /proc and /sys.
Finding check_buffers(const std::filesystem::path& proc);
Finding check_limits(const std::filesystem::path& proc, const std::filesystem::path& sys);
Finding check_clock(const std::filesystem::path& sys);
Finding check_processor(const std::filesystem::path& sys);
Finding check_library();

// The network. `address` is the one to serve on.
std::vector<Finding> check_interfaces(const std::string& address);
/// `doors`: those of the server's folder, or one.
Finding check_ports(std::uint32_t domain, const std::string& address, const std::vector<std::uint32_t>& doors);
Finding check_firewall(std::uint32_t domain, const std::string& address);
/// `is_expected`: whether it is a problem if none answers.
Finding check_server(const DoctorCommand& command, const std::optional<wire::Identity>& identity, bool is_expected);

/// The folder of identities, or of one of them. `identity` is then the client's.
std::vector<Finding> check_security(const std::filesystem::path& folder);

/// Who holds a UDP port of this machine, as "process 123 (cohort)"; empty if it is free, "another user's process" if
/// the kernel does not tell.
std::string holder_of_port(std::uint16_t port);

}  // namespace cohort::tool
