#include <fmt/format.h>

#include <thread>

#include "client_sdk/src/attachment.hpp"
#include "client_sdk/src/domains.hpp"
#include "tools/cohort/cli/terminal/key_reader.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/commands/shared_options.hpp"
#include "tools/cohort/running/keyboard.hpp"

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
  switch (run_client(keyboard_controllers(keyboard), options, leave)) {
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
