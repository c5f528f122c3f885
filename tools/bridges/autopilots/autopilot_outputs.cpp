// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/autopilots/autopilot_outputs.hpp"

#include <charconv>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string_view>

namespace cohort::autopilots {
namespace {

using OutputsOfModels = std::map<std::string, std::vector<Output>>;

// docs/bridges/ardupilot.md and px4.md have the source of the order.
const OutputsOfModels& shipped_outputs(Numbering numbering) {
  static const OutputsOfModels copters = {
      {"quadcopter",
       {{1, "right/0/velocity", 0, 838},
        {2, "left/0/velocity", 0, 838},
        {3, "front/0/velocity", 0, 838},
        {4, "back/0/velocity", 0, 838}}},
      {"quadcopter_x",
       {{1, "front_right/0/velocity", 0, 838},
        {2, "rear_left/0/velocity", 0, 838},
        {3, "front_left/0/velocity", 0, 838},
        {4, "rear_right/0/velocity", 0, 838}}},
  };
  static const auto with_copters = [](OutputsOfModels others) {
    others.insert(copters.begin(), copters.end());
    return others;
  };
  static const OutputsOfModels ardupilot = with_copters({
      {"rover", {{1, "left_wheel/0/velocity", -8, 8}, {3, "right_wheel/0/velocity", -8, 8}}},
      {"boat", {{1, "left_thruster/0/velocity", -150, 150}, {3, "right_thruster/0/velocity", -150, 150}}},
  });
  static const OutputsOfModels px4 = with_copters({
      {"rover", {{1, "right_wheel/0/velocity", -8, 8}, {2, "left_wheel/0/velocity", -8, 8}}},
      {"boat", {{1, "right_thruster/0/velocity", -150, 150}, {2, "left_thruster/0/velocity", -150, 150}}},
  });
  return numbering == Numbering::ardupilot ? ardupilot : px4;
}

template <class Number>
std::optional<Number> number_in(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return number;
}

}  // namespace

Output output_in(const std::string& text) {
  const auto refuse = [&](const std::string& why) {
    return std::runtime_error("--output '" + text + "': " + why +
                              ": expected NUMBER=CHANNEL:LOW..HIGH, such as 1=front/0/velocity:0..838");
  };
  const auto equals = text.find('=');
  const auto colon = text.rfind(':');
  if (equals == std::string::npos || colon == std::string::npos || colon < equals) throw refuse("not an output");
  const auto dots = text.find("..", colon);
  if (dots == std::string::npos) throw refuse("has no range");
  const std::string_view all = text;
  const auto number = number_in<std::size_t>(all.substr(0, equals));
  if (!number || *number < 1 || *number > most_outputs) throw refuse("the output number must be from 1 to 32");
  const auto low = number_in<double>(all.substr(colon + 1, dots - colon - 1));
  const auto high = number_in<double>(all.substr(dots + 2));
  if (!low || !high || !std::isfinite(*low) || !std::isfinite(*high))
    throw refuse("the limits of the range are not finite numbers");
  return {*number, text.substr(equals + 1, colon - equals - 1), *low, *high};
}

std::vector<Output> outputs_of(const std::string& model, Numbering numbering) {
  const OutputsOfModels& shipped = shipped_outputs(numbering);
  const auto found = shipped.find(model);
  if (found != shipped.end()) return found->second;
  std::string known;
  for (const auto& [name, outputs] : shipped) known += (known.empty() ? "" : ", ") + name;
  throw std::runtime_error("the model '" + model + "' has no predefined outputs (models that have them: " + known +
                           "): specify each output with --output NUMBER=CHANNEL:LOW..HIGH");
}

void OutputMap::start(const Start& start, const std::vector<Output>& outputs, Numbering numbering) {
  outputs_ = outputs.empty() ? outputs_of(start.model, numbering) : outputs;
  channels_.clear();
  for (const Output& output : outputs_) channels_.push_back(start.command(output.channel));
}

void OutputMap::act(const Shares& shares, Command& command) const {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    const Output& output = outputs_[i];
    if (const auto& share = shares[output.number - 1])
      command.set(channels_[i], output.low + *share * (output.high - output.low));
  }
}

}  // namespace cohort::autopilots
