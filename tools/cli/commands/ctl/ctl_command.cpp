// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cohort/control.hpp>
#include <span>
#include <thread>

#include "server/core/bounded_file.hpp"
#include "server/run/snapshot_size.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/ctl/ctl_history.hpp"
#include "tools/cli/commands/ctl/ctl_options.hpp"
#include "tools/cli/commands/ctl/ctl_status.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/shown.hpp"

namespace cohort::tool {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds for_a_server{5'000};
constexpr milliseconds for_status{2'000};
constexpr milliseconds watch_interval{500};

// One execution of the command. Its exceptions are the reason of a failure, unless it was interrupted.
class Ctl {
 public:
  Ctl(const CtlCommand& command, Log& log, const std::atomic<bool>& stop)
      : command_(command),
        log_(log),
        stop_(stop),
        control_({.server = command_.connection.server,
                  .domain = command_.connection.domain(),
                  .secure = command_.connection.secure.string(),
                  .label = "cohort ctl",
                  .time_limit = time_limit()}) {
    control_.stop_on(&stop_);
  }

  int run() {
    if (!control_.wait_for_server(time_limit().value_or(for_a_server))) throw no_server();
    switch (command_.what) {
      case CtlCommand::What::request: ask([&] { show(command_.request(control_)); }); break;
      case CtlCommand::What::status:
        if (command_.watch) return watch();
        ask([&] { show(status(2)); });
        break;
      case CtlCommand::What::history: ask([&] { history(); }); break;
      case CtlCommand::What::save: save(); break;
      case CtlCommand::What::load: load(); break;
    }
    return exit_ok;
  }

 private:
  std::optional<milliseconds> time_limit() const {
    if (!command_.timeout) return std::nullopt;
    return milliseconds(static_cast<std::int64_t>(*command_.timeout * 1e3));
  }

  std::runtime_error no_server() const {
    const std::uint32_t domain = command_.connection.domain();
    return std::runtime_error(fmt::format(
        "no controllable server found at {}, domain {}. Check that a server runs there and that --domain matches: a "
        "run that starts its own controllers chooses a free domain unless --domain is given{}. 'cohort doctor --server "
        "{} --domain {}' diagnoses the connection",
        command_.connection.server, domain,
        command_.connection.secure.empty() ? ". A server started with --secure also requires --secure here"
                                           : ". Check that the server's --secure folder contains this identity",
        command_.connection.server, domain));
  }

  // Executes a request; if there is no reply, adds the reason to the error.
  template <class Request>
  void ask(const Request& request) {
    try {
      request();
    } catch (const ControlError& error) {
      if (error.result != ControlResult::no_answer) throw;
      const std::string why = why_it_waits();
      throw ControlError(error.what() + (why.empty() ? "" : "; it takes effect at the next tick: " + why),
                         error.result);
    }
  }

  // A request waits for a tick boundary, which waits for the controllers.
  std::string why_it_waits() try {
    control_.set_time_limit(for_status);
    const SimulationStatus status = control_.status();
    if (status.awaited.empty()) return fmt::format("the run is {}", word_of(status.state));
    std::string text = fmt::format("the run waits for {}", status.awaited.front());
    if (status.awaited_count > 1) text += fmt::format(" and {} more", status.awaited_count - 1);
    for (const ControllerStatus& each : status.controllers)
      if (each.awaited) return text + ": " + each.label;
    return text;
  } catch (const ControlError&) {
    return {};
  }

  std::string status(int indent) {
    const SimulationStatus status = control_.status();
    return command_.json ? status_json(status, indent) : status_text(status);
  }

  int watch() {
    const bool is_terminal = ::isatty(STDOUT_FILENO) == 1;
    while (!stop_) {
      const auto next = std::chrono::steady_clock::now() + watch_interval;
      std::string text;
      try {
        ask([&] { text = status(-1); });
      } catch (const ControlError& error) {
        if (error.result != ControlResult::server_gone) throw;
        log_.notice(error.what());
        return exit_ok;
      }
      if (is_terminal && !command_.json) write_output("\033[H\033[2J");
      show(text + (is_terminal || command_.json ? "" : "\n"));
      if (flush_output() != 0) return exit_ok;  // `main` reports the reason
      while (!stop_ && std::chrono::steady_clock::now() < next) std::this_thread::sleep_for(milliseconds(20));
    }
    return exit_interrupted;
  }

  void history() {
    const std::chrono::nanoseconds step = control_.status().step;
    const RunHistory all = control_.history();
    show(command_.json ? history_json(all, step) : history_text(all, step));
  }

  void save() {
    check_writable("the snapshot", command_.file);
    std::vector<std::byte> bytes;
    ask([&] { bytes = control_.save_snapshot(); });
    write_file("the snapshot", command_.file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    show(fmt::format("{}: {} bytes, {}\n", command_.file.string(), bytes.size(), control_.last_reply().message));
  }

  void load() {
    const std::string bytes = read_bounded(command_.file, session::most_snapshot_bytes);
    ask([&] { show(control_.load_snapshot(std::as_bytes(std::span(bytes))).message + "\n"); });
  }

  const CtlCommand& command_;
  Log& log_;
  const std::atomic<bool>& stop_;
  Control control_;
};

int ctl(const CtlCommand& command, Log& log, const std::atomic<bool>& stop) {
  Ctl one(command, log, stop);
  try {
    return one.run();
  } catch (const std::exception& error) {
    if (stop) return exit_interrupted;
    log.error(text_of(error));
    return exit_failed;
  }
}

}  // namespace

Subcommand add_ctl(CommandLine app) {
  const auto command = std::make_shared<CtlCommand>();
  CommandLine line =
      app.add_subcommand("ctl", "Control a run: pause or step it, change its world, save it, or show its status");
  add_ctl_options(line, *command);
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return ctl(*command, log, stop); }};
}

}  // namespace cohort::tool
