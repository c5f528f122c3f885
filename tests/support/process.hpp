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

/// Running `cohort` as users do, from tests.
namespace cohort::test {

using namespace std::chrono_literals;

/// A program in a process group of its own, killed with all that it started when this is gone.
class Process {
 public:
  using Environment = std::map<std::string, std::string>;
  explicit Process(const std::vector<std::string>& command, const Environment& environment = {});
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  pid_t pid() const { return pid_; }
  void signal(int number) const;
  /// Returns its standard output and standard error so far, in one.
  std::string output() const;
  /// Waits until the output contains `text`; false if the process ended without it or patience ran out.
  bool wait_for_output(const std::string& text);
  /// Waits for its end. Its exit code, or 128 + the signal that ended it; nothing if patience ran out.
  std::optional<int> wait_for_exit();
  bool running();

 private:
  ScratchFolder folder_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

/// How a program ended, and what it wrote where.
struct Ended {
  std::optional<int> exit_code;
  std::string out;
  std::string err;
};
Ended run_to_end(const std::vector<std::string>& command, const Process::Environment& environment = {});

/// Returns whether a shell finds the program.
bool is_installed(const std::string& program);

/// Returns whether the process runs. A process that has ended does not, even if no other has waited for it yet.
bool is_alive(pid_t pid);
/// Returns the memory of the process.
std::size_t resident_bytes(pid_t pid);
/// Waits until it has ended; false if patience ran out.
bool wait_until_gone(pid_t pid);

/// Processes started by `parent`; some may be missing while its processes and threads start and end (proc(5)).
std::vector<pid_t> children_of(pid_t parent);

/// A DDS domain that no other test of this machine has while this lives.
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
/// A controller of tests/commands/.
std::string test_controller(const std::string& name);
std::string demo_experiment();

/// Runs `cohort run` on an experiment with more arguments, checks that it succeeds, and returns its summary.
nlohmann::json run_experiment(const std::string& experiment, const std::vector<std::string>& arguments,
                              const Process::Environment& environment = {});
/// Runs `cohort run` on the demo with more arguments, checks that it succeeds, and returns its summary.
nlohmann::json run_demo(const std::vector<std::string>& arguments, const Process::Environment& environment = {});
/// Hash of the first `seconds` of the demo with its controllers in the server's process: what every other way to run it
/// has to reach.
std::string reference_hash(double seconds);

}  // namespace cohort::test
