// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "server/core/processors.hpp"
#include "server/core/text.hpp"
#include "server/description/select_robots.hpp"
#include "server/recording/replay.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/recording_part.hpp"
#include "tools/cli/commands/refuse_experiment.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/picture_file.hpp"
#include "tools/common/drawing/chart.hpp"
#include "tools/common/drawing/plot.hpp"

namespace cohort::tool {
namespace {

struct PlotCommand {
  std::filesystem::path file;
  std::filesystem::path output;     ///< .svg, .png or .pdf
  std::vector<std::string> what{};  ///< `paths` alone, or `speed` and channels; empty: paths
  std::vector<std::string> robots{};
  Viewpoint viewpoint = Viewpoint::above;  ///< viewpoint of paths
  RecordingPart part{};
};

using recording::Replay;

constexpr std::size_t most_points = 2000;  // points per series
constexpr std::size_t most_robots = 12;    // robots per chart

// Returns the robots of the recording that are drawn, ascending. Throws std::invalid_argument if a selector selects
// none.
std::vector<std::uint32_t> drawn_robots(const Replay& replay, const PlotCommand& command) {
  if (!command.robots.empty()) return description::select_robots(replay.experiment().world, command.robots);
  std::vector<std::uint32_t> robots(replay.simulation().robot_count());
  std::iota(robots.begin(), robots.end(), 0U);
  return robots;
}

// Draws paths; they restart where the recording starts another world.
std::string draw_paths(Replay& replay, const PlotCommand& command, Log& log, const std::atomic<bool>& stop) {
  std::optional<TraceRecorder> trace;
  const Simulation* simulation = nullptr;
  PlotCaption caption;
  std::vector<std::uint32_t> robots;
  const auto visit = [&] {
    if (simulation != &replay.simulation()) {
      simulation = &replay.simulation();
      robots = drawn_robots(replay, command);
      trace.emplace(replay.experiment().world, *simulation, command.viewpoint);
    }
    trace->boundary();
    caption = {replay.experiment().name, simulation->time(), simulation->state_hash()};
  };
  if (!replay_part(replay, command.part, log, stop, visit)) return "";
  RunTrace drawn = trace->finish();
  if (!command.robots.empty()) {
    std::vector<RobotTrace> selected;
    for (const std::uint32_t robot : robots)
      if (robot < drawn.robots.size()) selected.push_back(std::move(drawn.robots[robot]));
    drawn.robots = std::move(selected);
  }
  return draw_plot(drawn, caption);
}

struct Plotted {
  std::string title;
  std::string unit;
  std::function<double(const Simulation&, std::uint32_t robot)> value;
};

constexpr const char* paths_name = "paths";

// Returns all that can be drawn over time, for suggestions.
std::vector<std::string> quantities_of(const RobotKind& kind) {
  std::vector<std::string> names = {paths_name, "speed"};
  for (const std::vector<Channel>* channels : {&kind.observation, &kind.command})
    for (const Channel& channel : *channels) names.push_back(channel.name);
  return names;
}

// Returns the first value of a channel that a robot observes or is commanded by.
Plotted channel_of(const std::string& name, const RobotKind& kind) {
  for (const bool is_command : {false, true}) {
    std::size_t offset = 0;
    for (const Channel& channel : is_command ? kind.command : kind.observation) {
      if (channel.name == name)
        return {name, channel.unit, [=](const Simulation& simulation, std::uint32_t robot) {
                  return (is_command ? simulation.command(robot) : simulation.observation(robot))[offset];
                }};
      offset += channel.size;
    }
  }
  throw std::invalid_argument("robots of model '" + kind.model + "' have no channel '" + name + "'" +
                              suggestion(name, quantities_of(kind)));
}

Plotted plotted(const std::string& what, const Simulation& simulation, std::uint32_t robot) {
  const auto body = [](const Simulation& world, std::uint32_t id) {
    return *world.objects().find(world.robot_name(id));
  };
  if (what == "speed")
    return {"speed", "m/s", [body](const Simulation& world, std::uint32_t id) {
              return world.world().link_twist(BodyId{body(world, id)}, LinkId{0}).linear_W.norm();
            }};
  return channel_of(what, simulation.kinds()[simulation.kind_of(robot)]);
}

// Returns the index of a robot's team, or 0 in a world without teams.
std::size_t team_of(const description::Experiment& experiment, std::uint32_t robot) {
  const auto has_robot = [&](const description::Team& team) { return std::ranges::binary_search(team.robots, robot); };
  const auto found = std::ranges::find_if(experiment.teams, has_robot);
  return found == experiment.teams.end() ? 0 : static_cast<std::size_t>(found - experiment.teams.begin());
}

// Draws a panel for each quantity, with a line for each robot, in the colour of its team if there are several.
std::string draw_series(Replay& replay, const PlotCommand& command, Log& log, const std::atomic<bool>& stop) {
  std::vector<std::uint32_t> robots;
  std::vector<Plotted> quantities;
  figures::Page page{"", command.file.filename().string(), {}};
  const auto begin = [&] {
    robots = drawn_robots(replay, command);
    if (robots.empty()) throw std::invalid_argument("the world has no robots");
    if (robots.size() > most_robots) {
      log.warning(fmt::format("only the first {} of {} robots are drawn; '--robots' selects others", most_robots,
                              robots.size()));
      robots.resize(most_robots);
    }
    const description::Experiment& experiment = replay.simulation().experiment();
    for (const description::Team& team : experiment.teams) page.groups.push_back("team " + team.name);
    for (const std::string& what : command.what) {
      quantities.push_back(plotted(what, replay.simulation(), robots.front()));
      figures::Panel panel{quantities.back().title, "", "time [s]", fmt::format("[{}]", quantities.back().unit), {}};
      for (const std::uint32_t robot : robots)
        panel.series.push_back({.name = replay.simulation().robot_name(robot),
                                .measured = {},
                                .is_joined = true,
                                .has_dots = false,
                                .group = team_of(experiment, robot)});
      page.panels.push_back(std::move(panel));
    }
  };
  const auto visit = [&] {
    if (quantities.empty()) begin();
    const double time = std::chrono::duration<double>(replay.recorded().log_time).count();
    for (std::size_t q = 0; q < quantities.size(); ++q)
      for (std::size_t i = 0; i < robots.size(); ++i)
        if (replay.simulation().is_present(robots[i]))
          page.panels[q].series[i].measured.emplace_back(time, quantities[q].value(replay.simulation(), robots[i]));
  };
  if (!replay_part(replay, command.part, log, stop, visit)) return "";
  for (figures::Panel& panel : page.panels)
    for (figures::Series& series : panel.series) {
      const std::size_t stride = series.measured.size() / most_points + 1;
      std::size_t kept = 0;
      for (std::size_t i = 0; i < series.measured.size(); i += stride) series.measured[kept++] = series.measured[i];
      series.measured.resize(kept);
    }
  return figures::draw(page);
}

int plot(const PlotCommand& command, Log& log, const std::atomic<bool>& stop) {
  check_picture_file(command.output);
  const bool draws_paths = command.what.empty() || command.what == std::vector<std::string>{paths_name};
  if (!draws_paths && std::ranges::find(command.what, paths_name) != command.what.end())
    throw std::invalid_argument(
        "--what: 'paths' makes a separate picture and cannot be combined with other quantities");
  check_writable("the picture", command.output);
  refuse_experiment(command.file, "--plot run.svg");
  const recording::Recording recording(command.file);
  if (!recording.damage().empty()) log.warning(recording.damage());
  Replay replay(recording, available_processors());
  const std::string svg =
      draws_paths ? draw_paths(replay, command, log, stop) : draw_series(replay, command, log, stop);
  if (stop) return exit_interrupted;
  write_picture(command.output, svg);
  return exit_ok;
}

}  // namespace

Subcommand add_plot(CommandLine app) {
  const auto command = std::make_shared<PlotCommand>();
  CommandLine line = app.add_subcommand("plot", "Plot the paths, speeds or sensor readings in a recording");
  line.add_option("FILE", command->file, "Recording (MCAP)").required().type_name("");
  line.add_option("-o,--output", command->output, "Picture to write (.svg, .png or .pdf)").required().type_name("FILE");
  line.add_option("--what", command->what,
                  "paths (the default), or quantities over time: speed, or channels such as proximity/3/reading")
      .comma_separated()
      .type_name("WHAT[,WHAT...]");
  add_robots_of_recording(line, command->robots);
  add_viewpoint_option(line, "--view", "Viewpoint of paths", command->viewpoint);
  add_part_options(line, command->part);
  line.footer("Example: cohort plot run.mcap --what speed,proximity/0/reading --robots 0..3 -o speeds.svg");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return plot(*command, log, stop); }};
}

}  // namespace cohort::tool
