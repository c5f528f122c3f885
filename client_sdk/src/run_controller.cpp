// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/attachment.hpp"
#include "idl/text/domains.hpp"
#include "idl/text/standard_streams.hpp"

namespace cohort {
namespace {

constexpr int exit_finished = 0;
constexpr int exit_usage = 2;

constexpr const char* help =
    R"(Usage: %s [--robots SEL[,SEL...]] [--server ADDRESS] [--domain N] [--secure DIR]

Drives robots of a running simulation until the run ends.

  --robots SEL[,SEL...]  robots to drive: all, an id (3), a range of ids (0..7), a name (explorers/sbot_7), or a name
                         with * (explorers/*). Default: all
  --server ADDRESS       the server's IPv4 address or host name. Default: $COHORT_SERVER, or 127.0.0.1
  --domain N|A..B        the server's DDS domain, or a range from which one is chosen. Default: $COHORT_DOMAIN, or 0
  --secure DIR           folder of this client's identity, created by 'cohort security'. Default: $COHORT_SECURE, or
                         none
  --help                 print this help and exit

Exit code: 0 when the run finished, 1 when it failed, the server was lost or another process took over, 2 for a mistake
in the options or a refused claim, 130 when interrupted.
)";

class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

std::uint32_t parse_domain(std::string_view text) {
  try {
    return domain_of_this_process(parse_domains(text));
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
}

struct Arguments {
  ClientOptions options;
  bool help = false;
};

Arguments parse(int argc, char** argv) {
  Arguments arguments;
  ClientOptions& options = arguments.options;
  try {
    take_environment(options);
  } catch (const std::invalid_argument& error) {
    throw UsageError(error.what());
  }
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    const auto equals = argument.find('=');
    const std::string_view name = argument.substr(0, equals);
    const auto value = [&]() -> std::string_view {
      if (equals != std::string_view::npos) return argument.substr(equals + 1);
      if (++i == argc) throw UsageError(std::string(name) + " requires a value");
      return argv[i];
    };
    if (name == "--help" || name == "-h") {
      arguments.help = true;
    } else if (name == "--robots") {
      options.robots = split_selectors(value());
      if (options.robots.empty()) throw UsageError("'--robots' is empty; expected at least one selector");
    } else if (name == "--server") {
      options.server = value();
    } else if (name == "--domain") {
      options.domain = parse_domain(value());
    } else if (name == "--secure") {
      options.secure = value();
    } else {
      throw UsageError("unknown option '" + std::string(name) + "'");
    }
  }
  return arguments;
}

}  // namespace

int run_controller(const ControllerKind& kind, int argc, char** argv) {
  open_standard_streams();
  try {
    const Arguments arguments = parse(argc, argv);
    if (arguments.help) {
      std::printf(help, argv[0]);
      return exit_finished;
    }
    return exit_code_of(run_client(kind, arguments.options, stop_on_signals()));
  } catch (const UsageError& error) {
    print_message(kind.name + ": " + error.what() + ". Try --help.");
  } catch (const std::exception& error) {
    print_message(kind.name + ": " + error.what());
  }
  return exit_usage;
}

int run_controller(const Plugin& plugin, int argc, char** argv) { return run_controller(kind_of(plugin), argc, argv); }

}  // namespace cohort
