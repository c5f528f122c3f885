// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "client_sdk/hosting/controller_host.hpp"
#include "server/description/ground_drive.hpp"

namespace cohort::tool {

/// The controller name of teams that a user drives with the keyboard.
inline constexpr const char* keyboard_controller = "keyboard";

/// The effect of a key: it sets channels to values, which hold until another key changes them.
struct KeyBinding {
  struct Setting {
    std::string channel;
    double value;
  };
  std::string key;  ///< a character, or up, down, left, right
  std::vector<Setting> settings;
};

/// Returns the key bindings of a team: those of its parameters (`KEY: {CHANNEL: VALUE}`), or default ones if it has
/// none or is not driven by keyboard. By default, the arrows drive the channels of `drive`, and pairs of letters raise
/// and lower each other channel. Throws ParameterError.
std::vector<KeyBinding> key_bindings(const Start& start, const std::vector<description::DriveChannel>& drive);

/// Returns the channels that drive a robot whose model is unknown: those of a twist (`NAME/0/linear` and
/// `NAME/0/angular`) or of two tracks (`NAME/left/velocity` and `NAME/right/velocity`); otherwise none.
std::vector<description::DriveChannel> drive_without_model(const Start& start);

/// The keys that the user has pressed. Thread-safe.
class Keyboard {
 public:
  /// Processes a key: a key of a binding, "space", which releases all keys, or "+" or "-", which change the `share` of
  /// the bindings' values that is commanded.
  void press(const std::string& key);

  struct State {
    std::vector<std::string> keys;  ///< in the order of their last press
    double share = 1.0;
  };
  State state() const;

  /// The bindings and the simulated time, for display.
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

/// Returns the channels that drive a robot.
using FindDrive = std::function<std::vector<description::DriveChannel>(const Start& start)>;

/// Returns controllers that follow `keyboard`, which must outlive them.
ControllerKind keyboard_controllers(Keyboard& keyboard, FindDrive find_drive = drive_without_model);
/// Returns a keyboard controller without pressed keys, for checking an experiment.
OwnedController keyboard_controller_without_keys();

}  // namespace cohort::tool
