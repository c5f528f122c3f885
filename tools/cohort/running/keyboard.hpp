#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"

namespace cohort::tool {

/// The name by which an experiment says that people drive a team.
inline constexpr const char* keyboard_controller = "keyboard";

/// What a key does: it gives channels values, which hold until another key changes them.
struct KeyBinding {
  struct Setting {
    std::string channel;
    double value;
  };
  std::string key;  ///< a character, or up, down, left, right
  std::vector<Setting> settings;
};

/// The bindings that the parameters of a team give (`KEY: {CHANNEL: VALUE}`), or, if the team is not driven by keyboard
/// or has none, the usual ones for the robot's channels: the arrows drive two tracks or wheels (channels that end in
/// `/left/velocity` and `/right/velocity`), pairs of letters move each other channel up and down. Throws
/// ParameterError.
std::vector<KeyBinding> key_bindings(const Start& start);

/// The keys that a person has pressed. Any thread.
class Keyboard {
 public:
  /// A key of a binding; the space bar ("space") lets all go, "+" and "-" change the share of each value that is used.
  void press(const std::string& key);

  struct State {
    std::vector<std::string> keys;  ///< in the order of their last press
    double share = 1.0;
  };
  State state() const;

  /// For display: what the robots can do, and the simulated time.
  void set_bindings(std::vector<KeyBinding> bindings);
  std::vector<KeyBinding> bindings() const;
  void set_time(std::chrono::nanoseconds time);
  std::chrono::nanoseconds time() const;

 private:
  mutable std::mutex mutex_;
  State state_;
  std::vector<KeyBinding> bindings_;
  std::chrono::nanoseconds time_{0};
};

/// Controllers that obey `keyboard`, which must outlive them.
ControllerKind keyboard_controllers(Keyboard& keyboard);
/// One whose keys nobody presses, to check an experiment with.
OwnedController keyboard_controller_without_keys();

}  // namespace cohort::tool
