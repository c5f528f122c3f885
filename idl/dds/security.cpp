// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <mutex>
#include <set>

#include "idl/dds/dds.hpp"
#include "idl/dds/survey.hpp"

namespace cohort::wire {
namespace {

namespace fs = std::filesystem;

// Cyclone's plugins are next to its library; on Debian, in a separate folder.
fs::path plugin_folder() {
  const fs::path library = dds_library();
  const fs::path beside = library.parent_path();
  for (const fs::path& folder : {beside / "libddsc0debian", beside})
    if (fs::exists(folder / "libdds_security_auth.so")) return folder;
  throw WireError("the plugins of DDS Security (libdds_security_auth.so) are not next to " + library.string() +
                  "; this Cyclone DDS was built without them");
}

// Log messages of Cyclone 0.10 when a peer is rejected: in the handshake, or because of its documents.
constexpr std::array refusals = {"andshake failed", "andshake request failed", "andshake reply failed",
                                 "permissions from plugin", "does not allow remote participant"};

}  // namespace

std::optional<std::string> refusal_told_first(std::string_view message) {
  const auto stands_in = [&](const char* text) { return message.find(text) != std::string_view::npos; };
  if (std::ranges::none_of(refusals, stands_in)) return std::nullopt;
  constexpr std::size_t most = 1000;  // limit of the remembered ones: many peers must not fill the memory
  static std::mutex mutex;
  static std::set<std::string, std::less<>> told;
  const std::lock_guard lock(mutex);
  if (told.size() >= most || !told.emplace(message).second) return std::nullopt;
  return "DDS Security rejected a peer: " + std::string(message) +
         ". Check that the identities of server and client come from the same 'cohort security init', that "
         "certificates "
         "have not expired, and that both clocks are right";
}

Qos make_qos() {
  return {dds_create_qos(), [](dds_qos_t* qos) { dds_delete_qos(qos); }};
}

void secure(dds_qos_t* qos, const Identity& identity) {
  const fs::path plugins = plugin_folder();
  const auto set = [&](const char* name, const std::string& value) { dds_qset_prop(qos, name, value.c_str()); };
  const auto set_library = [&](const std::string& kind, const char* file, const std::string& function) {
    const std::string prefix = "dds.sec." + kind + ".library.";
    set((prefix + "path").c_str(), plugins / file);
    set((prefix + "init").c_str(), "init_" + function);
    set((prefix + "finalize").c_str(), "finalize_" + function);
  };
  const auto set_file = [&](const char* name, std::string_view file) {
    set(name, "file:" + (identity.folder / file).string());
  };
  set_library("auth", "libdds_security_auth.so", "authentication");
  set_library("crypto", "libdds_security_crypto.so", "crypto");
  set_library("access", "libdds_security_ac.so", "access_control");
  set_file("dds.sec.auth.identity_ca", authority_file);
  set_file("dds.sec.auth.identity_certificate", certificate_file);
  set_file("dds.sec.auth.private_key", key_file);
  set_file("dds.sec.access.permissions_ca", authority_file);
  set_file("dds.sec.access.governance", governance_file);
  set_file("dds.sec.access.permissions", permissions_file);
}

}  // namespace cohort::wire
