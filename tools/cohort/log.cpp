#include "tools/cohort/log.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <cstdlib>

namespace cohort::tool {

void set_up_log() {
  spdlog::set_default_logger(spdlog::stderr_color_mt("cohort"));
  spdlog::set_pattern("%^%n: %l:%$ %v");
  const char* level = std::getenv("COHORT_LOG");
  spdlog::set_level(level == nullptr ? spdlog::level::warn : spdlog::level::from_str(level));
}

}  // namespace cohort::tool
