// SPDX-License-Identifier: Apache-2.0
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>

#include "client_sdk/src/attachment.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/security/certificates.hpp"
#include "tools/cli/common/shown.hpp"

namespace cohort::tool {
namespace {

namespace fs = std::filesystem;

constexpr unsigned longest_validity = 36'500;  // [d]

fs::path server_folder(const fs::path& folder, const std::string& name) { return folder / "server" / name; }
fs::path client_folder(const fs::path& folder, const std::string& name) { return folder / "clients" / name; }

std::string joined(const std::vector<std::string>& texts) { return fmt::format("{}", fmt::join(texts, ",")); }

struct SecurityCommand {
  enum class What { init, add, list };
  What what = What::list;
  fs::path folder{};                   ///< folder of all identities
  std::vector<std::string> clients{};  ///< for init: NAME=SELECTORS
  std::string name{};                  ///< for add
  std::vector<std::string> robots{};   ///< for add: selectors
  bool encrypt = false;
  unsigned days = 365;
};

// Selectors may also contain rights other than driving robots.
void take_rights(NewIdentity& identity, const std::vector<std::string>& selectors) {
  for (const std::string& selector : selectors) {
    if (selector == "control") identity.may_control = true;
    if (selector != "control" && selector != "none") identity.robots.push_back(selector);
  }
}

std::string rights_of(const std::vector<std::string>& robots, bool may_control) {
  if (robots.empty()) return may_control ? "control the run, but not drive robots" : "observe, but not drive robots";
  return "drive " + joined(robots) + (may_control ? ", and control the run" : "");
}

// Parses a client, such as `red=0..3,red/*`.
NewIdentity parse_client(const std::string& text) {
  const auto equals = text.find('=');
  NewIdentity identity;
  identity.name = text.substr(0, equals);
  if (equals != std::string::npos) take_rights(identity, split_selectors(std::string_view(text).substr(equals + 1)));
  if (identity.robots.empty() && !identity.may_control)
    throw std::invalid_argument(
        fmt::format("'{}' does not name the robots that the client may drive; expected, for example, {}=explorers/*",
                    text, identity.name.empty() ? "red" : identity.name));
  return identity;
}

void check_name(const std::string& name) {
  if (!wire::is_identity_name(name))
    throw std::invalid_argument(
        fmt::format("'{}' is not a valid client name; expected up to 40 letters, digits, _ and -", name));
}

void initialise(const SecurityCommand& command) {
  const fs::path& folder = command.folder;
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
    throw std::invalid_argument(
        fmt::format("{} exists and is not an empty folder; 'cohort security add' adds a client to an existing folder",
                    folder.string()));
  std::vector<NewIdentity> identities = {{.name = "observer", .role = wire::Role::observer}};
  for (const std::string& client : command.clients) identities.push_back(parse_client(client));
  if (command.clients.empty()) identities.push_back({.name = "controllers", .robots = {"all"}});
  for (std::uint32_t i = 0; i < identities.size(); ++i) {
    NewIdentity& identity = identities[i];
    check_name(identity.name);
    const auto same = [&](const NewIdentity& other) { return other.name == identity.name; };
    if (std::count_if(identities.begin(), identities.end(), same) > 1)
      throw std::invalid_argument(fmt::format("there are two clients named '{}'", identity.name));
    identity.participant = i;
    if (command.encrypt) identity.protection = "encrypt";
  }
  if (identities.size() > wire::last_participant + 1)
    throw std::invalid_argument(fmt::format("expected at most {} clients", wire::last_participant));
  const bool is_new = !fs::exists(folder);
  try {
    for (const NewIdentity& identity : identities)
      make_identity(identity, server_folder(folder, identity.name), client_folder(folder, identity.name), command.days);
  } catch (...) {
    for (const char* made : {"server", "clients"}) fs::remove_all(folder / made);
    if (is_new) fs::remove(folder);
    throw;
  }
  show(fmt::format(
      "created {0}. {0}/server belongs to the server: cohort serve … --secure {0}\n"
      "Each folder in {0}/clients belongs to one client: copy the whole folder to that client's machine only:\n",
      folder.string()));
  for (const NewIdentity& identity : identities)
    show(fmt::format("  --secure {}  {}\n", client_folder(folder, identity.name).string(),
                     "may " + rights_of(identity.robots, identity.may_control)));
}

void add(const SecurityCommand& command) {
  check_name(command.name);
  const std::vector<wire::Identity> existing = wire::read_server_identities(command.folder);
  if (!fs::is_directory(command.folder / "server"))
    throw std::invalid_argument(fmt::format("{} was not created by 'cohort security init'", command.folder.string()));
  for (const wire::Identity& each : existing)
    if (each.name == command.name)
      throw std::invalid_argument(fmt::format(
          "{} already has a client '{}'; to create it again, remove {} and {}", command.folder.string(), command.name,
          server_folder(command.folder, command.name).string(), client_folder(command.folder, command.name).string()));
  NewIdentity identity{.name = command.name, .protection = existing.front().protection};
  take_rights(identity, command.robots);
  if (identity.robots.empty() && !identity.may_control)
    throw std::invalid_argument(fmt::format("'{}' would have no rights; expected robots or 'control'", command.name));
  // The first free participant: a removed client leaves a gap.
  while (std::ranges::find(existing, identity.participant, &wire::Identity::participant) != existing.end())
    ++identity.participant;
  if (identity.participant > wire::last_participant)
    throw std::invalid_argument(fmt::format("expected at most {} clients", wire::last_participant));
  const fs::path client = client_folder(command.folder, identity.name);
  if (fs::exists(client)) throw std::invalid_argument(fmt::format("{} already exists", client.string()));
  make_identity(identity, server_folder(command.folder, identity.name), client, command.days);
  show(fmt::format("created {}: it may {}. Restart the server with this folder to accept it.\n", client.string(),
                   rights_of(identity.robots, identity.may_control)));
}

void list(const SecurityCommand& command) {
  const std::vector<wire::Identity> existing = wire::read_server_identities(command.folder);
  show(
      fmt::format("{:<20} {:<12} {:<11} {:<16} {}\n", "client", "participant", "messages", "valid until", "may drive"));
  for (const wire::Identity& each : existing) {
    const std::int64_t end = validity_of(each.folder / wire::certificate_file).end;
    const std::string until = fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(static_cast<std::time_t>(end)));
    const bool is_over = end < std::time(nullptr);
    show(fmt::format("{:<20} {:<12} {:<11} {:<16} {}{}\n", each.name, each.participant,
                     each.protection == "encrypt" ? "encrypted" : "signed", until,
                     each.robots.empty() ? each.may_control ? "nothing; controls the run" : "nothing; observes only"
                                         : joined(each.robots) + (each.may_control ? "; controls the run" : ""),
                     is_over ? "   EXPIRED" : ""));
  }
}

}  // namespace

Subcommand add_security(CommandLine app) {
  const auto command = std::make_shared<SecurityCommand>();
  CommandLine line =
      app.add_subcommand("security", "Create and list certificates and permissions for the server and its clients");
  line.require_subcommand();
  const auto add_folder = [command](CommandLine sub) {
    sub.add_option("DIR", command->folder, "Folder of the identities").required().type_name("");
  };
  const auto add_days = [command](CommandLine sub) {
    sub.add_option("--days", command->days, "Period of validity of the certificates, in days")
        .check(whole_number(1, longest_validity))
        .capture_default_str()
        .type_name("N");
  };
  CommandLine init_line =
      line.add_subcommand("init", "Create certificates and permissions for a server and its clients");
  add_folder(init_line);
  init_line
      .add_option("--client", command->clients,
                  "Client and its rights: the robots that it may drive, and 'control' to control the run; may be "
                  "repeated (default: controllers=all)")
      .one_value()
      .type_name("NAME=SEL[,SEL...]");
  init_line.add_flag("--encrypt", command->encrypt, "Encrypt all messages (default: sign them)");
  add_days(init_line);
  init_line.callback([command] { command->what = SecurityCommand::What::init; });
  init_line.footer("Example: cohort security init keys --client red=red/* --client operator=none,control");

  CommandLine add_line = line.add_subcommand("add", "Add a client");
  add_folder(add_line);
  add_line.add_option("NAME", command->name, "Name of the client: letters, digits, _ and -").required().type_name("");
  add_line
      .add_option("--robots", command->robots,
                  "Rights, separated by commas: the robots that it may drive (all, an id, ids A..B, a name with *, or "
                  "none), and 'control' to control the run")
      .required()
      .comma_separated()
      .type_name("SEL[,SEL...]");
  add_days(add_line);
  add_line.callback([command] { command->what = SecurityCommand::What::add; });
  add_line.footer("Example: cohort security add keys green --robots green/*");

  CommandLine list_line =
      line.add_subcommand("list", "List the clients, their rights, and the expiry dates of their certificates");
  add_folder(list_line);
  list_line.callback([command] { command->what = SecurityCommand::What::list; });
  list_line.footer("Example: cohort security list keys");
  return {line, [command](Log&, const std::atomic<bool>&) {
            switch (command->what) {
              case SecurityCommand::What::init: initialise(*command); break;
              case SecurityCommand::What::add: add(*command); break;
              case SecurityCommand::What::list: list(*command); break;
            }
            return exit_ok;
          }};
}

}  // namespace cohort::tool
