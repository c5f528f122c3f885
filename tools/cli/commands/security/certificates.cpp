// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/security/certificates.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <stdexcept>
#include <string_view>

#include "tools/cli/common/output_file.hpp"
#include "tools/common/processes/external_program.hpp"

namespace cohort::tool {
namespace {

namespace fs = std::filesystem;

constexpr const char* authority_key = "authority_key.pem";
constexpr std::string_view server_name = "server";

// Runs `openssl` in the folder of the files, and returns its output.
std::string openssl(const fs::path& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), "openssl");
  const ProgramResult result = run_program(arguments, folder);
  if (result.exit_code != 0)
    throw std::runtime_error(fmt::format("'{}' failed: {}", fmt::join(arguments, " "), result.errors));
  return result.output;
}

// Returns the subject of a certificate. Permissions name it in the order of RFC 2253, the last part first.
std::string subject_of(const std::string& identity, std::string_view side) {
  return fmt::format("/O=Cohort/OU={}/CN={}", identity, side);
}
std::string subject_in_permissions(const std::string& identity, std::string_view side) {
  return fmt::format("CN={},OU={},O=Cohort", side, identity);
}

constexpr const char* governance = R"(<?xml version="1.0" encoding="utf-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
     xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-Security/20170801/omg_shared_ca_domain_governance.xsd">
  <domain_access_rules>
    <domain_rule>
      <domains><id_range><min>0</min><max>230</max></id_range></domains>
      <allow_unauthenticated_participants>false</allow_unauthenticated_participants>
      <enable_join_access_control>true</enable_join_access_control>
      <discovery_protection_kind>NONE</discovery_protection_kind>
      <liveliness_protection_kind>NONE</liveliness_protection_kind>
      <rtps_protection_kind>{}</rtps_protection_kind>
      <topic_access_rules>
        <topic_rule>
          <topic_expression>*</topic_expression>
          <enable_discovery_protection>false</enable_discovery_protection>
          <enable_liveliness_protection>false</enable_liveliness_protection>
          <enable_read_access_control>true</enable_read_access_control>
          <enable_write_access_control>true</enable_write_access_control>
          <metadata_protection_kind>NONE</metadata_protection_kind>
          <data_protection_kind>NONE</data_protection_kind>
        </topic_rule>
      </topic_access_rules>
    </domain_rule>
  </domain_access_rules>
</dds>
)";

constexpr const char* permissions = R"(<?xml version="1.0" encoding="utf-8"?>
<dds xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
     xsi:noNamespaceSchemaLocation="http://www.omg.org/spec/DDS-Security/20170801/omg_shared_ca_permissions.xsd">
  <permissions>
    <grant name="{0}">
      <subject_name>{1}</subject_name>
      <validity><not_before>2020-01-01T00:00:00</not_before><not_after>2120-01-01T00:00:00</not_after></validity>
      <allow_rule>
        <domains><id_range><min>0</min><max>230</max></id_range></domains>
{2}      </allow_rule>
      <default>DENY</default>
    </grant>
  </permissions>
</dds>
)";

struct Allowed {
  const char* verb;  // publish or subscribe
  std::vector<const char*> topics;
  const char* partition;  // empty: the default one
};

// Returns the allowed topics; see docs/protocol.md, "Topics".
std::vector<Allowed> allowed_to(wire::Role role, bool may_control) {
  std::vector<Allowed> allowed;
  switch (role) {
    case wire::Role::server: return {{"publish", {"cohort/v1/*"}, "*"}, {"subscribe", {"cohort/v1/*"}, "*"}};
    case wire::Role::controller:
      allowed = {
          {"publish", {"cohort/v1/join", "cohort/v1/command", "cohort/v1/report", "cohort/v1/controller_state"}, ""},
          {"subscribe",
           {"cohort/v1/admit", "cohort/v1/observation", "cohort/v1/report", "cohort/v1/controller_state"},
           "c*"},
          {"subscribe", {"cohort/v1/robot_description", "cohort/v1/robot_tree"}, ""}};
      if (may_control) {
        allowed[0].topics.push_back("cohort/v1/request");
        allowed[1].topics.push_back("cohort/v1/reply");
      }
      return allowed;
    case wire::Role::observer: break;
  }
  return {{"publish", {"cohort/v1/request"}, ""},
          {"subscribe", {"cohort/v1/reply"}, "c*"},
          {"subscribe", {"cohort/v1/robot_description", "cohort/v1/robot_tree"}, ""},
          {"subscribe", {"cohort/v1/world_state", "cohort/v1/scene_description", "cohort/v1/scene_update"}, "view"}};
}

std::string rules_of(wire::Role role, bool may_control) {
  std::string text;
  for (const Allowed& allowed : allowed_to(role, may_control)) {
    text += fmt::format("        <{}><topics>", allowed.verb);
    for (const char* topic : allowed.topics) text += fmt::format("<topic>{}</topic>", topic);
    text += fmt::format("</topics><partitions><partition>{}</partition></partitions></{}>\n", allowed.partition,
                        allowed.verb);
  }
  return text;
}

void sign(const fs::path& folder, const std::string& document, std::string_view output) {
  write_file("a document", folder / "document.xml", document);
  openssl(folder, {"smime", "-sign", "-in", "document.xml", "-text", "-out", std::string(output), "-signer",
                   std::string(wire::authority_file), "-inkey", authority_key});
  fs::remove(folder / "document.xml");
}

// Creates one side of an identity, in its own folder inside `making`, which has the certificate authority.
void make_side(const NewIdentity& identity, wire::Role role, const fs::path& making, const std::string& days) {
  const bool is_server = role == wire::Role::server;
  const std::string_view side = is_server ? server_name : std::string_view("client");
  const fs::path folder = making / side;
  fs::create_directory(folder);
  const std::string prefix = std::string(side) + "/";
  const std::string key = prefix + std::string(wire::key_file);
  openssl(making, {"req", "-new", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-keyout", key,
                   "-out", "request.pem", "-subj", subject_of(identity.name, side)});
  openssl(making,
          {"x509", "-req", "-in", "request.pem", "-CA", std::string(wire::authority_file), "-CAkey", authority_key,
           "-CAcreateserial", "-days", days, "-sha256", "-out", prefix + std::string(wire::certificate_file)});
  sign(
      making,
      fmt::format(permissions, side, subject_in_permissions(identity.name, side), rules_of(role, identity.may_control)),
      prefix + std::string(wire::permissions_file));
  for (const auto& file : {wire::authority_file, wire::governance_file}) fs::copy_file(making / file, folder / file);
  const wire::Identity described{identity.name,       role, identity.participant, identity.protection, identity.robots,
                                 identity.may_control};
  write_file("an identity", folder / "identity", wire::identity_text(described));
  for (const auto& entry : fs::directory_iterator(folder))
    fs::permissions(entry.path(), fs::perms::owner_read | fs::perms::owner_write);
  fs::permissions(folder, fs::perms::owner_all);
}

// A temporary folder beside the folders to create, readable by its owner only, and removed by the destructor.
class Workshop {
 public:
  explicit Workshop(const fs::path& parent) {
    fs::create_directories(parent);
    std::string pattern = (parent / ".making-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw std::runtime_error(
          fmt::format("cannot write to {}: {}", parent.string(), std::generic_category().message(errno)));
    path_ = pattern;
  }
  Workshop(const Workshop&) = delete;
  Workshop& operator=(const Workshop&) = delete;
  ~Workshop() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

void make_identity(const NewIdentity& identity, const fs::path& server, const fs::path& client, unsigned days) {
  const Workshop workshop(server.parent_path());
  const fs::path& making = workshop.path();
  const std::string validity = std::to_string(days);
  const std::string validity_of_authority = std::to_string(days + 1);  // so that the certificates expire first
  openssl(making, {"req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes", "-sha256",
                   "-days", validity_of_authority, "-keyout", authority_key, "-out", std::string(wire::authority_file),
                   "-subj", subject_of(identity.name, "authority")});
  sign(making, fmt::format(governance, identity.protection == "encrypt" ? "ENCRYPT" : "SIGN"), wire::governance_file);
  make_side(identity, wire::Role::server, making, validity);
  make_side(identity, identity.role, making, validity);
  fs::create_directories(client.parent_path());
  fs::rename(making / "client", client);
  fs::rename(making / server_name, server);
}

Validity validity_of(const fs::path& certificate) {
  const ProgramResult result =
      run_program({"openssl", "x509", "-in", certificate.string(), "-noout", "-dates", "-dateopt", "iso_8601"}, "/");
  const auto time_after = [&](const std::string& name) {
    std::tm time{};
    const auto found = result.output.find(name + "=");
    if (found == std::string::npos ||
        strptime(result.output.c_str() + found + name.size() + 1, "%Y-%m-%d %H:%M:%SZ", &time) == nullptr)
      throw std::runtime_error(fmt::format("{} is not a certificate: {}", certificate.string(), result.errors));
    return static_cast<std::int64_t>(timegm(&time));
  };
  return {time_after("notBefore"), time_after("notAfter")};
}

}  // namespace cohort::tool
