#include "tools/cohort/running/watchdog.hpp"

#include <fmt/format.h>

#include <cstdlib>
#include <optional>

#include "client_sdk/hosting/controller_call.hpp"
#include "tools/cohort/cli/exit_codes.hpp"

namespace cohort::tool {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds watchdog_patience{10};
constexpr std::chrono::milliseconds between_looks{200};

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
  std::optional<Clock::time_point> since;  // it was asked to end, or has reached another tick
  std::uint64_t tick = 0;
  std::unique_lock lock(mutex_);
  while (!over_.wait_for(lock, between_looks, [this] { return is_over_; })) {
    if (!stop_) continue;
    if (!since || tick_ != tick) since = Clock::now();
    tick = tick_;
    if (Clock::now() - *since < watchdog_patience) continue;
    log_.error(
        fmt::format("tick {} has not ended {} s after this process was asked to end: {}. The run ends here; 'cohort "
                    "recover' closes its recording",
                    tick, watchdog_patience.count(), describe_call().value_or("the world takes too long")),
        {{"tick", tick}});
    std::_Exit(exit_failed);
  }
}

}  // namespace cohort::tool
