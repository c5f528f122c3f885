// A Braitenberg vehicle ("Vehicles: Experiments in Synthetic Psychology", 1984; thesis, section 5.2): every command is
// a weighted sum of what the robot senses, brought into the range of its channel. The experiment gives the weights:
//
//   controller: braitenberg
//   parameters:
//     treel/left/velocity:            # a command channel
//       bias: 0.2                     # what it is when nothing is sensed; 0 if absent
//       proximity/0/reading: -0.1     # weight of an observation channel
//       proximity/*/reading: [...]    # weights of all that match, in their order; one number: the same for each
// A command channel of several values gets the same sum for each.
//
// Units: those of the command channel for a bias, the command's over the observation's for a weight.

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
  std::size_t index;  // in the channel
  double weight;
};

struct Output {
  std::string name;
  cohort::CommandChannel channel;
  double bias = 0.0;
  std::vector<Input> inputs;
};

// The command channel whose settings a parameter belongs to. Channels may have a '.' in their names.
std::string command_of(const cohort::Start& start, const std::string& parameter) {
  for (const cohort::ChannelInfo& channel : start.command_channels)
    if (parameter.starts_with(channel.name + ".")) return channel.name;
  const std::string unknown = parameter.substr(0, parameter.find('.'));
  start.command(unknown);  // throws, and names the nearest ones, unless a channel stands there without a sensor
  throw cohort::ParameterError(parameter,
                               "expected 'bias' and weights of observation channels under '" + unknown + "'");
}

class Braitenberg final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    outputs_.clear();
    for (const cohort::Parameter& parameter : start.parameters.all()) {
      try {
        add(start, parameter.name);
      } catch (const cohort::ChannelError& error) {  // a mistake of the parameter that names the channel
        throw cohort::ParameterError(parameter.name, error.what());
      }
    }
    if (outputs_.empty()) throw std::runtime_error("braitenberg needs parameters: the weights of the commands");
  }

  void step(const cohort::Observation& observation, cohort::Command& command) override {
    for (const Output& output : outputs_) {
      double sum = output.bias;
      for (const Input& input : output.inputs) sum += input.weight * observation.values(input.channel)[input.index];
      for (std::size_t i = 0; i < output.channel.size; ++i) command.set(output.channel, sum, i);
    }
  }

  void save(cohort::StateWriter&) const override {}  // it remembers nothing

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
                                                  ", one for each value that matches, not " +
                                                  std::to_string(weights.size()));
    for (std::size_t i = 0; i < inputs.size(); ++i) inputs[i].weight = weights[weights.size() == 1 ? 0 : i];
    outputs_.back().inputs.insert(outputs_.back().inputs.end(), inputs.begin(), inputs.end());
  }

  std::vector<Output> outputs_;
};

}  // namespace

COHORT_CONTROLLER(Braitenberg)
