#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "server/core/atomic_file.hpp"
#include "server/core/processors.hpp"
#include "server/core/text.hpp"
#include "server/description/select_robots.hpp"
#include "server/recording/replay.hpp"
#include "tools/cohort/cli/output_file.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/commands/recording_part.hpp"
#include "tools/cohort/commands/shared_options.hpp"
#include "tools/drawing/chart.hpp"
#include "tools/drawing/plot.hpp"
#include "tools/processes/external_program.hpp"

namespace cohort::tool {
namespace {

struct PlotCommand {
  std::filesystem::path file;
  std::filesystem::path output;     ///< .svg or .png
  std::vector<std::string> what{};  ///< `speed` and channels; empty: paths
  std::vector<std::string> robots{};
  Viewpoint viewpoint = Viewpoint::above;  ///< of paths
  RecordingPart part{};
};

using recording::Replay;

constexpr std::size_t most_points = 2000;  // of a series
constexpr std::size_t most_robots = 12;    // in a chart

// Where a world begins anew, the paths begin anew.
std::string draw_paths(Replay& replay, const PlotCommand& command, Log& log, const std::atomic<bool>& stop) {
  std::optional<TraceRecorder> trace;
  const Simulation* simulation = nullptr;
  PlotCaption caption;
  const auto visit = [&] {
    if (simulation != &replay.simulation()) {
      simulation = &replay.simulation();
      trace.emplace(replay.experiment().world, *simulation, command.viewpoint);
    }
    trace->boundary();
    caption = {replay.experiment().name, simulation->time(), simulation->state_hash()};
  };
  return replay_part(replay, command.part, log, stop, visit) ? draw_plot(trace->finish(), caption) : std::string();
}

struct Plotted {
  std::string title;
  std::string unit;
  std::function<double(const Simulation&, std::uint32_t robot)> value;
};

std::vector<std::string> channels_of(const RobotKind& kind) {
  std::vector<std::string> names;
  for (const std::vector<Channel>* channels : {&kind.observation, &kind.command})
    for (const Channel& channel : *channels) names.push_back(channel.name);
  return names;
}

// The first value of a channel that a robot observes or is commanded.
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
                              suggestion(name, channels_of(kind)));
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

// A panel for each quantity, a line in it for each robot.
std::string draw_series(Replay& replay, const PlotCommand& command, Log& log, const std::atomic<bool>& stop) {
  std::vector<std::uint32_t> robots;
  std::vector<Plotted> quantities;
  figures::Page page{"", command.file.filename().string(), {}};
  const auto begin = [&] {
    for (const std::string& selector : command.robots) {
      const auto selected = description::select_robots(replay.experiment().world, selector);
      robots.insert(robots.end(), selected.begin(), selected.end());
    }
    if (command.robots.empty())
      for (std::uint32_t robot = 0; robot < replay.simulation().robot_count(); ++robot) robots.push_back(robot);
    if (robots.size() > most_robots) {
      log.warning(
          fmt::format("the first {} of {} robots are drawn; --robots chooses others", most_robots, robots.size()));
      robots.resize(most_robots);
    }
    for (const std::string& what : command.what) {
      quantities.push_back(plotted(what, replay.simulation(), robots.front()));
      figures::Panel panel{quantities.back().title, "", "time [s]", fmt::format("[{}]", quantities.back().unit), {}};
      for (const std::uint32_t robot : robots)
        panel.series.push_back(
            {.name = replay.simulation().robot_name(robot), .measured = {}, .is_joined = true, .has_dots = false});
      page.panels.push_back(std::move(panel));
    }
  };
  const auto visit = [&] {
    if (quantities.empty()) begin();
    const double time = std::chrono::duration<double>(replay.recorded().log_time).count();
    for (std::size_t q = 0; q < quantities.size(); ++q)
      for (std::size_t i = 0; i < robots.size(); ++i)
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

// What has no picture of its own is drawn by librsvg.
void write_png(const std::filesystem::path& file, const std::string& svg) {
  AtomicFile picture("the picture", std::filesystem::absolute(file));
  const std::filesystem::path source = picture.path().string() + ".svg";
  write_file("the picture", source, svg);
  const ProgramResult result = run_program({"rsvg-convert", "--background-color", "white", "--zoom", "2", "--output",
                                            picture.path().string(), source.string()},
                                           picture.path().parent_path());
  std::filesystem::remove(source);
  if (result.exit_code != 0)
    throw WriteError(fmt::format("{} cannot be drawn: rsvg-convert says {}", file.string(), result.errors));
  picture.commit();
}

int plot(const PlotCommand& command, Log& log, const std::atomic<bool>& stop) {
  const std::string extension = command.output.extension().string();
  if (extension != ".svg" && extension != ".png")
    throw std::invalid_argument(
        fmt::format("{}: expected a file name that ends in .svg or .png", command.output.string()));
  check_writable("the picture", command.output);
  const recording::Recording recording(command.file);
  if (!recording.damage().empty()) log.warning(recording.damage());
  Replay replay(recording, available_processors());
  const std::string svg =
      command.what.empty() ? draw_paths(replay, command, log, stop) : draw_series(replay, command, log, stop);
  if (stop) return exit_interrupted;
  if (extension == ".svg")
    write_file("the picture", command.output, svg);
  else
    write_png(command.output, svg);
  return exit_ok;
}

}  // namespace

Subcommand add_plot(CommandLine app) {
  const auto command = std::make_shared<PlotCommand>();
  CommandLine line = app.add_subcommand("plot", "Draw a recording: paths, speeds, what robots sense");
  line.add_option("FILE", command->file, "Recording (MCAP)").required().type_name("");
  line.add_option("-o,--output", command->output, "Picture to write (.svg or .png)").required().type_name("FILE");
  line.add_option("--what", command->what, "Over time: speed, or channels such as proximity/3/reading (default: paths)")
      .comma_separated()
      .type_name("WHAT[,WHAT...]");
  add_robots_of_recording(line, command->robots);
  add_viewpoint_option(line, "--view", "Of paths", command->viewpoint);
  add_part_options(line, command->part);
  line.footer("Example: cohort plot run.mcap --what speed,proximity/0/reading --robots 0..3 -o speeds.svg");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return plot(*command, log, stop); }};
}

}  // namespace cohort::tool
