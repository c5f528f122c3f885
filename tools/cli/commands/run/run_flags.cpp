// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/run/run_flags.hpp"

#include <limits>
#include <stdexcept>

#include "server/core/text.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/checks.hpp"
#include "tools/cli/running/seeds.hpp"

namespace cohort::tool {
namespace {

std::vector<std::uint64_t> seeds_or_usage_error(const std::string& text) {
  try {
    return parse_seeds(text);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("--seeds: ") + error.what());
  }
}

}  // namespace

void add_run_options(CommandLine line, RunCommand& command, LogFlags& flags) {
  line.add_option("--repeat", command.repeat,
                  "Number of runs; the world is rebuilt for each, and controllers stay attached")
      .check(whole_number(1, 1'000'000))
      .capture_default_str()
      .type_name("N");
  line.add_option(
          "--threads", command.threads,
          "Number of threads that step the world; results do not depend on it (default: one per available core)")
      .check(whole_number(1, 1024))
      .type_name("N");
  line.add_option("--duration", command.duration,
                  "Duration of the run, in simulated seconds (default: the experiment's duration)")
      .check(number_above_zero(most_seconds, "seconds"))
      .type_name("S");
  const Option seed = line.add_option("--seed", command.seed, "Seed (default: the experiment's seed)")
                          .check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
                          .type_name("N");
  const Option seeds =
      line.add_option_function<std::string>(
              "--seeds", [&command](const std::string& text) { command.seeds = seeds_or_usage_error(text); },
              "Run the experiment once with each of these seeds, such as 1..30 or 4,8,15, and print a table of the "
              "runs")
          .excludes(seed)
          .type_name("A..B[,...]");
  add_set_option(line, command.settings);
  line.add_option_function<std::string>(
          "--speed",
          [&command](const std::string& speed) { command.speed = speed == "max" ? 0.0 : *parse_real(speed); },
          "Limit of the real-time factor (default: 1 with a keyboard, a view, free-running controllers or ROS 2 nodes, "
          "otherwise max)")
      .check(max_or_number_above_zero(1e9))
      .type_name("max|X");
  line.add_option("--summary", command.outputs.summary, "Write the summary to this file as JSON").type_name("FILE");
  line.add_flag("--profile", command.profile,
                "Print the wall time of each stage of a tick, and the work of the solver of contacts and joints")
      .excludes(seeds);
  line.add_option("--plot", command.outputs.plot,
                  "Plot the arena, paths and contacts to this file (.svg, .png or .pdf)")
      .type_name("FILE");
  add_viewpoint_option(line, "--plot-view", "Viewpoint of the plot", command.outputs.viewpoint);
  line.add_option(
          "--csv", command.outputs.csv,
          "Write the quantities that the experiment prints, or with --seeds the table of the runs, to this CSV file")
      .type_name("FILE");
  const Option record =
      line.add_option("--record", command.outputs.recording, "Record the run to this file (MCAP)").type_name("FILE");
  line.add_flag("--record-or-stop", command.record_or_stop, "End the run with exit code 4 if the recording fails")
      .needs(record);
  add_recorded_options(line, command.record, "--record-");
  line.add_flag(
      "--ros2", command.ros2,
      "Let ROS 2 nodes drive robots through cohort-ros2-bridge: the robots under the experiment's key 'ros2', or all");
  const Option view = line.add_flag("--view", command.view, "Show the run in a browser, like 'cohort view'");
  line.add_flag("--control", command.view_controls, "With --view: allow viewers to control the run").needs(view);
  line.add_option("--port", command.view_port,
                  "With --view: TCP port of the page (default: 8080, or any free port if that is taken)")
      .check(whole_number(0, std::numeric_limits<std::uint16_t>::max()))
      .type_name("N")
      .needs(view);
  line.add_flag("--open", command.view_opens,
                "With --view: open the page in a browser, and start the run when it is shown")
      .needs(view);
  line.add_flag("--paused", command.paused,
                "Start paused; 'cohort ctl resume' starts the run, 'cohort ctl step' advances it");
  line.add_option(
          "--keep-snapshots", command.keep_interval,
          "Simulated time between snapshots that are kept in memory for 'cohort ctl back', in seconds (default: none)")
      .check(number_above_zero(most_seconds, "seconds"))
      .type_name("S");
  line.add_option("--from", command.from, "Continue from this snapshot, a file that 'cohort ctl save' wrote")
      .excludes(seeds)
      .type_name("FILE");
  add_reading_options(line, command.runs_xacro);
  add_domain_option(line, command.domains,
                    "DDS domains of the server (default: a free one; 0 for 'serve' and '--controllers external')");
  add_secure_option(line, command.secure,
                    "Folder created by 'cohort security': only identities in it can connect (default: $COHORT_SECURE)");
  add_log_flags(line, flags);
  line.add_flag("--quiet", flags.quiet, "Print only errors");
}

}  // namespace cohort::tool
