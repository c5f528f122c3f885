// SPDX-License-Identifier: Apache-2.0
#include "idl/dds/identity.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "idl/dds/wire_error.hpp"

namespace cohort::wire {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view identity_file = "identity";
constexpr std::array<std::pair<Role, std::string_view>, 3> role_names = {
    {{Role::server, "server"}, {Role::controller, "controller"}, {Role::observer, "observer"}}};

std::uint32_t parse_participant(const fs::path& file, const std::string& text) {
  std::uint32_t index = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), index);
  if (error != std::errc() || end != text.data() + text.size() || index > last_participant)
    throw WireError(file.string() + ": expected a participant from 0 to " + std::to_string(last_participant) +
                    ", not '" + text + "'");
  return index;
}

Role parse_role(const fs::path& file, const std::string& text) {
  for (const auto& [role, name] : role_names)
    if (name == text) return role;
  throw WireError(file.string() + ": expected server, controller or observer, not '" + text + "'");
}

void expect_readable(const fs::path& file) {
  if (::access(file.c_str(), R_OK) != 0)
    throw WireError("cannot read " + file.string() + ": " + std::generic_category().message(errno) +
                    ". Copy the identity's folder completely; only its owner can read it");
}

void set_value(Identity& identity, const fs::path& file, const std::string& key, const std::string& value) {
  if (key == "name") {
    if (!is_identity_name(value))
      throw WireError(file.string() + ": '" + value + "' is not a valid name of an identity");
    identity.name = value;
  } else if (key == "role") {
    identity.role = parse_role(file, value);
  } else if (key == "participant" || key == "door") {
    identity.participant = parse_participant(file, value);
  } else if (key == "protection") {
    identity.protection = value;
  } else if (key == "robots") {
    identity.robots.push_back(value);
  } else if (key == "control") {
    if (value != "yes" && value != "no")
      throw WireError(file.string() + ": expected control: yes or no, not '" + value + "'");
    identity.may_control = value == "yes";
  } else {
    throw WireError(file.string() + ": unknown key '" + key + "'");
  }
}

}  // namespace

bool is_identity_name(std::string_view name) {
  constexpr std::size_t longest = 40;  // a name in a certificate may have 64 characters
  return !name.empty() && name.size() <= longest && std::ranges::all_of(name, [](unsigned char c) {
    return c < 0x80 && (std::isalnum(c) != 0 || c == '_' || c == '-');
  });
}

std::string identity_text(const Identity& identity) {
  std::string text = "name: " + identity.name + "\n";
  for (const auto& [role, name] : role_names)
    if (role == identity.role) text += "role: " + std::string(name) + "\n";
  text += "participant: " + std::to_string(identity.participant) + "\nprotection: " + identity.protection + "\n";
  for (const std::string& robots : identity.robots) text += "robots: " + robots + "\n";
  if (identity.may_control) text += "control: yes\n";
  return text;
}

Identity read_identity(const fs::path& folder) {
  Identity identity;
  identity.folder = fs::absolute(folder);
  const fs::path file = identity.folder / identity_file;
  if (fs::exists(identity.folder / "clients") && !fs::exists(file)) {
    throw WireError(folder.string() + " contains several identities; give the folder of one, such as " +
                    (folder / "clients" / "NAME").string());
  }
  expect_readable(file);
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const auto colon = line.find(": ");
    if (line.empty()) continue;
    if (colon == std::string::npos) throw WireError(file.string() + ": expected 'KEY: VALUE', not '" + line + "'");
    set_value(identity, file, line.substr(0, colon), line.substr(colon + 2));
  }
  if (identity.name.empty()) throw WireError(file.string() + ": 'name' is missing");
  for (const auto& each : {authority_file, certificate_file, key_file, governance_file, permissions_file})
    expect_readable(identity.folder / each);
  return identity;
}

std::vector<Identity> read_server_identities(const fs::path& folder) {
  const fs::path server = fs::is_directory(folder / "server") ? folder / "server" : folder;
  std::error_code error;
  std::vector<Identity> identities;
  for (const auto& entry : fs::directory_iterator(server, error)) {
    if (!fs::exists(entry.path() / identity_file)) continue;
    identities.push_back(read_identity(entry.path()));
    if (identities.back().role != Role::server)
      throw WireError(entry.path().string() +
                      " is not a server's identity; give the folder created by 'cohort security init'");
  }
  if (error) throw WireError("cannot read " + server.string() + ": " + error.message());
  std::ranges::sort(identities, {}, &Identity::participant);
  if (identities.empty() || identities.front().participant != observers_participant)
    throw WireError(server.string() +
                    " is not a server's folder created by 'cohort security init': it has no identity of observers");
  const auto same = std::ranges::adjacent_find(identities, {}, &Identity::participant);
  if (same != identities.end())
    throw WireError(server.string() + ": " + same->name + " and " + std::next(same)->name +
                    " have the same participant");
  return identities;
}

}  // namespace cohort::wire
