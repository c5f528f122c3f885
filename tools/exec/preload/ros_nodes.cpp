// SPDX-License-Identifier: Apache-2.0

// Nodes of ROS 2: what their executors wait by, and how many there are (rmw/rmw.h).

#include "tools/exec/preload/turns.hpp"
#include "tools/exec/preload/virtual_clock.hpp"

using namespace cohort::exec;

#define COHORT_CALLER __builtin_return_address(0)

// Executors wait for messages until the next of their nodes' timers. Without a limit they wait for ever.
struct RmwTime {
  std::uint64_t seconds;
  std::uint64_t nanoseconds;
};
COHORT_REPLACES std::int32_t rmw_wait(void* subscriptions, void* guards, void* services, void* clients, void* events,
                                      void* set, const RmwTime* limit) {
  using Call = std::int32_t (*)(void*, void*, void*, void*, void*, void*, const RmwTime*);
  static const auto real = next_for<Call>(COHORT_CALLER, "rmw_wait");
  // Messages that were sent before are received by then, which threads of DDS do in real time.
  if (page() != nullptr && overridden() == never) wait_for_turn();
  const bool waits = limit != nullptr && (limit->seconds != 0 || limit->nanoseconds != 0);
  if (page() == nullptr || !waits || overridden() != never ||
      limit->seconds > static_cast<std::uint64_t>(never / second) - 1)
    return real(subscriptions, guards, services, clients, events, set, limit);
  const Override until(
      later(now(), static_cast<std::int64_t>(limit->seconds) * second + static_cast<std::int64_t>(limit->nanoseconds)));
  constexpr RmwTime year{365 * 24 * 3600, 0};
  return real(subscriptions, guards, services, clients, events, set, &year);
}

COHORT_REPLACES void* rmw_create_node(void* context, const char* name, const char* name_space) {
  static const auto real = next_for<void* (*)(void*, const char*, const char*)>(COHORT_CALLER, "rmw_create_node");
  void* const node = real(context, name, name_space);
  if (page() != nullptr && node != nullptr) page()->ros_nodes.fetch_add(1);
  return node;
}

COHORT_REPLACES std::int32_t rmw_destroy_node(void* node) {
  static const auto real = next_for<std::int32_t (*)(void*)>(COHORT_CALLER, "rmw_destroy_node");
  if (page() != nullptr) page()->ros_nodes.fetch_sub(1);
  return real(node);
}
