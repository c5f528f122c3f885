#include "tools/bridges/common/bridge_program.hpp"

#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>

#include "tools/bridges/common/robot_bridge.hpp"

namespace cohort::bridges {
namespace {

constexpr int exit_usage = 2;
constexpr std::uint32_t most_robots = 100;

std::uint32_t id_in(const std::string& text) {
  constexpr std::size_t most_digits = 6;
  if (text.empty() || text.size() > most_digits || text.find_first_not_of("0123456789") != std::string::npos)
    throw UsageError("'" + text + "' is not an id of a robot");
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
      throw UsageError("--robots expects single robots or ranges of ids such as 0..3: each has a link of its own");
    } else {
      robots.push_back(selector);
    }
  }
  if (robots.empty()) throw UsageError("--robots names no robot");
  if (robots.size() > most_robots) throw UsageError("at most " + std::to_string(most_robots) + " robots");
  return robots;
}

BridgeProgram::BridgeProgram(std::string name, std::string who, const std::string& text)
    : name_(std::move(name)), who_(std::move(who)), app_(text, name_) {
  client_.name = name_;
  app_.add_option("--robots", robots_, "Ids, ranges of ids and names, separated by commas")
      ->type_name("ROBOT[,ROBOT...]")
      ->capture_default_str();
  app_.add_option("--server", client_.server, "The server's IPv4 address or host name")
      ->type_name("ADDRESS")
      ->envname("COHORT_SERVER")
      ->capture_default_str();
  app_.add_option("--domain", client_.domain, "The server's DDS domain")
      ->type_name("N")
      ->envname("COHORT_DOMAIN")
      ->capture_default_str();
  app_.add_option("--secure", client_.secure, "Folder of this client's identity (default: without security)")
      ->type_name("DIR")
      ->envname("COHORT_SECURE");
}

void BridgeProgram::add_choice_of(const std::string& option, const std::vector<std::string>& names,
                                  const std::string& text, const std::function<void(const std::string&)>& choose) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : "|") + name;
  const auto check = [names, all](const std::string& given) {
    return std::ranges::find(names, given) != names.end() ? std::string() : "'" + given + "' is none of " + all;
  };
  app_.add_option_function<std::string>(option, choose, text)->check(check, "", "")->type_name(all);
}

int BridgeProgram::run(int argc, char** argv, const std::function<std::unique_ptr<Firmware>()>& make,
                       const std::function<std::string(std::size_t robot, std::size_t robots)>& link_of) {
  try {
    app_.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app_.exit(error) == 0 ? 0 : exit_usage;
  }
  try {
    const std::vector<std::string> robots = single_robots(robots_);
    std::atomic<bool>& stop = stop_on_signals();
    std::vector<std::unique_ptr<RobotBridge>> bridges;
    for (std::size_t i = 0; i < robots.size(); ++i) {
      RobotBridge::Options options{client_, link_of(i, robots.size()), who_};
      options.client.robots = {robots[i]};
      bridges.push_back(std::make_unique<RobotBridge>(std::move(options), make(), patience_, stop));
    }
    return run_bridges(bridges);
  } catch (const UsageError& error) {
    std::fprintf(stderr, "%s: %s. Try --help.\n", name_.c_str(), error.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name_.c_str(), error.what());
  }
  return exit_usage;
}

}  // namespace cohort::bridges
