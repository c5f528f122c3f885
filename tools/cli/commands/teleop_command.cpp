// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <future>
#include <memory>
#include <thread>

#include "client_sdk/include/cohort/control.hpp"
#include "client_sdk/src/attachment.hpp"
#include "idl/text/domains.hpp"
#include "server/messages/experiment_inputs.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/terminal/key_reader.hpp"
#include "tools/cli/running/keyboard.hpp"

namespace cohort::tool {
namespace {

constexpr std::chrono::milliseconds display_interval{200};

std::string help_of(const std::vector<KeyBinding>& bindings) {
  std::string text;
  for (const KeyBinding& binding : bindings) {
    text += fmt::format("  {:<6}", binding.key);
    for (const KeyBinding::Setting& setting : binding.settings)
      text += fmt::format(" {} = {:g} ", setting.channel, setting.value);
    text += "\n";
  }
  return text + "  space  release all keys\n  + -    increase or reduce the speed\n  q      quit";
}

std::string status_of(const Keyboard& keyboard) {
  const Keyboard::State state = keyboard.state();
  std::string keys;
  for (const std::string& key : state.keys) keys += (keys.empty() ? "" : " ") + key;
  return fmt::format("{:8.2f} s simulated   {:3.0f} %   {}", std::chrono::duration<double>(keyboard.time()).count(),
                     100.0 * state.share, keys.empty() ? "no key" : keys);
}

// The keys and the display beside the client. Sets `leave` for `q` and when `stop` is set.
class Console {
 public:
  Console(Keyboard& keyboard, Log& log, const std::atomic<bool>& stop, std::atomic<bool>& leave)
      : keyboard_(keyboard), log_(log), stop_(stop), leave_(leave) {
    // Keys that are already typed take effect from the first tick on.
    while (const auto key = keys_.read(std::chrono::milliseconds(0))) heed(*key);
    thread_ = std::thread([this] { run(); });
  }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console() {
    done_ = true;
    thread_.join();
  }

 private:
  void heed(const std::string& key) {
    if (key == "q")
      leave_ = true;
    else
      keyboard_.press(key);
  }

  void run() {
    bool explained = false;
    while (!done_) {
      const auto key = keys_.read(display_interval);
      if (stop_) leave_ = true;
      if (key) heed(*key);
      const auto bindings = keyboard_.bindings();
      if (bindings.empty()) continue;
      if (!explained) log_.notice(help_of(bindings));
      explained = true;
      if (log_.rewrites_progress()) log_.progress(status_of(keyboard_));
    }
  }

  Keyboard& keyboard_;
  Log& log_;
  const std::atomic<bool>& stop_;
  std::atomic<bool>& leave_;
  KeyReader keys_;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

// The models of the server's experiment. Requests and reads them on a thread of its own.
class ModelsOfRun {
 public:
  explicit ModelsOfRun(const ControlOptions& options)
      : read_(std::async(std::launch::async, [this, options] { return read(options); })) {}
  ModelsOfRun(const ModelsOfRun&) = delete;
  ModelsOfRun& operator=(const ModelsOfRun&) = delete;
  ~ModelsOfRun() { leave_ = true; }

  // An identity without the right to control gets no models, and a robot that was added may have another one. Their
  // channels then say how they are driven.
  std::vector<description::DriveChannel> drive_of(const Start& start) {
    if (read_.wait_until(deadline_) != std::future_status::ready) return drive_without_model(start);
    const auto model = std::ranges::find(read_.get(), start.model, &description::Model::name);
    return model == read_.get().end() ? drive_without_model(start) : description::ground_drive(*model);
  }

 private:
  description::Models read(const ControlOptions& options) const {
    try {
      Control control(options);
      control.stop_on(&leave_);
      control.set_time_limit(for_ever);
      const ExperimentFiles files = control.experiment_files();
      return parsing::read_experiment(std::make_shared<const description::KeptFiles>(messages::kept_files(files)),
                                      files.seed, files.duration)
          .world.models;
    } catch (const std::exception&) {
      return {};
    }
  }

  // For the server's answer: all robots together wait until then at most.
  const std::chrono::steady_clock::time_point deadline_ = std::chrono::steady_clock::now() + std::chrono::seconds(3);
  std::atomic<bool> leave_ = false;
  std::shared_future<description::Models> read_;
};

int teleop(const ClientSide& client, Log& log, const std::atomic<bool>& stop) {
  Keyboard keyboard;
  std::atomic<bool> leave = false;
  ClientOptions options;
  options.server = client.connection.server;
  if (!client.connection.domains.empty()) options.domain = domain_of_this_process(client.connection.domains);
  options.secure = client.connection.secure;
  options.robots = client.robots;
  options.name = "teleop";
  options.tell = [&](Severity severity, const std::string& text) {
    if (leave && !stop) return;  // the user has quit on purpose
    log.write(level_of(severity), text);
  };
  const Console console(keyboard, log, stop, leave);
  ModelsOfRun models({options.server, options.domain, options.secure, options.name});
  const FindDrive find_drive = [&](const Start& start) { return models.drive_of(start); };
  switch (run_client(keyboard_controllers(keyboard, find_drive), options, leave)) {
    case ClientEnd::finished: return exit_ok;
    case ClientEnd::interrupted: return stop ? exit_interrupted : exit_ok;
    case ClientEnd::refused: return exit_usage;
    case ClientEnd::superseded:
    case ClientEnd::failed:
    case ClientEnd::server_lost: break;
  }
  return exit_failed;
}

}  // namespace

Subcommand add_teleop(CommandLine app) {
  const auto client = std::make_shared<ClientSide>();
  CommandLine line = app.add_subcommand("teleop", "Drive robots of a server with the keyboard");
  add_client_options(line, *client);
  line.footer("Example: cohort teleop --robots 0");
  return {line, [client](Log& log, const std::atomic<bool>& stop) { return teleop(*client, log, stop); }};
}

}  // namespace cohort::tool
