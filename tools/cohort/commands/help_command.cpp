#include <iostream>

#include "server/core/text.hpp"
#include "tools/cohort/commands/commands.hpp"
#include "tools/cohort/commands/manual.hpp"

namespace cohort::tool {

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

}  // namespace cohort::tool
