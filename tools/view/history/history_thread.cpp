// SPDX-License-Identifier: Apache-2.0
#include "tools/view/history/history_thread.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace cohort::view {
namespace {

constexpr int lower_priority = 10;  // niceness: what is shown comes first
const Answer closing{false, "the view is closing"};

}  // namespace

HistoryThread::HistoryThread(Read read) : read_(std::move(read)) {
  thread_ = std::thread([this] { run(); });
}

HistoryThread::~HistoryThread() {
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
  }
  changed_.notify_all();
  thread_.join();
  for (const Pending& each : pending_) each.answer(closing);
}

void HistoryThread::ask(const ViewRequest& asked, std::function<void(const Answer&)> answer) {
  try {
    HistoryRequest request = history_request_of(asked);
    const std::lock_guard lock(mutex_);
    const auto of_visitor =
        std::ranges::count(pending_, asked.visitor, [](const Pending& each) { return each.request.visitor; });
    if (pending_.size() >= most_pending || of_visitor >= static_cast<std::ptrdiff_t>(most_of_a_visitor))
      throw std::invalid_argument("too many histories are pending: request one at a time");
    pending_.push_back({std::move(request), answer});
  } catch (const std::invalid_argument& error) {
    return answer({false, error.what()});
  }
  changed_.notify_all();
}

void HistoryThread::leave(std::uint64_t visitor) {
  const std::lock_guard lock(mutex_);
  std::erase_if(pending_, [&](const Pending& each) { return each.request.visitor == visitor; });
  if (is_reading_ && visitor_ == visitor) is_cancelled_ = true;
}

void HistoryThread::run() {
  // On Linux a thread has its own.
  static_cast<void>(::setpriority(PRIO_PROCESS, 0, lower_priority));
  while (true) {
    Pending next;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return is_stopping_ || !pending_.empty(); });
      if (is_stopping_) return;
      next = std::move(pending_.front());
      pending_.pop_front();
      visitor_ = next.request.visitor;
      is_reading_ = true;
      is_cancelled_ = false;
    }
    const Answer answer = read(next.request);
    {
      const std::lock_guard lock(mutex_);
      is_reading_ = false;
    }
    next.answer(is_stopping_ ? closing : answer);
  }
}

Answer HistoryThread::read(const HistoryRequest& request) {
  try {
    return read_(request, [this] { return is_cancelled_ || is_stopping_; });
  } catch (const std::exception& error) {
    return {false, error.what()};
  }
}

}  // namespace cohort::view
