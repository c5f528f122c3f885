// SPDX-License-Identifier: Apache-2.0

// Sends constant values to the command channels that the experiment names.
//
//   controller: constant
//   parameters:
//     treel/left/velocity: 0.1
//     treel/right/velocity: 0.12

#include <cohort/controller.hpp>
#include <string>
#include <vector>

namespace {

// Returns a command channel; reports an unknown one as an error of the parameter that names it.
cohort::CommandChannel command_named(const cohort::Start& start, const std::string& name) {
  try {
    return start.command(name);
  } catch (const cohort::ChannelError& error) {
    throw cohort::ParameterError(name, error.what());
  }
}

class Constant final : public cohort::StatelessController {
 public:
  void start(const cohort::Start& start) override {
    settings_.clear();
    for (const cohort::Parameter& parameter : start.parameters.all()) {
      const cohort::CommandChannel channel = command_named(start, parameter.name);
      const std::vector<double> values = start.parameters.reals(parameter.name);
      if (values.size() != channel.size)
        throw cohort::ParameterError(parameter.name, "expected " + std::to_string(channel.size) + " values, not " +
                                                         std::to_string(values.size()));
      for (const double value : values)
        if (value < channel.lower || value > channel.upper)
          throw cohort::ParameterError(parameter.name, "expected at least " + std::to_string(channel.lower) +
                                                           " and at most " + std::to_string(channel.upper) + ", not " +
                                                           std::to_string(value));
      settings_.push_back({channel, values});
    }
  }

  void step(const cohort::Observation&, cohort::Command& command) override {
    for (const Setting& setting : settings_)
      for (std::size_t i = 0; i < setting.values.size(); ++i) command.set(setting.channel, setting.values[i], i);
  }

 private:
  struct Setting {
    cohort::CommandChannel channel;
    std::vector<double> values;
  };
  std::vector<Setting> settings_;
};

}  // namespace

COHORT_CONTROLLER(Constant)
