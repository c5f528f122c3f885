// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/files.hpp"
#include "tests/support/patience.hpp"

/// Functions to run `cohort` from tests as users do.
namespace cohort::test {

using namespace std::chrono_literals;

/// A program in its own process group. The destructor kills the whole group.
class Process {
 public:
  using Environment = std::map<std::string, std::string>;
  explicit Process(const std::vector<std::string>& command, const Environment& environment = {});
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// Returns its combined standard output and standard error so far.
  std::string output() const;
  /// Waits until the output contains `text`. Returns false if the process ends without it, or after `patience`.
  bool wait_for_output(const std::string& text);
  /// Waits for the end of the process. Returns its exit code, or 128 plus the number of the signal that ended it;
  /// nullopt after `patience`.
  std::optional<int> wait_for_exit();
  bool running();

 private:
  ScratchFolder folder_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

/// The exit code of a program, and its output. The code is nullopt if the program did not end in time.
struct Ended {
  std::optional<int> exit_code;
  std::string out;
  std::string err;
};
Ended run_to_end(const std::vector<std::string>& command, const Process::Environment& environment = {});

/// Returns whether a shell finds the program.
bool is_installed(const std::string& program);

/// Returns whether the process runs. A zombie does not count as running.
bool is_alive(pid_t pid);
/// Returns the resident memory of the process [bytes].
std::size_t resident_bytes(pid_t pid);
/// Waits until the process has ended. Returns false after `patience`.
bool wait_until_gone(pid_t pid);

/// Returns the child processes of `parent`. Some may be missing while its processes and threads start and end
/// (proc(5)).
std::vector<pid_t> children_of(pid_t parent);

/// A DDS domain that no other test of this machine uses during its lifetime.
class ReservedDomain {
 public:
  ReservedDomain();
  ReservedDomain(const ReservedDomain&) = delete;
  ReservedDomain& operator=(const ReservedDomain&) = delete;
  ~ReservedDomain();
  std::uint32_t number() const { return number_; }
  std::string text() const { return std::to_string(number_); }

 private:
  std::uint32_t number_ = 0;
  int lock_ = -1;
};

nlohmann::json read_json(const std::filesystem::path& file);
/// Returns the state hash of the run with this summary.
std::string hash_in(const std::filesystem::path& summary);

std::string cohort_program();
/// Returns the path of a controller of tests/commands/.
std::string test_controller(const std::string& name);
std::string demo_experiment();

/// Runs `cohort run` on an experiment with more arguments, checks that it succeeds, and returns its summary.
nlohmann::json run_experiment(const std::string& experiment, const std::vector<std::string>& arguments,
                              const Process::Environment& environment = {});
/// Runs `cohort run` on the demo with more arguments, checks that it succeeds, and returns its summary.
nlohmann::json run_demo(const std::vector<std::string>& arguments, const Process::Environment& environment = {});
/// Returns the state hash after the first `seconds` of the demo with its controllers in the server's process. All other
/// ways to run the demo must give the same hash.
std::string reference_hash(double seconds);

}  // namespace cohort::test
