// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/hosting/controller_call.hpp"

#include <pthread.h>

#include <atomic>
#include <mutex>

namespace cohort {
namespace {

// Signal handlers and other threads reach nothing but globals.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<const Callee*> callee_now{nullptr};
std::atomic<const char*> what_now{nullptr};
std::atomic<std::uint64_t> tick_now{0};
std::atomic<pthread_t> thread_now{};
std::mutex text_is_read;  // no callee is destroyed while this is locked
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

static_assert(std::atomic<const Callee*>::is_always_lock_free && std::atomic<pthread_t>::is_always_lock_free);

}  // namespace

Callee::Callee(const std::string& controller, const std::string& robot, const std::string& team)
    : Callee("the controller '" + controller + "' of " + robot + (team.empty() ? "" : " (team " + team + ")")) {}

Callee::~Callee() { const std::lock_guard lock(text_is_read); }

ControllerCall::ControllerCall(const Callee& callee, const char* what, std::uint64_t tick) noexcept {
  what_now.store(what, std::memory_order_relaxed);
  tick_now.store(tick, std::memory_order_relaxed);
  thread_now.store(::pthread_self(), std::memory_order_relaxed);
  callee_now.store(&callee, std::memory_order_release);
}

ControllerCall::~ControllerCall() { callee_now.store(nullptr, std::memory_order_release); }

CallUnderWay call_under_way() noexcept {
  const Callee* const callee = callee_now.load(std::memory_order_acquire);
  return {callee, what_now.load(std::memory_order_relaxed), tick_now.load(std::memory_order_relaxed),
          callee != nullptr && ::pthread_equal(thread_now.load(std::memory_order_relaxed), ::pthread_self()) != 0};
}

std::optional<std::string> describe_call() {
  const std::lock_guard lock(text_is_read);
  const CallUnderWay call = call_under_way();
  if (call.callee == nullptr) return std::nullopt;
  return call.callee->text() + " has not returned from " + call.what;
}

}  // namespace cohort
