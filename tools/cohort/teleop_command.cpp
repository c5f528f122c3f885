#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <thread>

#include "client_sdk/src/client.hpp"
#include "tools/cohort/commands.hpp"
#include "tools/cohort/key_reader.hpp"
#include "tools/cohort/keyboard.hpp"

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
  return text + "  space  let all go\n  + -    more or less of it\n  q      leave\n";
}

std::string status_of(const Keyboard& keyboard) {
  const Keyboard::State state = keyboard.state();
  std::string keys;
  for (const std::string& key : state.keys) keys += (keys.empty() ? "" : " ") + key;
  return fmt::format("{:8.2f} s simulated   {:3.0f} %   {}", std::chrono::duration<double>(keyboard.time()).count(),
                     100.0 * state.share, keys.empty() ? "no key" : keys);
}

// What the person sees and does, beside the client. Sets `leave` for `q` and when `stop` is set.
class Console {
 public:
  Console(Keyboard& keyboard, const std::atomic<bool>& stop, std::atomic<bool>& leave)
      : keyboard_(keyboard), stop_(stop), leave_(leave) {
    // What is there already counts from the first tick on.
    while (const auto key = keys_.read(std::chrono::milliseconds(0))) keyboard_.press(*key);
    thread_ = std::thread([this] { run(); });
  }
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;
  ~Console() {
    done_ = true;
    thread_.join();
    if (in_place_) std::fputs("\n", stderr);
  }

 private:
  void run() {
    bool explained = false;
    while (!done_) {
      const auto key = keys_.read(display_interval);
      if (stop_ || key == "q") leave_ = true;
      if (key) keyboard_.press(*key);
      const auto bindings = keyboard_.bindings();
      if (bindings.empty()) continue;
      if (!explained) std::fputs(help_of(bindings).c_str(), stderr);
      explained = true;
      if (in_place_) std::fprintf(stderr, "\r\033[K%s", status_of(keyboard_).c_str());
    }
  }

  Keyboard& keyboard_;
  const std::atomic<bool>& stop_;
  std::atomic<bool>& leave_;
  KeyReader keys_;
  const bool in_place_ = isatty(STDERR_FILENO) != 0;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

}  // namespace

int teleop(const TeleopCommand& command, const std::atomic<bool>& stop) {
  try {
    Keyboard keyboard;
    std::atomic<bool> leave = false;
    ClientOptions options;
    options.server = command.server;
    options.domain = command.domain;
    options.robots = command.robots;
    options.name = "teleop";
    const Console console(keyboard, stop, leave);
    switch (run_client(keyboard_controllers(keyboard), options, leave)) {
      case ClientEnd::finished: return exit_ok;
      case ClientEnd::interrupted: return stop ? exit_interrupted : exit_ok;
      case ClientEnd::refused: return exit_usage;
      case ClientEnd::superseded:
      case ClientEnd::failed:
      case ClientEnd::server_lost: break;
    }
    return exit_failed;
  } catch (const std::exception& error) {
    std::cerr << "cohort teleop: " << error.what() << "\n";
    return exit_usage;
  }
}

}  // namespace cohort::tool
