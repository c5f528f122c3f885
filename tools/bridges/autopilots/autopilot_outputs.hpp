// SPDX-License-Identifier: Apache-2.0
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
  double low = 0.0;        ///< command at the output's minimum
  double high = 1.0;       ///< command at the output's maximum
};

inline constexpr std::size_t most_outputs = 32;

/// The value of each output, from 0 (minimum) to 1 (maximum); nullopt for an output that the autopilot does not use.
using Shares = std::array<std::optional<double>, most_outputs>;

/// Reads `NUMBER=CHANNEL:LOW..HIGH`. Throws std::runtime_error that says what was expected.
Output output_in(const std::string& text);

/// The autopilot whose default output numbers are used. The numbers are the same for multicopters, and differ for
/// vehicles with skid steering.
enum class Numbering { ardupilot, px4 };

/// Returns the default outputs of a model that is shipped with Cohort. Throws std::runtime_error if it has none.
std::vector<Output> outputs_of(const std::string& model, Numbering numbering);

/// The command channels that outputs drive.
class OutputMap {
 public:
  /// Looks up the channels of `outputs`, or of the outputs of the robot's model if `outputs` is empty. Throws
  /// std::runtime_error.
  void start(const Start& start, const std::vector<Output>& outputs, Numbering numbering);

  /// Sets commands in proportion to the shares. Leaves a channel at its neutral value if its output has no share.
  void act(const Shares& shares, Command& command) const;

  const std::vector<Output>& outputs() const { return outputs_; }

 private:
  std::vector<Output> outputs_;
  std::vector<CommandChannel> channels_;
};

}  // namespace cohort::autopilots
