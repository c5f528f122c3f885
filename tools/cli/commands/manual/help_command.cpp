// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>

#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/manual/manual.hpp"
#include "tools/cli/commands/manual/reference_pages.hpp"
#include "tools/cli/common/installed_files.hpp"
#include "tools/cli/common/output_file.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/cli/models/robot_sheet.hpp"

namespace cohort::tool {
namespace {

struct HelpCommand {
  std::string topic{};
  std::string name{};
  std::string markdown{};
};

int help_on_robot(const std::string& name) {
  if (!name.empty()) {
    show(robot_sheet(model_called(name), name, parsing::Xacro::refused));
    return exit_ok;
  }
  show("'cohort help robot NAME' describes a robot. NAME is a model file, or one of:\n");
  for (const std::string& robot : installed_robots()) show("  " + robot + "\n");
  return exit_ok;
}

int help(const HelpCommand& command, Log& log) {
  const auto& [topic, name, markdown] = command;
  if (!markdown.empty()) {
    std::filesystem::create_directories(markdown);
    for (const ReferencePage& page : reference_pages())
      write_file("the reference", std::filesystem::path(markdown) / page.file, page.text);
    return exit_ok;
  }
  if (topic == "robot" || topic == "robots") return help_on_robot(name);
  if (!name.empty()) throw UsageError("expected one topic, not '" + topic + "' and '" + name + "'");
  if (topic.empty()) {
    show(manual_contents());
    return exit_ok;
  }
  if (const std::optional<std::string> text = manual_of(topic)) {
    show(*text);
    return exit_ok;
  }
  const std::vector<std::string> robots = installed_robots();
  const std::optional<std::string> near = nearest_topic(topic);
  std::string hint = "; 'cohort help' lists the topics";
  if (near) hint = "; did you mean '" + *near + "'?";
  if (std::ranges::count(robots, topic) > 0) hint = "; 'cohort help robot " + topic + "' describes the robot";
  log.error("there is no topic '" + topic + "'" + hint);
  return exit_usage;
}

}  // namespace

Subcommand add_help(CommandLine app) {
  const auto command = std::make_shared<HelpCommand>();
  CommandLine line =
      app.add_subcommand("help", "Show the manual of a robot, or of the elements and keys of worlds and experiments");
  const Option named =
      line.add_option("TOPIC", command->topic,
                      "Topic, such as sensors, placement, proximity_ring, events or robot (default: list all topics)")
          .type_name("");
  line.add_option("NAME", command->name, "With the topic robot: name of a robot, or a model file").type_name("");
  line.add_option("--markdown", command->markdown, "Write the manual of all topics to this folder, as Markdown pages")
      .type_name("DIR")
      .excludes(named);
  line.footer("Example: cohort help robot sbot");
  return {line, [command](Log& log, const std::atomic<bool>&) { return help(*command, log); }};
}

}  // namespace cohort::tool
