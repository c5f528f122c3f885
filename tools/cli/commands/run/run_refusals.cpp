// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/run/run_refusals.hpp"

#include <stdexcept>
#include <string>

#include "server/description/input_error.hpp"
#include "tools/cli/running/keyboard.hpp"
#include "tools/cli/running/run_recording.hpp"

namespace cohort::tool {

void refuse_keyboard(const description::Experiment& experiment) {
  for (const description::Team& team : experiment.teams)
    if (team.controller == keyboard_controller)
      throw description::InputError({{experiment.file, team.controller_line, "team " + team.name,
                                      "controller 'keyboard' cannot be used with '--controllers inprocess'"}});
}

void check_rosbag2(const RunCommand& command, std::size_t runs) {
  if (command.outputs.recording.empty()) throw std::invalid_argument("'--record-rosbag2' needs '--record FILE'");
  if (runs > 1)
    throw std::invalid_argument(
        "'--record-rosbag2' cannot be used with several runs, because their recordings share a folder; move each "
        "recording to its own folder and use 'cohort recordings rosbag2'");
  check_rosbag2_metadata(command.outputs.recording);
}

void refuse_what_needs_a_server(const RunCommand& command) {
  const auto refuse = [](const std::string& option) {
    throw std::invalid_argument("'" + option + "' cannot be used with '--controllers inprocess'");
  };
  if (command.paused) refuse("--paused");
  if (command.keep_interval > 0.0) refuse("--keep-snapshots");
  if (command.view) refuse("--view");
  if (command.ros2) refuse("--ros2");
}

void refuse_rewind_without_snapshots(const RunCommand& command, const description::Experiment& experiment) {
  if (command.keep_interval > 0.0) return;
  for (const description::Team& team : experiment.teams)
    if (team.policy.on_lost == description::OnLost::rewind)
      throw description::InputError(
          {{experiment.file, 0, "team " + team.name,
            "'on_lost: rewind' requires snapshots; '--keep-snapshots 10' keeps one every 10 s"}});
}

}  // namespace cohort::tool
