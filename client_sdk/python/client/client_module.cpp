// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <atomic>
#include <cohort/client.hpp>
#include <csignal>
#include <string>
#include <utility>
#include <vector>

#include "client_sdk/python/hosting/python_team.hpp"
#include "client_sdk/python/hosting/unlocked.hpp"
#include "client_sdk/src/attachment.hpp"

/// The extension module `cohort._client`: controllers as clients of a server, over DDS.
namespace cohort::python {
namespace {

namespace nb = nanobind;

/// Restores Python's signal handlers when it is destroyed.
class SignalsOfPython {
 public:
  SignalsOfPython() {
    for (std::size_t i = 0; i < std::size(signals); ++i) ::sigaction(signals[i], nullptr, &actions_[i]);
  }
  SignalsOfPython(const SignalsOfPython&) = delete;
  SignalsOfPython& operator=(const SignalsOfPython&) = delete;
  ~SignalsOfPython() {
    for (std::size_t i = 0; i < std::size(signals); ++i) ::sigaction(signals[i], &actions_[i], nullptr);
  }

 private:
  static constexpr int signals[] = {SIGINT, SIGTERM, SIGHUP};
  struct sigaction actions_[std::size(signals)] = {};
};

const char* word_of(ClientEnd end) {
  switch (end) {
    case ClientEnd::finished: return "finished";
    case ClientEnd::refused: return "refused";
    case ClientEnd::superseded: return "superseded";
    case ClientEnd::failed: return "failed";
    case ClientEnd::server_lost: return "server_lost";
    case ClientEnd::interrupted: return "interrupted";
  }
  return "failed";
}

// Returns how the client ended, and its last error message.
std::pair<std::string, std::string> host(nb::handle maker, const std::vector<std::string>& robots,
                                         const std::string& server, std::int64_t domain, const std::string& secure) {
  ClientOptions options;
  take_environment(options);
  if (!robots.empty()) options.robots = robots;
  if (!server.empty()) options.server = server;
  if (domain >= 0) options.domain = static_cast<std::uint32_t>(domain);
  if (!secure.empty()) options.secure = secure;
  std::string error;
  options.tell = [&](Severity severity, const std::string& text) {
    if (severity == Severity::error) error = text;
  };
  const ControllerKind kind = kind_of_maker(maker.ptr());
  const SignalsOfPython restored;
  std::atomic<bool>& stop = stop_on_signals();
  stop = false;
  const Unlocked unlocked(&stop);
  const ClientEnd end = run_client(kind, options, stop);
  return {word_of(end), error};
}

int run_program(nb::handle maker, std::vector<std::string> arguments) {
  const ControllerKind kind = kind_of_maker(maker.ptr());
  std::vector<char*> argv;
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const SignalsOfPython restored;
  std::atomic<bool>& stop = stop_on_signals();
  stop = false;
  const Unlocked unlocked(&stop);
  return run_controller(kind, static_cast<int>(arguments.size()), argv.data());
}

}  // namespace
}  // namespace cohort::python

NB_MODULE(_client, module) {
  using namespace nanobind::literals;
  nanobind::set_leak_warnings(false);  // about objects that are alive when Python exits
  cohort::python::watch_for_the_end_of_python();
  module.def("host", &cohort::python::host, "maker"_a, "robots"_a, "server"_a, "domain"_a, "secure"_a);
  module.def("run_program", &cohort::python::run_program, "maker"_a, "arguments"_a);
}
