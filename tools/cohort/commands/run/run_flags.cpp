#include "tools/cohort/commands/run/run_flags.hpp"

#include <limits>
#include <stdexcept>

#include "server/core/text.hpp"
#include "tools/cohort/cli/checks.hpp"
#include "tools/cohort/commands/shared_options.hpp"
#include "tools/cohort/running/seeds.hpp"

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
                  "Number of runs; each run rebuilds the world, and controllers stay attached")
      .check(whole_number(1, 1'000'000))
      .capture_default_str()
      .type_name("N");
  line.add_option("--threads", command.threads,
                  "Threads that step the world; results do not depend on it (default: one per available core)")
      .check(whole_number(1, 1024))
      .type_name("N");
  line.add_option("--duration", command.duration, "Simulated seconds (default: the experiment's duration)")
      .check(number_above_zero(most_seconds))
      .type_name("S");
  const Option seed = line.add_option("--seed", command.seed, "Seed (default: the experiment's seed)")
                          .check(whole_number(0, std::numeric_limits<std::uint64_t>::max()))
                          .type_name("N");
  const Option seeds =
      line.add_option_function<std::string>(
              "--seeds", [&command](const std::string& text) { command.seeds = seeds_or_usage_error(text); },
              "Run the experiment once with each of these seeds, such as 1..30 or 4,8,15, and print a table of all")
          .excludes(seed)
          .type_name("A..B[,...]");
  line.add_option_function<std::string>(
          "--speed",
          [&command](const std::string& speed) { command.speed = speed == "max" ? 0.0 : *parse_real(speed); },
          "Limit the speed, in simulated seconds per second (default: 1 with a keyboard, a view or free-running "
          "controllers or ROS 2 nodes, otherwise max)")
      .check(max_or_number_above_zero(1e9))
      .type_name("max|X");
  line.add_option("--summary", command.outputs.summary, "Write the summary to this file as JSON").type_name("FILE");
  line.add_option("--plot", command.outputs.plot, "Draw arena, paths and contacts to this file (.svg, .png or .pdf)")
      .type_name("FILE");
  add_viewpoint_option(line, "--plot-view", "Viewpoint of the plot", command.outputs.viewpoint);
  line.add_option(
          "--csv", command.outputs.csv,
          "Write the values that the experiment prints to this file as CSV; with --seeds, the table of all runs")
      .type_name("FILE");
  const Option record =
      line.add_option("--record", command.outputs.recording, "Record the run to this file (MCAP)").type_name("FILE");
  line.add_flag("--record-or-stop", command.record_or_stop, "End the run with exit code 4 when recording fails")
      .needs(record);
  add_recorded_options(line, command.record, "--record-");
  line.add_flag(
      "--ros2", command.ros2,
      "Let ROS 2 nodes drive robots through cohort-ros2-bridge: those named under the experiment's 'ros2', or "
      "all");
  const Option view = line.add_flag("--view", command.view, "Show the run in a browser, as 'cohort view' does");
  line.add_flag("--control", command.view_controls, "With --view: allow viewers to control the run").needs(view);
  line.add_option("--port", command.view_port,
                  "With --view: TCP port of the page (default: 8080, or any free port if that is taken)")
      .check(whole_number(0, std::numeric_limits<std::uint16_t>::max()))
      .type_name("N")
      .needs(view);
  line.add_flag("--open", command.view_opens, "With --view: open a browser, and start the run when the page is shown")
      .needs(view);
  line.add_flag("--paused", command.paused, "Start paused; 'cohort ctl resume' or 'step' continues");
  line.add_option("--keep-snapshots", command.keep_interval,
                  "Simulated seconds between snapshots in memory, for 'cohort ctl back' (default: none)")
      .check(number_above_zero(most_seconds))
      .type_name("S");
  line.add_option("--from", command.from, "Continue from this snapshot, made by 'cohort ctl save'")
      .excludes(seeds)
      .type_name("FILE");
  add_reading_options(line, command.runs_xacro);
  add_domain_option(line, command.domains,
                    "DDS domains to serve (default: a free one; 0 for 'serve' and '--controllers external')");
  add_secure_option(line, command.secure,
                    "Folder made by 'cohort security': only its identities can connect (default: $COHORT_SECURE)");
  add_log_flags(line, flags);
  line.add_flag("--quiet", flags.quiet, "Print errors only");
}

}  // namespace cohort::tool
