#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <iostream>

#include "client_sdk/src/attachment.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/commands/security/certificates.hpp"

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
  fs::path folder{};                   ///< of all identities
  std::vector<std::string> clients{};  ///< of init: NAME=SELECTORS
  std::string name{};                  ///< of add
  std::vector<std::string> robots{};   ///< of add: selectors
  bool encrypt = false;
  unsigned days = 365;
};

// What an identity may do besides driving robots stands among their selectors.
void take_rights(NewIdentity& identity, const std::vector<std::string>& selectors) {
  for (const std::string& selector : selectors) {
    if (selector == "control") identity.may_control = true;
    if (selector != "control" && selector != "none") identity.robots.push_back(selector);
  }
}

std::string rights_of(const std::vector<std::string>& robots, bool may_control) {
  if (robots.empty()) return may_control ? "control the run, and drive nothing" : "look on, and drive nothing";
  return "drive " + joined(robots) + (may_control ? ", and control the run" : "");
}

// `red=0..3,red/*`
NewIdentity parse_client(const std::string& text) {
  const auto equals = text.find('=');
  NewIdentity identity;
  identity.name = text.substr(0, equals);
  if (equals != std::string::npos) take_rights(identity, split_selectors(std::string_view(text).substr(equals + 1)));
  if (identity.robots.empty() && !identity.may_control)
    throw std::invalid_argument(
        fmt::format("'{}' does not say which robots that client may drive; expected such as {}=explorers/*", text,
                    identity.name.empty() ? "red" : identity.name));
  return identity;
}

void check_name(const std::string& name) {
  if (!wire::is_identity_name(name))
    throw std::invalid_argument(fmt::format("'{}' is no name for a client: up to 40 letters, digits, _ and -", name));
}

void initialise(const SecurityCommand& command) {
  const fs::path& folder = command.folder;
  if (fs::exists(folder) && !(fs::is_directory(folder) && fs::is_empty(folder)))
    throw std::invalid_argument(
        fmt::format("{} exists and is no empty folder; 'cohort security add' adds a client to one that was made before",
                    folder.string()));
  std::vector<NewIdentity> identities = {{.name = "observer", .role = wire::Role::observer}};
  for (const std::string& client : command.clients) identities.push_back(parse_client(client));
  if (command.clients.empty()) identities.push_back({.name = "controllers", .robots = {"all"}});
  for (std::uint32_t door = 0; door < identities.size(); ++door) {
    NewIdentity& identity = identities[door];
    check_name(identity.name);
    const auto same = [&](const NewIdentity& other) { return other.name == identity.name; };
    if (std::count_if(identities.begin(), identities.end(), same) > 1)
      throw std::invalid_argument(fmt::format("there are two clients of the name '{}'", identity.name));
    identity.door = door;
    if (command.encrypt) identity.protection = "encrypt";
  }
  if (identities.size() > wire::last_door + 1)
    throw std::invalid_argument(fmt::format("at most {} clients have a port of their own", wire::last_door));
  const bool is_new = !fs::exists(folder);
  try {
    for (const NewIdentity& identity : identities)
      make_door(identity, server_folder(folder, identity.name), client_folder(folder, identity.name), command.days);
  } catch (...) {
    for (const char* made : {"server", "clients"}) fs::remove_all(folder / made);
    if (is_new) fs::remove(folder);
    throw;
  }
  std::cout << fmt::format(
      "{0} is made. {0}/server is the server's: cohort serve … --secure {0}\n"
      "Each folder in {0}/clients belongs to one client: copy it whole to the client's machine, and to nobody "
      "else's:\n",
      folder.string());
  for (const NewIdentity& identity : identities)
    std::cout << fmt::format("  --secure {}  {}\n", client_folder(folder, identity.name).string(),
                             "may " + rights_of(identity.robots, identity.may_control));
}

void add(const SecurityCommand& command) {
  check_name(command.name);
  const std::vector<wire::Identity> doors = wire::read_doors(command.folder);
  if (!fs::is_directory(command.folder / "server"))
    throw std::invalid_argument(fmt::format("{} is not what 'cohort security init' made", command.folder.string()));
  for (const wire::Identity& door : doors)
    if (door.name == command.name)
      throw std::invalid_argument(fmt::format(
          "{} has a client '{}' already; to make it anew, remove {} and {}", command.folder.string(), command.name,
          server_folder(command.folder, command.name).string(), client_folder(command.folder, command.name).string()));
  NewIdentity identity{.name = command.name, .protection = doors.front().protection};
  take_rights(identity, command.robots);
  if (identity.robots.empty() && !identity.may_control)
    throw std::invalid_argument(fmt::format("'{}' could do nothing: expected robots or 'control'", command.name));
  // The first that is free: a client that was removed leaves a gap.
  while (std::ranges::find(doors, identity.door, &wire::Identity::door) != doors.end()) ++identity.door;
  if (identity.door > wire::last_door)
    throw std::invalid_argument(fmt::format("at most {} clients have a port of their own", wire::last_door));
  const fs::path client = client_folder(command.folder, identity.name);
  if (fs::exists(client)) throw std::invalid_argument(fmt::format("{} exists already", client.string()));
  make_door(identity, server_folder(command.folder, identity.name), client, command.days);
  std::cout << fmt::format("{} is made: it may {}. The server takes it when it is started again with this folder.\n",
                           client.string(), rights_of(identity.robots, identity.may_control));
}

void list(const SecurityCommand& command) {
  const std::vector<wire::Identity> doors = wire::read_doors(command.folder);
  std::cout << fmt::format("{:<20} {:<6} {:<11} {:<16} {}\n", "client", "door", "messages", "valid until", "may drive");
  for (const wire::Identity& door : doors) {
    const std::int64_t end = validity_of(door.folder / wire::certificate_file).end;
    const std::string until = fmt::format("{:%Y-%m-%d %H:%M}", fmt::gmtime(static_cast<std::time_t>(end)));
    const bool is_over = end < std::time(nullptr);
    std::cout << fmt::format("{:<20} {:<6} {:<11} {:<16} {}{}\n", door.name, door.door,
                             door.protection == "encrypt" ? "encrypted" : "signed", until,
                             door.robots.empty()
                                 ? door.may_control ? "nothing; controls the run" : "nothing, only look on"
                                 : joined(door.robots) + (door.may_control ? "; controls the run" : ""),
                             is_over ? "   EXPIRED" : "");
  }
}

}  // namespace

Subcommand add_security(CommandLine app) {
  const auto command = std::make_shared<SecurityCommand>();
  CommandLine line = app.add_subcommand("security", "Make and list who may drive what, with certificates");
  line.require_subcommand();
  const auto add_folder = [command](CommandLine sub) {
    sub.add_option("DIR", command->folder, "Folder of all identities").required().type_name("");
  };
  const auto add_days = [command](CommandLine sub) {
    sub.add_option("--days", command->days, "How long the certificates are valid")
        .check(whole_number(1, longest_validity))
        .capture_default_str()
        .type_name("N");
  };
  CommandLine init_line = line.add_subcommand("init", "Make certificates and permissions for a server and its clients");
  add_folder(init_line);
  init_line
      .add_option("--client", command->clients,
                  "A client and what it may drive, control too; may be repeated (default: controllers=all)")
      .one_value()
      .type_name("NAME=SEL[,SEL...]");
  init_line.add_flag("--encrypt", command->encrypt, "Encrypt all messages (default: sign them)");
  add_days(init_line);
  init_line.callback([command] { command->what = SecurityCommand::What::init; });
  init_line.footer("Example: cohort security init keys --client red=red/* --client operator=none,control");

  CommandLine add_line = line.add_subcommand("add", "Make one more client");
  add_folder(add_line);
  add_line.add_option("NAME", command->name, "Of the client: letters, digits, _ and -").required().type_name("");
  add_line
      .add_option("--robots", command->robots,
                  "What it may drive: all, an id, ids A..B, a name with *, none; and control; by commas")
      .required()
      .comma_separated()
      .type_name("SEL[,SEL...]");
  add_days(add_line);
  add_line.callback([command] { command->what = SecurityCommand::What::add; });
  add_line.footer("Example: cohort security add keys green --robots green/*");

  CommandLine list_line = line.add_subcommand("list", "Say who may drive what, and until when certificates are valid");
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
