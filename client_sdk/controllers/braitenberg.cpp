// SPDX-License-Identifier: Apache-2.0

// A Braitenberg vehicle ("Vehicles: Experiments in Synthetic Psychology", 1984; thesis, section 5.2): every command is
// a weighted sum of the robot's observations, clamped to the range of its channel. The experiment defines the weights:
//
//   controller: braitenberg
//   parameters:
//     treel/left/velocity:            # a command channel
//       bias: 0.2                     # default: 0
//       proximity/0/reading: -0.1     # weight of an observation channel
//       proximity/*/reading: [...]    # weights of all matches in order, or one for all
//
// The bias is the value of the command if nothing is sensed. A command channel with several values gets the same sum
// for each.
//
// Units: a bias has the unit of the command channel; a weight, that of the command over that of the observation.

#include <cohort/controller.hpp>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr std::string_view bias = "bias";

struct Input {
  cohort::ObservationChannel channel;
  std::size_t index;  // index of the value in the channel
  double weight;
};

struct Output {
  std::string name;
  cohort::CommandChannel channel;
  double bias = 0.0;
  std::vector<Input> inputs;
};

// Returns the command channel that a parameter configures. Channel names may contain a '.'.
std::string command_of(const cohort::Start& start, const std::string& parameter) {
  for (const cohort::ChannelInfo& channel : start.command_channels)
    if (parameter.starts_with(channel.name + ".")) return channel.name;
  const std::string unknown = parameter.substr(0, parameter.find('.'));
  start.command(unknown);  // throws with the nearest names, unless it is a channel without a sensor
  throw cohort::ParameterError(parameter,
                               "expected 'bias' and weights of observation channels under '" + unknown + "'");
}

class Braitenberg final : public cohort::StatelessController {
 public:
  void start(const cohort::Start& start) override {
    outputs_.clear();
    for (const cohort::Parameter& parameter : start.parameters.all()) {
      try {
        add(start, parameter.name);
      } catch (const cohort::ChannelError& error) {  // an error of the parameter that names the channel
        throw cohort::ParameterError(parameter.name, error.what());
      }
    }
    if (outputs_.empty())
      throw std::runtime_error("braitenberg: no parameters given; expected the weights of the commands");
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    for (const Output& output : outputs_) {
      double sum = output.bias;
      for (const Input& input : output.inputs) sum += input.weight * observation.values(input.channel)[input.index];
      for (std::size_t i = 0; i < output.channel.size; ++i) command.set(output.channel, sum, i);
    }
  }

 private:
  void add(const cohort::Start& start, const std::string& parameter) {
    const std::string command = command_of(start, parameter);
    if (outputs_.empty() || outputs_.back().name != command)
      outputs_.push_back({command, start.command(command), 0.0, {}});
    const std::string input = parameter.substr(command.size() + 1);
    if (input == bias)
      outputs_.back().bias = start.parameters.real(parameter);
    else
      add_inputs(start, parameter, input);
  }

  void add_inputs(const cohort::Start& start, const std::string& parameter, const std::string& pattern) {
    std::vector<Input> inputs;
    for (const cohort::ObservationChannel channel : start.observations(pattern))
      for (std::size_t i = 0; i < channel.size; ++i) inputs.push_back({channel, i, 0.0});
    const std::vector<double> weights = start.parameters.reals(parameter);
    if (weights.size() != 1 && weights.size() != inputs.size())
      throw cohort::ParameterError(parameter, "expected one weight or " + std::to_string(inputs.size()) +
                                                  ", one per matching value, not " + std::to_string(weights.size()));
    for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].weight = weights[weights.size() == 1 ? 0 : i];
    outputs_.back().inputs.insert(outputs_.back().inputs.end(), inputs.begin(), inputs.end());
  }

  std::vector<Output> outputs_;
};

}  // namespace

COHORT_CONTROLLER(Braitenberg)
