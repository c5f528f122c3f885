// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "server/core/processors.hpp"
#include "server/description/select_robots.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/recording_part.hpp"
#include "tools/cli/commands/refuse_experiment.hpp"
#include "tools/cli/common/installed_files.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/wording.hpp"
#include "tools/view/html/playable_page.hpp"
#include "tools/view/web/web_server.hpp"

namespace cohort::tool {
namespace {

constexpr std::size_t most_robots_by_default = 16;
constexpr double megabyte = 1e6;

struct PageCommand {
  std::filesystem::path file;
  std::filesystem::path output;
  double frame_rate = 20.0;
  double max_size = 100.0;            ///< [MB]
  std::vector<std::string> robots{};  ///< selectors, or `none`; empty: all if they are few
  bool has_contacts = false;
  RecordingPart part{};
};

view::BuiltPage built_page() {
  const view::PageFiles files = view::read_page(installed_page_folder());
  if (files.empty())
    throw std::runtime_error(
        "the browser page was not built. To build it, install node 18 and npm ('tools/dev/install-packages "
        "tools/dev/packages-node.txt'), then run 'cmake --build build/release --target view_page'");
  return {files.at("/index.html").content, files.at("/page.js").content, files.at("/page.css").content};
}

// Returns the ids of the robots whose channels the page has.
std::vector<std::uint32_t> chosen_robots(const recording::Replay& replay, const PageCommand& command, Log& log) {
  if (command.robots == std::vector<std::string>{"none"}) return {};
  if (!command.robots.empty()) return description::select_robots(replay.experiment().world, command.robots);
  const std::uint32_t count = replay.simulation().robot_count();
  if (count > most_robots_by_default) {
    log.notice(
        fmt::format("the page contains no observations or commands, because there are more than {} robots: "
                    "'--robots' selects robots",
                    most_robots_by_default));
    return {};
  }
  std::vector<std::uint32_t> all(count);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

// Throws if the file has become too large.
void check_size(const PageCommand& command, const view::HtmlFile& file, const view::PlayablePage& page,
                const view::PlayableOptions& options) {
  if (static_cast<double>(file.size()) <= command.max_size * megabyte) return;
  throw std::runtime_error(fmt::format(
      "the page is larger than '--max-size' {:g} MB after {:.1f} s of the recording. To make it smaller, {}{}"
      "choose a part with '--from' and '--to', or a lower '--fps'",
      command.max_size, seconds(page.duration()), options.has_contacts ? "leave out '--contacts', " : "",
      options.robots.empty() ? "" : "choose fewer robots with '--robots', or none, "));
}

void report(const PageCommand& command, const view::HtmlFile& file, const view::PlayablePage& page, std::size_t robots,
            Log& log) {
  const std::size_t data = file.size() - file.page_size();
  const double robot_seconds = static_cast<double>(robots) * seconds(page.duration());
  const std::string share = robot_seconds > 0.0 ? fmt::format(", {:.0f} bytes per robot and second",
                                                              static_cast<double>(data) / robot_seconds)
                                                : "";
  log.notice(fmt::format("wrote {}: {} in {:.2f} s, {:.2f} MB, of which the data is {:.2f} MB{}",
                         command.output.string(), counted(page.frame_count(), "frame"), seconds(page.duration()),
                         static_cast<double>(file.size()) / megabyte, static_cast<double>(data) / megabyte, share),
             {{"frames", page.frame_count()}, {"bytes", file.size()}, {"data_bytes", data}});
}

int write_page(const PageCommand& command, Log& log, const std::atomic<bool>& stop) {
  refuse_experiment(command.file, "--view");
  const recording::Recording recording(command.file);
  if (!recording.damage().empty()) log.warning(recording.damage());
  check_writable("the page", command.output);
  const view::BuiltPage built = built_page();
  recording::Replay replay(recording, available_processors());
  view::HtmlFile file(command.output, built, recording.file().filename().string() + " · Cohort");
  view::PlayableOptions options{.frame_rate = command.frame_rate,
                                .from = start_of_part(command.part),
                                .to = end_of_part(command.part),
                                .has_contacts = command.has_contacts};
  std::unique_ptr<view::PlayablePage> page;
  std::size_t robots = 0;
  const auto visit = [&] {
    robots = std::max<std::size_t>(robots, replay.simulation().robot_count());
    if (!page) {
      options.robots = chosen_robots(replay, command, log);
      page = std::make_unique<view::PlayablePage>(recording, replay, options, file);
    }
    page->visit();
    check_size(command, file, *page, options);
  };
  if (!replay_part(replay, command.part, log, stop, visit)) return exit_interrupted;
  page->finish();
  check_size(command, file, *page, options);
  file.commit();
  report(command, file, *page, robots, log);
  return exit_ok;
}

}  // namespace

Subcommand add_page(CommandLine app) {
  constexpr double most_hertz = 1e6;
  constexpr double most_megabytes = 1e6;
  const auto command = std::make_shared<PageCommand>();
  CommandLine line = app.add_subcommand(in_whole::page.name, in_whole::page.text);
  line.add_option("FILE", command->file, "Recording (MCAP)").required().type_name("");
  line.add_option("-o,--output", command->output, "HTML file to write").required().type_name("FILE");
  line.add_option("--fps", command->frame_rate, "Frames per second of simulated time")
      .check(number_above_zero(most_hertz))
      .capture_default_str()
      .type_name("HZ");
  line.add_option("--robots", command->robots,
                  "Robots whose observations and commands the page shows, selected as by --robots of 'cohort host', or "
                  "none (default: all, if there are at most 16)")
      .comma_separated()
      .type_name("SEL[,SEL...]");
  line.add_flag("--contacts", command->has_contacts, "Include contact points and forces");
  line.add_option("--max-size", command->max_size, "Largest size of the file in MB")
      .check(number_above_zero(most_megabytes))
      .capture_default_str()
      .type_name("MB");
  add_part_options(line, command->part);
  line.footer("Example: cohort page run.mcap -o run.html");
  return {line, [command](Log& log, const std::atomic<bool>& stop) { return write_page(*command, log, stop); }};
}

}  // namespace cohort::tool
