// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "idl/dds/identity.hpp"

/// The files of DDS Security, created with the openssl program.
namespace cohort::tool {

struct NewIdentity {
  std::string name{};
  wire::Role role = wire::Role::controller;  ///< role of the client
  std::uint32_t participant = 0;
  std::string protection = "sign";
  std::vector<std::string> robots{};
  bool may_control = false;
};

/// Creates the two sides of an identity in the folders `server` and `client`, which must not exist. The identity has
/// its own certificate authority, which signs a certificate and the permissions of each side. The authority's key is
/// then deleted. Only the owner can read the files. The certificates are valid for `days`. Throws std::runtime_error,
/// and then leaves no files behind.
void make_identity(const NewIdentity& identity, const std::filesystem::path& server,
                   const std::filesystem::path& client, unsigned days);

struct Validity {
  std::int64_t begin = 0;  ///< seconds of Unix time
  std::int64_t end = 0;
};

/// Returns the validity of a certificate. Throws std::runtime_error if the file is not a certificate.
Validity validity_of(const std::filesystem::path& certificate);

}  // namespace cohort::tool
