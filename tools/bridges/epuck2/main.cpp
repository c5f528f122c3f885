// cohort-epuck2-bridge: programs written for the WiFi of an e-puck2 drive robots of a simulation
// (docs/bridges/epuck2.md). One client of the server for each robot, on a thread of its own: while one robot waits for
// its program, the others go on, so a program may drive several in any order.

#include <CLI/CLI.hpp>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "client_sdk/src/attachment.hpp"
#include "client_sdk/src/program.hpp"
#include "tools/bridges/epuck2/port.hpp"
#include "tools/bridges/epuck2/robot.hpp"

namespace {

using namespace cohort;

constexpr int exit_finished = 0;
constexpr int exit_usage = 2;
constexpr int exit_interrupted = 130;
constexpr std::uint32_t most_robots = 100;

struct Options {
  std::string robots = "0";
  std::string server = "127.0.0.1";
  std::uint32_t domain = 0;
  std::vector<std::string> addresses{"127.0.0.1"};
  std::uint16_t port = 1000;
  epuck2::WithoutProgram without_program = epuck2::WithoutProgram::wait;
  epuck2::Packets packets = epuck2::Packets::both;
};

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::uint32_t id_in(const std::string& text) {
  if (text.empty() || text.size() > 6 || text.find_first_not_of("0123456789") != std::string::npos) {
    throw UsageError("'" + text + "' is no id of a robot");
  }
  return static_cast<std::uint32_t>(std::stoul(text));
}

// Each robot has a port, so there must be a selector for each.
std::vector<std::string> robots_in(const std::string& list) {
  std::vector<std::string> robots;
  for (const std::string& selector : split_selectors(list)) {
    if (const auto dots = selector.find(".."); dots != std::string::npos) {
      const std::uint32_t last = id_in(selector.substr(dots + 2));
      for (std::uint32_t id = id_in(selector.substr(0, dots)); id <= last && robots.size() <= most_robots; ++id) {
        robots.push_back(std::to_string(id));
      }
    } else if (selector == "all" || selector.find('*') != std::string::npos) {
      throw UsageError("--robots wants them one by one, or a range of ids such as 0..3: each has a port of its own");
    } else {
      robots.push_back(selector);
    }
  }
  if (robots.empty()) throw UsageError("--robots names no robot");
  if (robots.size() > most_robots) throw UsageError("at most " + std::to_string(most_robots) + " robots");
  return robots;
}

// One robot: its port, and the client that drives it.
class Bridge {
 public:
  Bridge(std::string robot, const std::string& address, std::uint16_t port, const Options& options,
         std::atomic<bool>& stop)
      : name_("robot " + std::move(robot)),
        stop_(stop),
        port_(address, port,
              {[this] { return stop_ || watch_.is_over(); }, [this](const std::string& text) { tell(text); }}),
        without_program_(options.without_program),
        packets_(options.packets) {
    client_.server = options.server;
    client_.domain = options.domain;
    client_.robots = {name_.substr(name_.find(' ') + 1)};
    client_.name = "epuck2-bridge";
    client_.tell = [this](Severity, const std::string& text) { tell(text); };
    tell("programs reach it at " + address + ":" + std::to_string(port_.number()));
  }

  void start() {
    thread_ = std::thread([this] { run(); });
  }
  ClientEnd wait() {
    thread_.join();
    return end_;
  }

 private:
  void run() {
    const ControllerKind kind{client_.name, [this] {
                                return OwnedController(new epuck2::Robot(port_, without_program_, packets_),
                                                       [](Controller* controller) { delete controller; });
                              }};
    try {
      ControllerHost host(kind);
      end_ = run_client(host, client_.name, client_, stop_, &watch_);
    } catch (const std::exception& error) {
      tell(error.what());
    }
    // The others' runs go on in vain without this one's.
    if (end_ != ClientEnd::finished) stop_ = true;
  }

  void tell(const std::string& text) const { std::fprintf(stderr, "%s: %s\n", name_.c_str(), text.c_str()); }

  std::string name_;
  std::atomic<bool>& stop_;
  RunWatch watch_;
  epuck2::Port port_;
  epuck2::WithoutProgram without_program_;
  epuck2::Packets packets_;
  ClientOptions client_;
  std::thread thread_;
  ClientEnd end_ = ClientEnd::failed;
};

template <class Value>
void add_choice(CLI::App& app, const std::string& name, Value& value, const std::map<std::string, Value>& choices,
                const std::string& text) {
  std::string names;
  for (const auto& [choice, its_value] : choices) names += (names.empty() ? "" : "|") + choice;
  const auto check = [choices, names](const std::string& given) {
    return choices.contains(given) ? std::string() : "'" + given + "' is none of " + names;
  };
  app.add_option_function<std::string>(
         name, [&value, choices](const std::string& given) { value = choices.at(given); }, text)
      ->check(check, "", "")
      ->type_name(names);
}

int run(const Options& options) {
  const std::vector<std::string> robots = robots_in(options.robots);
  const bool counts_ports = options.addresses.size() == 1;
  if (!counts_ports && options.addresses.size() != robots.size()) {
    throw UsageError("--listen wants one address, or one for each robot");
  }
  std::atomic<bool>& stop = stop_on_signals();
  std::vector<std::unique_ptr<Bridge>> bridges;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const std::size_t port = counts_ports && options.port != 0 ? options.port + i : options.port;
    if (port > 65535) throw UsageError("there are no ports beyond 65535");
    bridges.push_back(std::make_unique<Bridge>(robots[i], options.addresses[counts_ports ? 0 : i],
                                               static_cast<std::uint16_t>(port), options, stop));
  }
  for (const auto& bridge : bridges) bridge->start();
  // The first that ended for another reason than the others' end.
  int code = exit_finished;
  for (const auto& bridge : bridges) {
    const int its = exit_code_of(bridge->wait());
    if (code == exit_finished || code == exit_interrupted) code = its == exit_finished ? code : its;
  }
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  if (const char* server = std::getenv("COHORT_SERVER"); server != nullptr) options.server = server;
  CLI::App app("Programs for the WiFi of an e-puck2 drive robots of a simulation.", "cohort-epuck2-bridge");
  app.add_option("--robots", options.robots, "Ids, ranges of ids and names, with commas between")
      ->type_name("ROBOT[,ROBOT...]")
      ->capture_default_str();
  app.add_option("--server", options.server, "The server's IPv4 address or host name")
      ->type_name("ADDRESS")
      ->capture_default_str();
  app.add_option("--domain", options.domain, "The server's DDS domain")
      ->type_name("N")
      ->envname("COHORT_DOMAIN")
      ->capture_default_str();
  app.add_option("--listen", options.addresses,
                 "Where programs connect: an IPv4 address of this machine, or one for each robot, with commas between")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("ADDRESS[,ADDRESS...]")
      ->capture_default_str();
  app.add_option("--port", options.port,
                 "Of the first robot; with one address the others' count upwards. 0: any that are free")
      ->type_name("N")
      ->capture_default_str();
  add_choice<epuck2::WithoutProgram>(
      app, "--without-program", options.without_program,
      {{"wait", epuck2::WithoutProgram::wait}, {"stand", epuck2::WithoutProgram::stand}},
      "When a program has left: time stands still until another one commands (wait, the default), or its robot stops "
      "and the run goes on (stand)");
  add_choice<epuck2::Packets>(app, "--packets", options.packets,
                              {{"both", epuck2::Packets::both}, {"in-turn", epuck2::Packets::in_turn}},
                              "The answer where image and sensors are asked for: both (the default), or one of them by "
                              "turns, for programs that read a single packet after each command");
  app.footer("Example: cohort serve worlds/experiments/epuck2.yaml & cohort-epuck2-bridge --robots 0..3");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? exit_finished : exit_usage;
  }
  try {
    return run(options);
  } catch (const UsageError& error) {
    std::fprintf(stderr, "cohort-epuck2-bridge: %s. Try --help.\n", error.what());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "cohort-epuck2-bridge: %s\n", error.what());
  }
  return exit_usage;
}
