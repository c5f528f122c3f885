// SPDX-License-Identifier: Apache-2.0

// Threads and processes that the program starts.

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

#include "tools/exec/preload/this_program.hpp"

namespace cohort::exec {
namespace {

struct Beginning {
  void* (*start)(void*);
  void* argument;
  std::uint64_t order;
  bool is_of_dds;
};

void* run_thread(void* given) {
  const Beginning beginning = *static_cast<Beginning*>(given);
  ::free(given);
  self.order = beginning.order;
  self.has_order = true;
  self.is_of_dds = beginning.is_of_dds;
  void* result = nullptr;
  pthread_cleanup_push([](void*) { leave_thread(); }, nullptr);
  result = beginning.start(beginning.argument);
  pthread_cleanup_pop(1);
  return result;
}
}  // namespace

CreatesThreadsOfDds::CreatesThreadsOfDds(bool they_do) : before_(self.creates_threads_of_dds) {
  self.creates_threads_of_dds = they_do;
}
CreatesThreadsOfDds::~CreatesThreadsOfDds() { self.creates_threads_of_dds = before_; }
bool is_thread_of_dds() { return self.is_of_dds; }

}  // namespace cohort::exec

using namespace cohort::exec;

// Threads are numbered in the order in which they are created, so that those that wake at the same time do so in the
// same order in each run.
COHORT_REPLACES int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                                   void* argument) {
  COHORT_NEXT(pthread_create);
  if (page() == nullptr) return real(thread, attributes, start, argument);
  stir();
  auto* const beginning = static_cast<Beginning*>(::malloc(sizeof(Beginning)));
  if (beginning == nullptr) return EAGAIN;
  const bool of_dds = self.creates_threads_of_dds || is_dds(__builtin_return_address(0));
  *beginning = {start, argument, page()->next_order.fetch_add(1), of_dds};
  const int result = real(thread, attributes, &run_thread, beginning);
  if (result != 0) ::free(beginning);
  page()->threads.fetch_add(1);
  return result;
}

// std::thread's constructor, whose caller pthread_create does not see.
COHORT_REPLACES void cohort_start_thread(void* thread, void* state, void (*depend)()) __asm__(
    "_ZNSt6thread15_M_start_threadESt10unique_ptrINS_6_StateESt14default_deleteIS1_EEPFvvE");
void cohort_start_thread(void* thread, void* state, void (*depend)()) {
  static const auto real = next_for<void (*)(void*, void*, void (*)())>(
      __builtin_return_address(0),
      "_ZNSt6thread15_M_start_threadESt10unique_ptrINS_6_StateESt14default_deleteIS1_EEPFvvE");
  const CreatesThreadsOfDds creates(is_dds(__builtin_return_address(0)));
  real(thread, state, depend);
}

namespace {
// Enters a child before its parent continues.
void enter_child(pid_t child) {
  if (page() == nullptr || child <= 0) return;
  for (Process& process : page()->processes)
    if (process.id == child) return;
  for (Process& process : page()->processes) {
    std::int32_t free = 0;
    if (!process.id.compare_exchange_strong(free, child)) continue;
    page()->threads.fetch_add(1);
    return;
  }
}
}  // namespace

COHORT_REPLACES pid_t fork() {
  COHORT_NEXT(fork);
  stir();
  const pid_t child = real();
  enter_child(child);
  return child;
}
