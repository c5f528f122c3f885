// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "idl/dds/transport.hpp"
#include "tools/cli/commands/doctor/doctor.hpp"
#include "tools/cli/commands/security/certificates.hpp"

namespace cohort::tool {
namespace {

namespace fs = std::filesystem;

std::string date_of(std::int64_t time) {
  return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(static_cast<std::time_t>(time)));
}

Finding check_identity(const wire::Identity& identity) {
  constexpr std::int64_t soon = 1'209'600;  // two weeks [s]
  const Validity validity = validity_of(identity.folder / wire::certificate_file);
  const std::int64_t now = std::time(nullptr);
  const std::string who =
      fmt::format("{} ({}), participant {}", identity.name, identity.folder.string(), identity.participant);
  const std::string again = fmt::format(
      "Remove its folders in server/ and clients/, create them again with 'cohort security add DIR {} --robots …', and "
      "copy the client's folder to its machine.",
      identity.name);
  if (now >= validity.end) return {"security", Health::problem, who + ": expired at " + date_of(validity.end), again};
  if (now < validity.begin)
    return {"security", Health::problem,
            fmt::format("{}: valid only from {}; the time now is {}", who, date_of(validity.begin), date_of(now)),
            "The clock of this machine, or of the machine that made the certificate, is wrong."};
  const fs::perms others = fs::perms::group_all | fs::perms::others_all;
  if ((fs::status(identity.folder / wire::key_file).permissions() & others) != fs::perms::none)
    return {"security", Health::warning, who + ": other users can read its key",
            fmt::format("chmod 600 {}", (identity.folder / wire::key_file).string())};
  if (validity.end - now < soon)
    return {"security", Health::warning, who + ": expires at " + date_of(validity.end), again};
  return {"security", Health::ok, who + ": valid until " + date_of(validity.end)};
}

}  // namespace

std::vector<Finding> check_security(const fs::path& folder) {
  std::vector<Finding> findings;
  try {
    const bool is_one = fs::exists(folder / "identity");
    const std::vector<wire::Identity> identities =
        is_one ? std::vector{wire::read_identity(folder)} : wire::read_server_identities(folder);
    for (const wire::Identity& identity : identities) findings.push_back(check_identity(identity));
  } catch (const std::exception& error) {
    findings.push_back({"security", Health::problem, error.what(), "'cohort security init' creates this folder."});
  }
  return findings;
}

}  // namespace cohort::tool
