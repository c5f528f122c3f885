#include "tools/cohort/running/watchdog.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "client_sdk/hosting/controller_call.hpp"
#include "tools/cohort/cli/exit_codes.hpp"

namespace cohort::tool {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds watchdog_patience{10};
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

Watchdog::Watchdog(const std::atomic<bool>& stop, Log& log) : stop_(stop), log_(log), thread_([this] { watch(); }) {}

Watchdog::~Watchdog() {
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
  bool is_told = false;  // this call has been reported
  std::unique_lock lock(mutex_);
  while (!over_.wait_for(lock, between_looks, [this] { return is_over_; })) {
    const std::uint64_t tick = tick_;
    const std::optional<std::string> call = describe_call();
    const auto in_call = calling.note({call, tick});
    const bool is_asked = stop_;
    const auto since_asked = ending.note({is_asked, tick});
    if (is_asked && since_asked >= watchdog_patience) end_process(tick, call);
    const bool is_stuck = call && in_call >= watchdog_patience;
    if (is_stuck && !is_told && !is_asked)
      log_.urgent_warning(
          fmt::format("tick {}: {} for {} s, and the run waits for it. A 'deadline' has no effect with '--controllers "
                      "inprocess'. With '--controllers process' and 'deadline: 1, on_late: hold' in the team, the run "
                      "continues with the robot's last command",
                      tick, *call, watchdog_patience.count()),
          {{"tick", tick}});
    is_told = is_stuck;
  }
}

void Watchdog::end_process(std::uint64_t tick, const std::optional<std::string>& call) {
  log_.error(fmt::format("tick {} has not ended {} s after the request to stop: {}. The process exits now; 'cohort "
                         "recover' makes its recording readable",
                         tick, watchdog_patience.count(), call.value_or("the physics step takes too long")),
             {{"tick", tick}});
  std::_Exit(exit_failed);
}

}  // namespace cohort::tool
