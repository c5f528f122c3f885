#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <limits>

/// The memory that `cohort exec` and the programs that it runs in virtual time share. The programs have it through the
/// library `preload/`, which replaces the calls that read clocks and wait. Times are in nanoseconds.
namespace cohort::exec {

inline constexpr std::uint32_t page_version = 4;
inline constexpr const char* page_variable = "COHORT_EXEC_PAGE";  ///< environment variable with the page's file
inline constexpr std::size_t most_processes = 256;
inline constexpr std::size_t most_real_sleepers = 256;
inline constexpr std::size_t most_waits = 2048;
inline constexpr std::int64_t never = std::numeric_limits<std::int64_t>::max();

/// Number of times that a thread may read the clock, or poll in vain, in a row without waiting. After that it is taken
/// to spin on it, and waits for `spin_quantum`, so that time goes on.
inline constexpr std::uint32_t reads_before_it_spins = 1000;
inline constexpr std::int64_t spin_quantum = 100'000;

/// The cause that ends a wait.
enum class WaitKind : std::uint32_t {
  none,    ///< free
  sleep,   ///< a thread sleeps on `wake`
  helper,  ///< the process's helper thread ends it: a poll, a condition variable, a semaphore, a timer
  turn,    ///< a thread of the Python interpreter sleeps on `wake` until `is_ready` and all threads are at rest
};

/// Something that happens in a process at a time of its own: a thread's wait that ends, or a timer.
struct Wait {
  std::atomic<std::int32_t> process{0};  ///< 0: free
  std::atomic<std::int32_t> thread{0};   ///< 0: of a timer
  std::atomic<std::uint64_t> order{0};   ///< among waits that end at the same time, the lower first
  std::atomic<std::int64_t> deadline{never};
  std::atomic<WaitKind> kind{WaitKind::none};
  std::atomic<std::uint32_t> wake{0};        ///< futex: 1 from the time on at which its end was announced
  std::atomic<const void*> object{nullptr};  ///< the object that a thread waits for, in its process
  std::atomic<std::uint32_t> is_ready{0};    ///< nonzero once the object may be free
};

struct Process {
  std::atomic<std::int32_t> id{0};            ///< 0: free
  std::atomic<std::uint32_t> attention{0};    ///< futex of its helper thread
  std::atomic<std::uint32_t> has_started{0};  ///< the library is in it
  std::atomic<std::int32_t> turn{0};          ///< thread whose wait was ended last, which may run Python; 0: any
  std::atomic<std::uint64_t> real_calls{0};   ///< bits: calls that wait by real time which it has made
};

struct ClockPage {
  std::atomic<std::uint32_t> version{page_version};
  std::atomic<std::uint32_t> is_real{0};     ///< the program's clocks go on by themselves, from `now` at `real_from`
  std::atomic<std::int64_t> real_from{0};    ///< CLOCK_MONOTONIC
  std::atomic<std::int64_t> now{0};          ///< CLOCK_MONOTONIC and others of the program
  std::atomic<std::int64_t> date{0};         ///< CLOCK_REALTIME of the program at 0
  std::atomic<std::uint32_t> changes{0};     ///< futex: changed when a thread begins to wait
  std::atomic<std::uint32_t> host_waits{0};  ///< nonzero while a thread waits on `changes`
  std::atomic<std::uint32_t> host_looks{0};  ///< nonzero while the host looks whether all threads wait
  std::atomic<std::uint32_t> ready{0};     ///< futex: changed when one becomes ready for its turn and it does not look
  std::atomic<std::uint32_t> threads{0};   ///< changed when threads or processes come
  std::atomic<std::uint32_t> no_turns{0};  ///< threads of an interpreter do not wait for their turns
  std::atomic<std::uint32_t> real_calls{0};  ///< changed when a process has made another one
  std::atomic<std::uint32_t> ros_nodes{0};   ///< that there are
  // A thread whose wait was ended while all others wait may end its next ones itself, until it does something by which
  // another one may wake.
  std::atomic<std::int32_t> alone{0};         ///< the thread; 0: none
  std::atomic<std::int64_t> alone_until{0};   ///< the last time that it may set
  std::atomic<std::uint64_t> alone_since{0};  ///< `stirs` at the beginning
  std::atomic<std::uint64_t> stirs{0};        ///< how often a thread did what may wake another one
  std::atomic<std::uint64_t> next_order{0};
  std::atomic<std::uint32_t> waits_used{0};
  std::array<Process, most_processes> processes{};
  /// Threads that have slept in real time by a call that is replaced, as those of DDS do; 0: free.
  std::array<std::atomic<std::int32_t>, most_real_sleepers> real_sleepers{};
  std::array<Wait, most_waits> waits{};
};

static_assert(std::atomic<std::int64_t>::is_always_lock_free && std::atomic<WaitKind>::is_always_lock_free);

}  // namespace cohort::exec
