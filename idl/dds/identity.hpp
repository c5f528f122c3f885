// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Identities under DDS Security: one folder for the server's side and one for the client's side of each, created by
/// `cohort security` (docs/security.md, docs/protocol.md "Security").
namespace cohort::wire {

enum class Role { server, controller, observer };

/// The content of the file `identity` in such a folder. The server has one participant for each identity, which
/// trusts only that identity. So all data that it receives comes from that identity, regardless of what the data
/// claims.
struct Identity {
  std::string name{};                 ///< name of the client, on both sides: letters, digits, _ and -
  Role role = Role::controller;       ///< role of the folder's owner
  std::uint32_t participant = 0;      ///< index of the server's participant; 0 is that of observers
  std::string protection = "sign";    ///< protection of all messages: sign or encrypt
  std::vector<std::string> robots{};  ///< selectors of robots that it may claim; none for observers
  bool may_control = false;           ///< right to control the run: docs/protocol.md, "Control"
  std::filesystem::path folder{};     ///< absolute
};

// Files next to `identity` in its folder.
inline constexpr std::string_view authority_file =
    "authority.pem";  // certificate authority of the identity, for both sides
inline constexpr std::string_view certificate_file = "certificate.pem";
inline constexpr std::string_view key_file = "key.pem";
inline constexpr std::string_view governance_file = "governance.p7s";
inline constexpr std::string_view permissions_file = "permissions.p7s";

/// The participant of observers, the only one that writes WorldState.
inline constexpr std::uint32_t observers_participant = 0;
/// The greatest index of a participant: a greater one would use the ports of the next domain.
inline constexpr std::uint32_t last_participant = 119;

/// Returns true if the name is valid for an identity.
bool is_identity_name(std::string_view name);

/// Returns the content of the file `identity`.
std::string identity_text(const Identity& identity);

/// Reads the identity in `folder`. Throws WireError with the file name if a file is missing or cannot be read.
Identity read_identity(const std::filesystem::path& folder);

/// Reads the server's side of every identity, sorted by participant, from `folder`/server, or from `folder` itself.
/// Throws WireError if there is none, or if the participant of observers is missing.
std::vector<Identity> read_server_identities(const std::filesystem::path& folder);

}  // namespace cohort::wire
