#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "cohort/controller.hpp"

namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// Stands still, but for one thing, which COHORT_TEST_FAULT names, at tick 20 of the robot COHORT_TEST_ROBOT (or of
// all). COHORT_TEST_FILE is for what a test and it have to tell each other.
class Misbehaving final : public cohort::Controller {
 public:
  void start(const cohort::Start& start) override {
    const std::string robot = environment("COHORT_TEST_ROBOT");
    if (robot.empty() || robot == start.name) fault_ = environment("COHORT_TEST_FAULT");
  }
  void step(const cohort::Observation& observation, cohort::Command&) override {
    if (observation.tick() < 20) return;
    const std::string fault = std::exchange(fault_, "");
    const std::filesystem::path file = environment("COHORT_TEST_FILE");
    if (fault == "throw") throw std::runtime_error("a fault on purpose");
    if (fault == "abort") std::abort();
    if (fault == "terminate") std::terminate();
    if (fault == "leave") std::exit(0);
    if (fault == "abort once" && !std::filesystem::exists(file)) {
      std::ofstream(file) << "done";
      std::abort();
    }
    if (fault == "print") std::fputs("a line of a controller\n\"quoted\"\n", stderr);
    if (fault == "be deaf") std::signal(SIGTERM, SIG_IGN);
    if (fault == "loop" || fault == "be deaf") {
      std::fputs("stuck\n", stderr);
      for (volatile bool forever = true; forever;) {
      }
    }
    if (fault == "start a helper") {
      const pid_t helper = fork();
      if (helper == 0) {
        execl("/bin/sleep", "sleep", "1000", nullptr);
        _exit(127);
      }
      std::ofstream(file) << helper << std::endl;
      std::fputs("helped\n", stderr);
    }
  }

 private:
  std::string fault_;
};

}  // namespace

COHORT_CONTROLLER(Misbehaving)
