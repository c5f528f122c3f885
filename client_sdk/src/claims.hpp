// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace cohort {

/// The selectors of the robots that a client claims, which may change while it is attached. Thread-safe.
class Claims {
 public:
  void set(std::vector<std::string> selectors) {
    const std::lock_guard lock(mutex_);
    selectors_ = std::move(selectors);
    has_news_ = true;
    if (wake_) wake_();
  }
  /// Replaces `selectors` if others were set since the last call. Returns true if this is so.
  bool take(std::vector<std::string>& selectors) {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(has_news_, false)) return false;
    selectors = selectors_;
    return true;
  }
  /// Calls `wake` each time selectors are set from now on; an empty `wake` cancels this.
  void on_set(std::function<void()> wake) {
    const std::lock_guard lock(mutex_);
    wake_ = std::move(wake);
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> selectors_;
  bool has_news_ = false;
  std::function<void()> wake_;
};

}  // namespace cohort
