#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Who somebody is under DDS Security: one folder for each side of each door, made by `cohort security`
/// (docs/security.md, docs/protocol.md "Security").
namespace cohort::wire {

enum class Role { server, controller, observer };

/// What the file `identity` of such a folder says. The server has one participant for each identity, its **door**,
/// which trusts nobody but that identity: so what comes in there is that identity's, whatever it says of itself.
struct Identity {
  std::string name{};                 ///< of the client, on both sides: letters, digits, _ and -
  Role role = Role::controller;       ///< whose folder it is
  std::uint32_t door = 0;             ///< the server's participant index; 0 is the observers'
  std::string protection = "sign";    ///< of all messages: sign or encrypt
  std::vector<std::string> robots{};  ///< selectors of what it may claim; none for observers
  bool may_control = false;           ///< the run: docs/protocol.md, "Control"
  std::filesystem::path folder{};     ///< absolute
};

// Beside `identity` in its folder.
inline constexpr std::string_view authority_file = "authority.pem";  // the door's, which vouches for its two sides
inline constexpr std::string_view certificate_file = "certificate.pem";
inline constexpr std::string_view key_file = "key.pem";
inline constexpr std::string_view governance_file = "governance.p7s";
inline constexpr std::string_view permissions_file = "permissions.p7s";

/// The door of observers, which is the only one where WorldState is written.
inline constexpr std::uint32_t observers_door = 0;
/// Further ones would have the ports of the next domain.
inline constexpr std::uint32_t last_door = 119;

/// Whether it can be the name of an identity.
bool is_identity_name(std::string_view name);

/// What the file `identity` holds.
std::string identity_text(const Identity& identity);

/// The identity in `folder`. Throws WireError if a file is missing or cannot be read, naming it.
Identity read_identity(const std::filesystem::path& folder);

/// The server's side of every door, by door: those in `folder`/server, or in `folder` if that is what was handed over.
/// Throws WireError if there is none, or if the observers' is missing.
std::vector<Identity> read_doors(const std::filesystem::path& folder);

}  // namespace cohort::wire
