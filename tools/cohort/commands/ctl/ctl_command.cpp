#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <thread>

#include "client_sdk/src/control_client.hpp"
#include "tools/cohort/cli/output_file.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/commands/ctl/ctl_history.hpp"
#include "tools/cohort/commands/ctl/ctl_options.hpp"
#include "tools/cohort/commands/ctl/ctl_status.hpp"

namespace cohort::tool {
namespace {

using std::chrono::milliseconds;
using wire::Operation;
using wire::Reply;
using wire::Request;
using wire::ResultCode;

constexpr milliseconds for_a_server{5'000};
constexpr milliseconds for_status{2'000};
constexpr milliseconds watch_interval{500};

milliseconds patience_for(const CtlCommand& command) {
  if (command.timeout) return milliseconds(static_cast<std::int64_t>(*command.timeout * 1e3));
  const Operation operation = command.request.operation;
  const bool takes_long = command.what == CtlCommand::What::load ||
                          (command.what == CtlCommand::What::request &&
                           (operation == Operation::step_simulation || operation == Operation::reset_simulation ||
                            operation == Operation::go_back));
  return takes_long ? for_ever : for_a_reply;
}

std::vector<char> read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad()) throw std::runtime_error("cannot read " + file.string());
  return bytes;
}

// One call of the command.
class Ctl {
 public:
  Ctl(CtlCommand command, Log& log, const std::atomic<bool>& stop)
      : command_(std::move(command)),
        log_(log),
        stop_(stop),
        client_({.server = command_.connection.server,
                 .domain = command_.connection.domain(),
                 .secure = command_.connection.secure.string(),
                 .label = "cohort ctl"}),
        patience_(patience_for(command_)) {}

  int run() {
    const milliseconds patience = command_.timeout ? patience_ : for_a_server;
    if (!client_.wait_for_server(patience, stop_)) return stop_ ? exit_interrupted : no_server();
    switch (command_.what) {
      case CtlCommand::What::request: return request();
      case CtlCommand::What::status: return command_.watch ? watch() : status();
      case CtlCommand::What::history: return history();
      case CtlCommand::What::entities: return entities();
      case CtlCommand::What::save: return save();
      case CtlCommand::What::load: return load();
    }
    return exit_usage;
  }

 private:
  int no_server() {
    const std::uint32_t domain = command_.connection.domain();
    log_.error(fmt::format(
        "no server that can be controlled is at {}, domain {}. Is one running there, with this --domain? A run that "
        "starts "
        "its own controllers takes a domain of its own unless it is given one{}. 'cohort doctor --server {} --domain "
        "{}' looks "
        "for what is wrong",
        command_.connection.server, domain,
        command_.connection.secure.empty() ? "; one with --secure needs it here too"
                                           : ", and does its folder have this identity",
        command_.connection.server, domain));
    return exit_failed;
  }

  // Of a request that brought none.
  int no_reply() {
    if (stop_) return exit_interrupted;
    if (client_.server_is_gone()) {
      log_.error("the server has gone");
      return exit_failed;
    }
    const std::string why = why_it_waits();
    log_.error(fmt::format("it was not done within {:g} s{}", 1e-3 * static_cast<double>(patience_.count()),
                           why.empty() ? ": the server does not answer" : ", and will be at the next tick: " + why));
    return exit_failed;
  }

  // What is asked for waits for a boundary, and that for the controllers.
  std::string why_it_waits() {
    Request request;
    request.operation = Operation::get_status;
    const auto reply = client_.ask(request, for_status, stop_);
    if (!reply || reply->status.empty()) return {};
    const wire::SimulationStatus& status = reply->status.front();
    if (status.awaited.empty()) return fmt::format("the run is {}", word_of(reply->state));
    std::string text = fmt::format("the run waits for {}", status.awaited.front());
    if (status.awaited_count > 1) text += fmt::format(" and {} more", status.awaited_count - 1);
    for (const wire::ControllerStatus& each : status.controllers)
      if (each.awaited) return text + ": " + each.label;
    return text;
  }

  int request() {
    if (command_.request.operation == Operation::spawn_entity) take_model();
    const bool quits = command_.request.operation == Operation::set_simulation_state &&
                       command_.request.state == wire::SimulationState::quitting;
    const auto reply = client_.ask(command_.request, patience_, stop_);
    if (!reply && quits && client_.server_is_gone()) return exit_ok;  // with its last words
    if (!reply) return no_reply();
    const bool is_done =
        reply->result == ResultCode::ok || (command_.request.operation == Operation::set_simulation_state &&
                                            reply->result == ResultCode::already_in_target_state);
    if (!is_done) {
      log_.error(reply->error_message);
      return exit_failed;
    }
    std::printf("%s\n", reply->error_message.c_str());
    return exit_ok;
  }

  void take_model() {
    if (!std::filesystem::is_regular_file(command_.model)) {
      command_.request.uri = command_.model.string();
      return;
    }
    const std::vector<char> text = read_file(command_.model);
    command_.request.resource_string.assign(text.begin(), text.end());
  }

  std::optional<Reply> ask_status() {
    Request request;
    request.operation = Operation::get_status;
    return client_.ask(request, patience_, stop_);
  }

  int status() {
    const auto reply = ask_status();
    if (!reply) return no_reply();
    std::fputs((command_.json ? status_json(*reply, 2) : status_text(*reply)).c_str(), stdout);
    return exit_ok;
  }

  int watch() {
    const bool is_terminal = ::isatty(STDOUT_FILENO) == 1;
    while (!stop_) {
      const auto next = std::chrono::steady_clock::now() + watch_interval;
      const auto reply = ask_status();
      if (!reply && client_.server_is_gone() && !stop_) {
        log_.notice("the server has gone");
        return exit_ok;
      }
      if (!reply) return no_reply();
      const char* const begin = is_terminal && !command_.json ? "\033[H\033[2J" : "";
      const std::string text = command_.json ? status_json(*reply, -1) : status_text(*reply);
      std::printf("%s%s%s", begin, text.c_str(), is_terminal || command_.json ? "" : "\n");
      std::fflush(stdout);
      while (!stop_ && std::chrono::steady_clock::now() < next) std::this_thread::sleep_for(milliseconds(20));
    }
    return exit_interrupted;
  }

  int history() {
    const auto status = ask_status();
    if (!status || status->status.empty()) return no_reply();
    viewing::RunHistory all;
    Request request;
    request.operation = Operation::get_history;
    for (bool is_complete = false; !is_complete;) {
      const auto reply = client_.ask(request, patience_, stop_);
      if (!reply) return no_reply();
      if (reply->result != ResultCode::ok) {
        log_.error(reply->error_message);
        return exit_failed;
      }
      add(all, recording::decode<viewing::RunHistory>(std::as_bytes(std::span(reply->data))));
      is_complete = reply->offset == request.offset || reply->offset >= reply->size;
      request.offset = reply->offset;
    }
    const std::chrono::nanoseconds step(status->status.front().step_ns);
    std::fputs((command_.json ? history_json(all, step) : history_text(all, step)).c_str(), stdout);
    return exit_ok;
  }

  int entities() {
    command_.request.operation = Operation::get_entities;
    const auto reply = client_.ask(command_.request, patience_, stop_);
    if (!reply) return no_reply();
    if (reply->result != ResultCode::ok) {
      log_.error(reply->error_message);
      return exit_failed;
    }
    for (const std::string& name : reply->entities) std::printf("%s\n", name.c_str());
    return exit_ok;
  }

  int save() {
    check_writable("the snapshot", command_.file);
    const std::vector<std::byte> bytes = client_.save(patience_, stop_);
    write_file("the snapshot", command_.file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    std::printf("%s: %zu bytes\n", command_.file.c_str(), bytes.size());
    return exit_ok;
  }

  int load() {
    const std::vector<char> bytes = read_file(command_.file);
    const Reply reply = client_.load(std::as_bytes(std::span(bytes)), patience_, stop_);
    std::printf("%s\n", reply.error_message.c_str());
    return exit_ok;
  }

  CtlCommand command_;
  Log& log_;
  const std::atomic<bool>& stop_;
  ControlClient client_;
  const milliseconds patience_;
};

int ctl(const CtlCommand& command, Log& log, const std::atomic<bool>& stop) {
  Ctl one(command, log, stop);
  try {
    return one.run();
  } catch (const std::exception& error) {
    if (stop) return exit_interrupted;
    log.error(error.what());
    return exit_failed;
  }
}

}  // namespace

Subcommand add_ctl(CommandLine app) {
  const auto command = std::make_shared<CtlCommand>();
  CommandLine line = app.add_subcommand("ctl", "Control a run: pause, step, change its world, save, ask how it is");
  add_ctl_options(line, *command);
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return ctl(*command, log, stop); }};
}

}  // namespace cohort::tool
