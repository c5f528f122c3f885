// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "cohort/controller.hpp"

namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

// Writes the file COHORT_TEST_LOADED when the plugin is loaded, if the variable is set.
const bool is_loaded = [] {
  if (const std::string file = environment("COHORT_TEST_LOADED"); !file.empty()) std::ofstream(file) << "loaded";
  if (environment("COHORT_TEST_FAULT") == "leave while loaded") std::exit(0);
  return true;
}();

// Uses up the stack, in spite of the optimizer.
// NOLINTNEXTLINE(misc-no-recursion)
int descend(volatile char* above) {
  if (above == nullptr) return 0;
  volatile char here[4096] = {};
  here[0] = static_cast<char>(above[0] + 1);
  return descend(here) + here[0];
}

// A controller that stands still, except for one fault at tick 20. COHORT_TEST_FAULT names the fault, COHORT_TEST_ROBOT
// the robot (default: all). A test communicates with it through the file COHORT_TEST_FILE.
class Misbehaving final : public cohort::Controller {
 public:
  ~Misbehaving() override {
    if (fault_ == "leave in its destructor" && started_) std::exit(0);
  }
  void start(const cohort::Start& start) override {
    const std::string robot = environment("COHORT_TEST_ROBOT");
    if (robot.empty() || robot == start.name) saving_fault_ = fault_ = environment("COHORT_TEST_FAULT");
    if (fault_ == "leave on trial") std::exit(0);
    if (fault_ == "crash on trial") std::raise(SIGSEGV);
    started_ = start.reason != cohort::StartReason::check;
    if (fault_ == "leave in start" && started_) std::exit(0);
    if (fault_ == "throw in start" && started_) throw std::runtime_error("a fault on purpose");
  }
  void step(const cohort::Observation& observation, cohort::Command&) override {
    if (observation.tick() < 20 || fault_ == "leave in its destructor") return;
    const std::string fault = std::exchange(fault_, "");
    const std::filesystem::path file = environment("COHORT_TEST_FILE");
    if (fault == "throw") throw std::runtime_error("a fault on purpose");
    if (fault == "throw commands") throw std::runtime_error("a fault \x1b]0;owned\x07 \xff \xc2\x9b");
    if (fault == "abort") std::abort();
    if (fault == "terminate") std::terminate();
    if (fault == "leave") std::exit(0);
    if (fault == "leave quickly") std::quick_exit(0);
    if (fault == "leave on a thread") std::thread([] { std::exit(0); }).join();
    if (fault == "segfault") *static_cast<volatile int*>(nullptr) = 1;
    if (fault == "overflow the stack") {
      volatile char top[1] = {};
      descend(top);
    }
    if (fault == "throw on a thread") std::thread([] { throw std::runtime_error("a fault on purpose"); }).join();
    if (fault == "abort once" && !std::filesystem::exists(file)) {
      std::ofstream(file) << "done";
      std::abort();
    }
    if (fault == "print") std::fputs("a line of a controller\n\"quoted\"\n", stderr);
    if (fault == "print") std::printf("a line on standard output\n");
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
  void save(cohort::StateWriter& state) const override {
    if (saving_fault_ == "throw in save") throw std::runtime_error("a fault on purpose");
    if (saving_fault_ == "save too much") return state.write(std::vector<double>(1 << 18));
    Controller::save(state);
  }

 private:
  std::string fault_;
  bool started_ = false;  // and not on trial
  std::string saving_fault_;
};

}  // namespace

COHORT_CONTROLLER(Misbehaving)
