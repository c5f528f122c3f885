#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "idl/dds/identity.hpp"

/// The files of DDS Security, made with the openssl program.
namespace cohort::tool {

struct NewIdentity {
  std::string name{};
  wire::Role role = wire::Role::controller;  ///< of the client
  std::uint32_t door = 0;
  std::string protection = "sign";
  std::vector<std::string> robots{};
  bool may_control = false;
};

/// Makes the two sides of a door in the folders `server` and `client`, which must not exist yet: an authority of its
/// own, which vouches for these two sides and whose key is then thrown away, a certificate for each, and what they may
/// read and write, signed. Files are their owner's alone. Throws std::runtime_error, and then leaves nothing behind.
void make_door(const NewIdentity& identity, const std::filesystem::path& server, const std::filesystem::path& client,
               unsigned days);

struct Validity {
  std::int64_t begin = 0;  ///< seconds of Unix time
  std::int64_t end = 0;
};

/// When a certificate is valid. Throws std::runtime_error if it is none.
Validity validity_of(const std::filesystem::path& certificate);

}  // namespace cohort::tool
