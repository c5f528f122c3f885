#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <thread>
#include <variant>

#include "client_sdk/src/control_client.hpp"
#include "tools/cohort/cli/output_file.hpp"
#include "tools/cohort/cli/shown.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/commands/ctl/ctl_history.hpp"
#include "tools/cohort/commands/ctl/ctl_options.hpp"
#include "tools/cohort/commands/ctl/ctl_status.hpp"

namespace cohort::tool {
namespace {

using std::chrono::milliseconds;
using wire::Operation;
using wire::Reply;
using wire::ResultCode;

constexpr milliseconds for_a_server{5'000};
constexpr milliseconds for_status{2'000};
constexpr milliseconds watch_interval{500};

milliseconds patience_for(const CtlCommand& command) {
  if (command.timeout) return milliseconds(static_cast<std::int64_t>(*command.timeout * 1e3));
  const Operation& operation = command.operation;
  const bool takes_long =
      command.what == CtlCommand::What::load ||
      (command.what == CtlCommand::What::request &&
       (std::holds_alternative<wire::StepSimulation>(operation) ||
        std::holds_alternative<wire::ResetSimulation>(operation) || std::holds_alternative<wire::GoBack>(operation)));
  return takes_long ? for_ever : for_a_reply;
}

std::vector<char> read_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<char> bytes{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in.is_open() || in.bad()) throw std::runtime_error("cannot read " + file.string());
  return bytes;
}

// One call of the command. What it throws is why it failed, unless it was interrupted.
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
    if (!client_.wait_for_server(patience, stop_)) throw no_server();
    switch (command_.what) {
      case CtlCommand::What::request: request(); break;
      case CtlCommand::What::status:
        if (command_.watch) return watch();
        std::fputs(status(2).c_str(), stdout);
        break;
      case CtlCommand::What::history: history(); break;
      case CtlCommand::What::save: save(); break;
      case CtlCommand::What::load: load(); break;
    }
    return exit_ok;
  }

 private:
  std::runtime_error no_server() const {
    const std::uint32_t domain = command_.connection.domain();
    return std::runtime_error(fmt::format(
        "no server that can be controlled is at {}, domain {}. Is one running there, with this --domain? A run that "
        "starts "
        "its own controllers takes a domain of its own unless it is given one{}. 'cohort doctor --server {} --domain "
        "{}' looks "
        "for what is wrong",
        command_.connection.server, domain,
        command_.connection.secure.empty() ? "; one with --secure needs it here too"
                                           : ", and does its folder have this identity",
        command_.connection.server, domain));
  }

  // Of a request that brought none.
  std::runtime_error no_reply() {
    if (client_.server_is_gone()) return std::runtime_error("the server has gone");
    const std::string why = stop_ ? std::string() : why_it_waits();
    return std::runtime_error(
        fmt::format("it was not done within {:g} s{}", 1e-3 * static_cast<double>(patience_.count()),
                    why.empty() ? ": the server does not answer" : ", and will be at the next tick: " + why));
  }

  Reply ask(const Operation& operation) {
    if (auto reply = client_.ask(operation, patience_, stop_)) return std::move(*reply);
    throw no_reply();
  }

  // The same, and the request was done.
  template <class One>
  typename One::Returned ask_and_get(const One& operation) {
    const Reply reply = ask(operation);
    const auto* const returned = reply.get<typename One::Returned>();
    if (reply.result != ResultCode::ok || returned == nullptr) throw std::runtime_error(reply.error_message);
    return *returned;
  }

  // What is asked for waits for a boundary, and that for the controllers.
  std::string why_it_waits() {
    const auto reply = client_.ask(wire::GetStatus{}, for_status, stop_);
    const auto* const returned = reply ? reply->get<wire::SimulationStatus>() : nullptr;
    if (returned == nullptr) return {};
    const wire::SimulationStatus& status = *returned;
    if (status.awaited.empty()) return fmt::format("the run is {}", word_of(reply->state));
    std::string text = fmt::format("the run waits for {}", status.awaited.front());
    if (status.awaited_count > 1) text += fmt::format(" and {} more", status.awaited_count - 1);
    for (const wire::ControllerStatus& each : status.controllers)
      if (each.awaited) return text + ": " + each.label;
    return text;
  }

  void request() {
    if (auto* spawn = std::get_if<wire::SpawnEntity>(&command_.operation)) take_model(*spawn);
    const auto* const set = std::get_if<wire::SetSimulationState>(&command_.operation);
    const bool quits = set != nullptr && set->state == wire::SimulationState::quitting;
    const auto reply = client_.ask(command_.operation, patience_, stop_);
    if (!reply && quits && client_.server_is_gone()) return;  // with its last words
    if (!reply) throw no_reply();
    if (!reply->is_done()) throw std::runtime_error(reply->error_message);
    if (const auto* names = reply->get<wire::EntityNames>())
      for (const std::string& name : names->entities) std::printf("%s\n", name.c_str());
    else
      std::printf("%s\n", reply->error_message.c_str());
  }

  void take_model(wire::SpawnEntity& spawn) const {
    if (!std::filesystem::is_regular_file(command_.model)) {
      spawn.uri = command_.model.string();
      return;
    }
    const std::vector<char> text = read_file(command_.model);
    spawn.resource_string.assign(text.begin(), text.end());
  }

  std::string status(int indent) {
    const Reply reply = ask(wire::GetStatus{});
    return command_.json ? status_json(reply, indent) : status_text(reply);
  }

  int watch() {
    const bool is_terminal = ::isatty(STDOUT_FILENO) == 1;
    while (!stop_) {
      const auto next = std::chrono::steady_clock::now() + watch_interval;
      std::string text;
      try {
        text = status(-1);
      } catch (const std::exception&) {
        if (!client_.server_is_gone() || stop_) throw;
        log_.notice("the server has gone");
        return exit_ok;
      }
      std::printf("%s%s%s", is_terminal && !command_.json ? "\033[H\033[2J" : "", text.c_str(),
                  is_terminal || command_.json ? "" : "\n");
      std::fflush(stdout);
      while (!stop_ && std::chrono::steady_clock::now() < next) std::this_thread::sleep_for(milliseconds(20));
    }
    return exit_interrupted;
  }

  void history() {
    const wire::SimulationStatus status = ask_and_get(wire::GetStatus{});
    messages::RunHistory all;
    wire::GetHistory question;
    for (bool is_complete = false; !is_complete;) {
      const wire::HistoryPart part = ask_and_get(question);
      add(all, messages::decode<messages::RunHistory>(std::as_bytes(std::span(part.data))));
      is_complete = part.revision == question.revision || part.revision >= part.newest;
      question.revision = part.revision;
    }
    const std::chrono::nanoseconds step(status.step_ns);
    show(command_.json ? history_json(all, step) : history_text(all, step));
  }

  void save() {
    check_writable("the snapshot", command_.file);
    const auto [bytes, text] = client_.save(patience_, stop_);
    write_file("the snapshot", command_.file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    std::printf("%s: %zu bytes, %s\n", command_.file.c_str(), bytes.size(), text.c_str());
  }

  void load() {
    const std::vector<char> bytes = read_file(command_.file);
    const Reply reply = client_.load(std::as_bytes(std::span(bytes)), patience_, stop_);
    std::printf("%s\n", reply.error_message.c_str());
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
    log.error(text_of(error));
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
