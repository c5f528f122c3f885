// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/watchdog.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "client_sdk/hosting/controller_call.hpp"
#include "tools/cli/common/exit_codes.hpp"

namespace cohort::tool {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds between_looks{200};

// Measures for how long a value has been the same.
template <class Value>
class Unchanged {
 public:
  Clock::duration note(const Value& value) {
    if (value != value_) since_ = Clock::now();
    value_ = value;
    return Clock::now() - since_;
  }

 private:
  Value value_{};
  Clock::time_point since_ = Clock::now();
};

}  // namespace

Watchdog::Watchdog(const std::atomic<bool>& stop, Log& log, std::chrono::milliseconds patience)
    : stop_(stop), log_(log), patience_(patience), thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
  if (TickStage::of_this_thread == &stage_) TickStage::of_this_thread = nullptr;
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  over_.notify_all();
  thread_.join();
}

void Watchdog::watch() {
  Unchanged<std::pair<bool, std::uint64_t>> ending;  // the request to end, and the tick
  Unchanged<std::pair<std::optional<std::string>, std::uint64_t>> calling;
  Unchanged<std::pair<bool, std::uint64_t>> stepping;  // a step or request is under way; how many began
  bool call_is_told = false, step_is_told = false;     // this one has been reported
  std::unique_lock lock(mutex_);
  while (!over_.wait_for(lock, between_looks, [this] { return is_over_; })) {
    const std::uint64_t tick = tick_;
    const std::optional<std::string> call = describe_call();
    const char* const stage = stage_.name();
    const auto in_call = calling.note({call, tick});
    const auto in_step = stepping.note({stage != nullptr, stage_.begun()});
    const bool is_asked = stop_;
    const auto since_asked = ending.note({is_asked, tick});
    if (is_asked && since_asked >= patience_) end_process(tick, call, stage);
    const bool call_is_stuck = call && in_call >= patience_;
    if (call_is_stuck && !call_is_told && !is_asked) warn_of_call(tick, *call);
    call_is_told = call_is_stuck;
    const bool step_is_stuck = stage != nullptr && in_step >= patience_;
    if (step_is_stuck && !step_is_told) warn_of_stage(tick, stage);
    step_is_told = step_is_stuck;
  }
}

std::string Watchdog::patience() const { return fmt::format("{} s", std::chrono::duration<double>(patience_).count()); }

void Watchdog::warn_of_call(std::uint64_t tick, const std::string& call) {
  log_.urgent_warning(
      fmt::format("tick {}: {} for {}, and the run waits for it. A 'deadline' has no effect with '--controllers "
                  "inprocess'. With '--controllers process' and 'deadline: 1, on_late: hold' in the team, the run "
                  "continues with the robot's last command",
                  tick, call, patience()),
      {{"tick", tick}});
}

void Watchdog::warn_of_stage(std::uint64_t tick, const char* stage) {
  log_.urgent_warning(fmt::format("tick {} has not ended for {}; its stage is now: {}. Requests and controllers wait "
                                  "until it ends",
                                  tick, patience(), stage),
                      {{"tick", tick}, {"stage", stage}});
}

void Watchdog::end_process(std::uint64_t tick, const std::optional<std::string>& call, const char* stage) {
  const std::string step =
      std::string("the step takes too long") + (stage ? std::string("; its stage is: ") + stage : "");
  log_.error(fmt::format("tick {} has not ended {} after the request to stop: {}. The process exits now; 'cohort "
                         "recover' makes its recording readable",
                         tick, patience(), call.value_or(step)),
             {{"tick", tick}});
  std::_Exit(exit_failed);
}

}  // namespace cohort::tool
