// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "tools/view/history/history_request.hpp"

namespace cohort::view {

/// A thread that answers requests for histories one after the other, so that nothing else waits for them.
class HistoryThread {
 public:
  static constexpr std::size_t most_pending = 64;
  static constexpr std::size_t most_of_a_visitor = 4;

  /// Returns true if the answer is no longer wanted.
  using IsCancelled = std::function<bool()>;
  /// Called on the thread only. Its exceptions become answers.
  using Read = std::function<Answer(const HistoryRequest&, const IsCancelled&)>;

  explicit HistoryThread(Read read);
  /// Cancels the present request, and answers the remaining ones.
  ~HistoryThread();
  HistoryThread(const HistoryThread&) = delete;
  HistoryThread& operator=(const HistoryThread&) = delete;

  /// `answer` is called once, on any thread. Any thread.
  void ask(const ViewRequest& asked, std::function<void(const Answer&)> answer);
  /// Cancels the requests of a visitor. Any thread.
  void leave(std::uint64_t visitor);

 private:
  struct Pending {
    HistoryRequest request;
    std::function<void(const Answer&)> answer;
  };
  void run();
  Answer read(const HistoryRequest& request);

  const Read read_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Pending> pending_;
  std::uint64_t visitor_ = 0;  // visitor whose request is read
  bool is_reading_ = false;
  std::atomic<bool> is_cancelled_{false};
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

}  // namespace cohort::view
