#include <iostream>

#include "server/core/text.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/commands/manual.hpp"

namespace cohort::tool {
namespace {

int help(const std::string& topic, Log& log) {
  if (topic.empty()) {
    std::cout << manual_contents();
    return exit_ok;
  }
  if (const std::optional<std::string> text = manual_of(topic)) {
    std::cout << *text;
    return exit_ok;
  }
  log.error("there is no topic '" + topic + "'" + suggestion(topic, manual_topics()) +
            (nearest(topic, manual_topics()) ? "" : "; 'cohort help' lists them"));
  return exit_usage;
}

}  // namespace

Subcommand add_help(CommandLine app) {
  const auto topic = std::make_shared<std::string>();
  CommandLine line = app.add_subcommand("help", "Manual of what may be written in worlds and experiments");
  line.add_option("TOPIC", *topic, "Such as sensors, placement, proximity_ring or events").type_name("");
  line.footer("Example: cohort help sensors");
  return {line, [topic](Log& log, const std::atomic<bool>&) { return help(*topic, log); }};
}

}  // namespace cohort::tool
