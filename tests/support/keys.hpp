// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "idl/dds/identity.hpp"
#include "tests/support/process.hpp"
#include "tools/cli/commands/security/certificates.hpp"

namespace cohort::test {

/// The identities of one server, as `cohort security init` creates them: `observer`, `red` for the robots 0..7 and
/// `blue` for 8..15.
class Keys {
 public:
  /// `observers_side` is the role that the certificates of `observer` permit. With the role of a controller, it
  /// represents a program that exceeds its permissions.
  explicit Keys(const std::string& protection = "sign", unsigned days = 30,
                wire::Role observers_side = wire::Role::observer) {
    make({.name = "observer", .role = observers_side, .participant = wire::observers_participant}, protection, days);
    make({.name = "red", .participant = 1, .robots = {"0..7"}}, protection, days);
    make({.name = "blue", .participant = 2, .robots = {"8..15"}}, protection, days);
  }

  std::string folder() const { return folder_.path().string(); }
  std::string client_folder(const std::string& name) const { return (folder_.path() / "clients" / name).string(); }
  wire::Identity client(const std::string& name) const { return wire::read_identity(client_folder(name)); }
  wire::Identity server_identity(const std::string& name) const {
    return wire::read_identity(folder_.path() / "server" / name);
  }

  /// Makes an identity with the files of `name` and the participant index of `other`. Returns its folder.
  std::string disguise(const std::string& name, const std::string& other) const {
    const std::filesystem::path to = folder_.path() / (name + "_at_" + other);
    std::filesystem::copy(client_folder(name), to);
    wire::Identity identity = client(name);
    identity.participant = client(other).participant;
    write_file(to / "identity", wire::identity_text(identity));
    return to.string();
  }

 private:
  void make(tool::NewIdentity identity, const std::string& protection, unsigned days) const {
    identity.protection = protection;
    tool::make_identity(identity, folder_.path() / "server" / identity.name, folder_.path() / "clients" / identity.name,
                        days);
  }

  ScratchFolder folder_;
};

}  // namespace cohort::test
