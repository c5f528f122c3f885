// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/common/bridge_program.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <exception>
#include <iostream>
#include <sstream>
#include <system_error>

#include "idl/text/domains.hpp"
#include "idl/text/standard_streams.hpp"

namespace cohort::bridges {
namespace {

constexpr int exit_usage = 2;
constexpr std::uint32_t most_robots = 100;

// Returns the exit code of a program that would end with `code`: a failure if its output could not be written.
int code_after_output(const std::string& program, int code) {
  const int error = flush_output();
  if (error == 0) return code;
  print_message(program + ": standard output cannot be written: " + std::generic_category().message(error));
  return code == 0 ? 1 : code;
}

std::uint32_t id_in(const std::string& text) {
  constexpr std::size_t most_digits = 6;
  if (text.empty() || text.size() > most_digits || text.find_first_not_of("0123456789") != std::string::npos)
    throw UsageError("'" + text + "': expected the id of a robot");
  return static_cast<std::uint32_t>(std::stoul(text));
}

}  // namespace

std::vector<std::string> single_robots(const std::string& list) {
  std::vector<std::string> robots;
  for (const std::string& selector : split_selectors(list)) {
    if (const auto dots = selector.find(".."); dots != std::string::npos) {
      const std::uint32_t last = id_in(selector.substr(dots + 2));
      for (std::uint32_t id = id_in(selector.substr(0, dots)); id <= last && robots.size() <= most_robots; ++id)
        robots.push_back(std::to_string(id));
    } else if (selector == "all" || selector.find('*') != std::string::npos) {
      throw UsageError("--robots expects single robots or ranges of ids such as 0..3: each robot needs its own link");
    } else {
      robots.push_back(selector);
    }
  }
  if (robots.empty()) throw UsageError("'--robots' is empty; expected at least one selector");
  if (robots.size() > most_robots) throw UsageError("expected at most " + std::to_string(most_robots) + " robots");
  return robots;
}

BridgeProgram::BridgeProgram(std::string name, std::string who, const std::string& text)
    : name_(std::move(name)), who_(std::move(who)), app_(text, name_) {
  open_standard_streams();
  client_.name = name_;
  app_.add_option("--robots", robots_, "Robots: ids, ranges of ids or names, separated by commas")
      ->type_name("ROBOT[,ROBOT...]")
      ->capture_default_str();
  app_.add_option("--server", client_.server, "The server's IPv4 address or host name")
      ->type_name("ADDRESS")
      ->envname("COHORT_SERVER")
      ->capture_default_str();
  app_.add_option_function<std::string>(
          "--domain",
          [this](const std::string& domains) {
            try {
              client_.domain = domain_of_this_process(parse_domains(domains));
            } catch (const std::invalid_argument& error) {
              throw CLI::ValidationError("--domain", error.what());
            }
          },
          "The server's DDS domain, or a range from which one is chosen")
      ->type_name("N|A..B")
      ->envname("COHORT_DOMAIN")
      ->default_str("0");
  app_.add_option("--secure", client_.secure, "Folder of this client's identity (default: no security)")
      ->type_name("DIR")
      ->envname("COHORT_SECURE");
}

void BridgeProgram::offer_to_run_programs(const std::string& text) {
  app_.add_option("--run", command_, text)->type_name("COMMAND");
}

void BridgeProgram::add_choice_of(const std::string& option, const std::vector<std::string>& names,
                                  const std::string& text, const std::function<void(const std::string&)>& choose) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : "|") + name;
  const auto check = [names, all](const std::string& given) {
    return std::ranges::find(names, given) != names.end() ? std::string() : "'" + given + "': expected one of " + all;
  };
  app_.add_option_function<std::string>(option, choose, text)->check(check, "", "")->type_name(all);
}

CLI::Option& BridgeProgram::add_serial() {
  return *app_.add_option(
                  "--serial", serial_,
                  "Serial devices to which the hardware is connected, one for each robot, such as /dev/ttyACM0:115200")
              ->delimiter(',')
              ->allow_extra_args(false)
              ->type_name("DEVICE:BAUD[,DEVICE:BAUD...]");
}

int BridgeProgram::run(int argc, char** argv, const std::function<std::unique_ptr<Firmware>()>& make,
                       const std::function<std::string(std::size_t robot, std::size_t robots)>& link_of) {
  return run(argc, argv, [&](const std::vector<std::string>& robots, std::size_t robot) -> Driver {
    if (has_serial() && serial_.size() != robots.size()) throw UsageError("--serial expects one device for each robot");
    return {make(), open_link(has_serial() ? "serial:" + serial_[robot] : link_of(robot, robots.size()))};
  });
}

int BridgeProgram::run(int argc, char** argv, const MakeDriver& make) {
  return run_to_exit_code(argc, argv, [&] {
    const std::vector<std::string> robots = single_robots(robots_);
    std::atomic<bool>& stop = stop_on_signals();
    std::vector<std::unique_ptr<RobotBridge>> bridges;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      RobotBridge::Options options{client_, who_, command_};
      options.client.robots = {robots[i]};
      bridges.push_back(std::make_unique<RobotBridge>(std::move(options), make(robots, i), patience_, stop));
    }
    return run_bridges(bridges);
  });
}

int BridgeProgram::run(int argc, char** argv, const std::function<ClientEnd(const ClientOptions& client)>& drive) {
  return run_to_exit_code(argc, argv, [&] {
    ClientOptions client = client_;
    client.robots = split_selectors(robots_);
    if (client.robots.empty()) throw UsageError("'--robots' is empty; expected at least one selector");
    return exit_code_of(drive(client));
  });
}

int BridgeProgram::run_to_exit_code(int argc, char** argv, const std::function<int()>& body) {
  try {
    app_.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::ostringstream text;
    const int code = app_.exit(error, text, std::cerr) == 0 ? 0 : exit_usage;
    write_output(text.str());
    return code_after_output(name_, code);
  }
  try {
    return code_after_output(name_, body());
  } catch (const UsageError& error) {
    print_message(name_ + ": " + error.what() + ". Try --help.");
  } catch (const std::exception& error) {
    print_message(name_ + ": " + error.what());
  }
  return exit_usage;
}

}  // namespace cohort::bridges
