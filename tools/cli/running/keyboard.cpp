// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/keyboard.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

namespace cohort::tool {
namespace {

constexpr std::array<std::string_view, 4> arrows = {"up", "down", "left", "right"};
constexpr std::array<std::pair<const char*, const char*>, 8> letter_pairs = {
    {{"r", "f"}, {"t", "g"}, {"y", "h"}, {"u", "j"}, {"i", "k"}, {"o", "l"}, {"a", "z"}, {"s", "x"}}};
constexpr std::string_view reserved = "+-q ";
constexpr double share_step = 0.1;
constexpr double turning_share = 0.5;  // fraction of full speed for turning on the spot

bool is_key(const std::string& key) {
  if (std::ranges::find(arrows, key) != arrows.end()) return true;
  return key.size() == 1 && reserved.find(key) == std::string_view::npos && key[0] > ' ' && key[0] <= '~';
}

// Returns the channel of a name; reports an unknown channel as an error of the parameter that names it.
CommandChannel command_named(const Start& start, const std::string& name, const std::string& parameter) {
  try {
    return start.command(name);
  } catch (const ChannelError& error) {
    throw ParameterError(parameter, error.what());
  }
}

std::vector<KeyBinding> bindings_of(const Start& start) {
  std::vector<KeyBinding> bindings;
  for (const Parameter& parameter : start.parameters.all()) {
    const std::string key = parameter.name.substr(0, parameter.name.find('.'));
    if (key == parameter.name) throw ParameterError(parameter.name, "expected 'CHANNEL: VALUE' under a key");
    if (!is_key(key))
      throw ParameterError(parameter.name, "'" + key + "' is not a valid key; expected up, down, left, right or a " +
                                               "character other than +, - and q");
    const std::string name = parameter.name.substr(key.size() + 1);
    const CommandChannel channel = command_named(start, name, parameter.name);
    const double value = start.parameters.real(parameter.name);
    if (value < channel.lower || value > channel.upper)
      throw ParameterError(parameter.name, "expected at least " + std::to_string(channel.lower) + " and at most " +
                                               std::to_string(channel.upper));
    if (bindings.empty() || bindings.back().key != key) bindings.push_back({key, {}});
    bindings.back().settings.push_back({name, value});
  }
  return bindings;
}

// Returns the settings of a share of full speed forward and of a share of full speed counter-clockwise.
std::vector<KeyBinding::Setting> settings_of(const std::vector<description::DriveChannel>& drive, double ahead,
                                             double turn) {
  std::vector<KeyBinding::Setting> settings;
  for (const auto& each : drive) settings.push_back({each.channel, ahead * each.ahead + turn * each.turn});
  return settings;
}

std::vector<KeyBinding> usual_bindings(const Start& start, const std::vector<description::DriveChannel>& drive) {
  std::vector<KeyBinding> bindings;
  if (!drive.empty()) {
    // If turning has a channel of its own, a robot that turns keeps its speed, and drives a curve.
    auto turning = drive;
    if (std::ranges::none_of(drive, [](const auto& each) { return each.ahead != 0.0 && each.turn != 0.0; }))
      std::erase_if(turning, [](const auto& each) { return each.turn == 0.0; });
    bindings = {{"up", settings_of(drive, 1.0, 0.0)},
                {"down", settings_of(drive, -1.0, 0.0)},
                {"left", settings_of(turning, 0.0, turning_share)},
                {"right", settings_of(turning, 0.0, -turning_share)}};
  }
  std::size_t pair = 0;
  for (const ChannelInfo& channel : start.command_channels) {
    if (std::ranges::find(drive, channel.name, &description::DriveChannel::channel) != drive.end()) continue;
    if (!std::isfinite(channel.lower) || !std::isfinite(channel.upper) || pair == letter_pairs.size()) continue;
    bindings.push_back({letter_pairs[pair].first, {{channel.name, channel.upper}}});
    bindings.push_back({letter_pairs[pair].second, {{channel.name, channel.lower}}});
    ++pair;
  }
  return bindings;
}

class KeyboardController final : public Controller {
 public:
  KeyboardController(Keyboard* keyboard, FindDrive find_drive)
      : keyboard_(keyboard), find_drive_(std::move(find_drive)) {}

  void start(const Start& start) override {
    bindings_.clear();
    std::vector<KeyBinding> bindings = key_bindings(start, find_drive_(start));
    for (const KeyBinding& binding : bindings) {
      Resolved& resolved = bindings_.emplace_back(Resolved{binding.key, {}});
      for (const KeyBinding::Setting& setting : binding.settings) {
        const auto info = std::ranges::find(start.command_channels, setting.channel, &ChannelInfo::name);
        resolved.settings.push_back({start.command(setting.channel), info->neutral, setting.value});
      }
    }
    if (keyboard_ != nullptr) keyboard_->set_bindings(std::move(bindings));
  }

  void step(const Observation& observation, Command& command) override {
    if (keyboard_ == nullptr) return;
    keyboard_->set_time(observation.time());
    const Keyboard::State state = keyboard_->state();
    for (const std::string& key : state.keys) {
      const auto binding = std::ranges::find(bindings_, key, &Resolved::key);
      if (binding == bindings_.end()) continue;
      for (const Setting& setting : binding->settings)
        for (std::size_t i = 0; i < setting.channel.size; ++i)
          command.set(setting.channel, setting.neutral + state.share * (setting.value - setting.neutral), i);
    }
  }

  void save(StateWriter&) const override {}  // the keyboard stores the keys that are held

 private:
  struct Setting {
    CommandChannel channel;
    double neutral;
    double value;
  };
  struct Resolved {
    std::string key;
    std::vector<Setting> settings;
  };

  Keyboard* keyboard_;
  FindDrive find_drive_;
  std::vector<Resolved> bindings_;
};

OwnedController make_controller(Keyboard* keyboard, const FindDrive& find_drive) {
  return {new KeyboardController(keyboard, find_drive), [](Controller* controller) { delete controller; }};
}

}  // namespace

std::vector<description::DriveChannel> drive_without_model(const Start& start) {
  const auto limit = [&](const std::string& name) -> std::optional<double> {
    const auto channel = std::ranges::find(start.command_channels, name, &ChannelInfo::name);
    if (channel == start.command_channels.end()) return std::nullopt;
    return std::isfinite(channel->upper) ? channel->upper : 1.0;
  };
  for (const ChannelInfo& channel : start.command_channels) {
    const std::string device = channel.name.substr(0, channel.name.find('/'));
    const std::string linear = device + "/0/linear";
    const std::string angular = device + "/0/angular";
    if (limit(linear) && limit(angular)) return {{linear, *limit(linear), 0.0}, {angular, 0.0, *limit(angular)}};
    const std::string left = device + "/left/velocity";
    const std::string right = device + "/right/velocity";
    if (!limit(left) || !limit(right)) continue;
    const double speed = std::min(*limit(left), *limit(right));
    return {{left, speed, -speed}, {right, speed, speed}};
  }
  return {};
}

std::vector<KeyBinding> key_bindings(const Start& start, const std::vector<description::DriveChannel>& drive) {
  const bool is_bound = start.controller == keyboard_controller && !start.parameters.all().empty();
  if (is_bound) return bindings_of(start);
  // The parameters belong to another controller: mark them as used.
  for (const Parameter& parameter : start.parameters.all()) start.parameters.has(parameter.name);
  return usual_bindings(start, drive);
}

void Keyboard::press(const std::string& key) {
  const std::lock_guard lock(mutex_);
  if (key == "space") {
    state_.keys.clear();
  } else if (key == "+" || key == "-") {
    const double tenths = std::round(state_.share / share_step) + (key == "+" ? 1.0 : -1.0);
    state_.share = std::clamp(tenths * share_step, share_step, 1.0);
  } else if (is_key(key)) {
    std::erase(state_.keys, key);
    state_.keys.push_back(key);
  }
}

Keyboard::State Keyboard::state() const {
  const std::lock_guard lock(mutex_);
  return state_;
}

void Keyboard::set_bindings(std::vector<KeyBinding> bindings) {
  const std::lock_guard lock(mutex_);
  bindings_ = std::move(bindings);
}

std::vector<KeyBinding> Keyboard::bindings() const {
  const std::lock_guard lock(mutex_);
  return bindings_;
}

void Keyboard::set_time(std::chrono::nanoseconds time) {
  const std::lock_guard lock(mutex_);
  time_ = time;
}

std::chrono::nanoseconds Keyboard::time() const {
  const std::lock_guard lock(mutex_);
  return time_;
}

ControllerKind keyboard_controllers(Keyboard& keyboard, FindDrive find_drive) {
  return {keyboard_controller, [&keyboard, find = std::move(find_drive)] { return make_controller(&keyboard, find); }};
}

OwnedController keyboard_controller_without_keys() { return make_controller(nullptr, drive_without_model); }

}  // namespace cohort::tool
