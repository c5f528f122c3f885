#pragma once

#include <array>
#include <cohort/controller.hpp>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace cohort::autopilots {

/// An output of an autopilot and the command channel that it drives.
struct Output {
  std::size_t number = 1;  ///< number of the output, from 1 to `most_outputs`
  std::string channel;     ///< a channel of the robot's commands
  double low = 0.0;        ///< the command where the output is at its least
  double high = 1.0;       ///< the command where it is at its greatest
};

inline constexpr std::size_t most_outputs = 32;

/// How far each output is from its least to its greatest, 0 to 1; nothing where the autopilot does not use it.
using Shares = std::array<std::optional<double>, most_outputs>;

/// Reads `NUMBER=CHANNEL:LOW..HIGH`. Throws std::runtime_error that says what was expected.
Output output_in(const std::string& text);

/// The autopilot whose default output numbers are used: they agree for multicopters, and differ for vehicles that steer
/// by two sides.
enum class Numbering { ardupilot, px4 };

/// Returns the outputs of a model that ships. Throws std::runtime_error if there are none for it.
std::vector<Output> outputs_of(const std::string& model, Numbering numbering);

/// The command channels that outputs drive.
class OutputMap {
 public:
  /// Looks the channels of `outputs` up; without any, of those of the robot's model. Throws std::runtime_error.
  void start(const Start& start, const std::vector<Output>& outputs, Numbering numbering);

  /// Sets commands in proportion to the shares; where there is none, leaves the channel at its neutral value.
  void act(const Shares& shares, Command& command) const;

  const std::vector<Output>& outputs() const { return outputs_; }

 private:
  std::vector<Output> outputs_;
  std::vector<CommandChannel> channels_;
};

}  // namespace cohort::autopilots
