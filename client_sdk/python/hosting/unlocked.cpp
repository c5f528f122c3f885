// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/python/hosting/unlocked.hpp"

#include <pthread.h>
#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "client_sdk/python/hosting/python_objects.hpp"

namespace cohort::python {
namespace {

// All threads that work without the lock. Python calls `end` on the thread that ends the process, after all threads
// that are not daemons have ended.
class Working {
 public:
  void begin(std::atomic<bool>* stop) {
    const std::lock_guard lock(mutex_);
    ++threads_;
    if (stop != nullptr) stops_.push_back(stop);
  }
  void finish(std::atomic<bool>* stop) {
    {
      const std::lock_guard lock(mutex_);
      --threads_;
      if (stop != nullptr) stops_.erase(std::ranges::find(stops_, stop));
    }
    finished_.notify_all();
  }
  void end() {
    std::unique_lock lock(mutex_);
    ending_thread_ = std::this_thread::get_id();
    is_ending_ = true;
    for (std::atomic<bool>* stop : stops_) *stop = true;
    finished_.wait(lock, [this] { return threads_ == 0; });
  }
  bool must_end() const { return is_ending_ && ending_thread_ != std::this_thread::get_id(); }
  // The child of a fork has only the thread that forked, which holds Python's lock.
  void prepare_fork() { mutex_.lock(); }
  void continue_parent() { mutex_.unlock(); }
  void continue_child() {
    threads_ = 0;
    stops_.clear();
    mutex_.unlock();
  }

 private:
  std::mutex mutex_;
  std::condition_variable finished_;
  int threads_ = 0;
  std::vector<std::atomic<bool>*> stops_;
  std::thread::id ending_thread_;  // before is_ending_
  std::atomic<bool> is_ending_ = false;
};

// Never destroyed, because threads that wait forever refer to it.
Working& working() {
  static auto* const all = new Working;
  return *all;
}

[[noreturn]] void wait_forever() {
  for (;;) ::pause();
}

PyObject* end_work(PyObject*, PyObject*) {
  PyThreadState* const state = PyEval_SaveThread();
  working().end();
  PyEval_RestoreThread(state);
  Py_RETURN_NONE;
}

PyMethodDef end_work_method = {"end_work", end_work, METH_NOARGS, nullptr};

}  // namespace

// A thread counts as working from before it releases the lock until it has the lock again, so that `Working::end` does
// not return while a thread waits for the lock.
Unlocked::Unlocked(std::atomic<bool>* stop) : stop_(stop) {
  working().begin(stop_);
  state_ = PyEval_SaveThread();
  if (must_end()) {
    working().finish(stop_);
    wait_forever();
  }
}

Unlocked::~Unlocked() {
  if (must_end()) {
    working().finish(stop_);
    wait_forever();
  }
  PyEval_RestoreThread(state_);
  working().finish(stop_);
}

bool Unlocked::must_end() { return working().must_end(); }

void watch_for_the_end_of_python() {
  ::pthread_atfork([] { working().prepare_fork(); }, [] { working().continue_parent(); },
                   [] { working().continue_child(); });
  const Owned atexit = checked(PyImport_ImportModule("atexit"));
  const Owned function = checked(PyCFunction_New(&end_work_method, nullptr));
  checked(PyObject_CallMethod(atexit.get(), "register", "O", function.get()));
}

}  // namespace cohort::python
