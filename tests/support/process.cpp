// SPDX-License-Identifier: Apache-2.0
#include "tests/support/process.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <sstream>

#include "tests/support/file_lock.hpp"
#include "tools/common/processes/external_program.hpp"

namespace cohort::test {
namespace {

// Apart from the domains that `cohort run` takes by itself (1 to 59) and those of tests/support/free_domain.hpp (60 to
// 79), and below those whose ports are ephemeral ones.
constexpr std::uint32_t first_domain = 80;
constexpr std::uint32_t last_domain = 99;

bool port_is_free(std::uint32_t domain) {
  const int udp = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(7410 + 250 * domain));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool free = bind(udp, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  close(udp);
  return free;
}

}  // namespace

Process::Process(const std::vector<std::string>& command, const Environment& environment) {
  const std::vector<char*> arguments = tool::arguments_of(command);
  const std::string output = (folder_ / "output").string();
  pid_ = fork();
  if (pid_ == 0) {
    setpgid(0, 0);
    const int file = open(output.c_str(), O_CREAT | O_WRONLY | O_APPEND, 0600);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  setpgid(pid_, pid_);
}

Process::~Process() {
  if (running()) {
    for (const pid_t child : children_of(pid_)) kill(child, SIGKILL);
    kill(-pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
}

void Process::signal(int number) const { kill(pid_, number); }

std::string Process::output() const { return read_file(folder_ / "output"); }

bool Process::running() {
  if (exit_code_) return false;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return true;
  exit_code_ = tool::exit_code_of(status);
  return false;
}

bool Process::wait_for_output(const std::string& text) {
  eventually([&] { return output().find(text) != std::string::npos || !running(); }, patience, 5ms);
  return output().find(text) != std::string::npos;
}

std::optional<int> Process::wait_for_exit() {
  eventually([&] { return !running(); }, patience, 5ms);
  return exit_code_;
}

Ended run_to_end(const std::vector<std::string>& command, const Process::Environment& environment) {
  const ScratchFolder folder;
  std::vector<std::string> redirected = {"/bin/sh",
                                         "-c",
                                         R"(out=$1 err=$2; shift 2; exec "$@" > "$out" 2> "$err")",
                                         "sh",
                                         (folder / "out").string(),
                                         (folder / "err").string()};
  redirected.insert(redirected.end(), command.begin(), command.end());
  Process process(redirected, environment);
  const std::optional<int> exit_code = process.wait_for_exit();
  return {exit_code, read_file(folder / "out"), read_file(folder / "err")};
}

bool is_installed(const std::string& program) {
  return run_to_end({"/bin/sh", "-c", "command -v " + program}).exit_code == 0;
}

bool is_alive(pid_t pid) {
  const std::string stat = read_file("/proc/" + std::to_string(pid) + "/stat");
  const std::size_t name_end = stat.rfind(')');  // the name before may hold anything
  return name_end != std::string::npos && stat.size() > name_end + 2 && stat[name_end + 2] != 'Z' &&
         stat[name_end + 2] != 'X';
}

std::size_t resident_bytes(pid_t pid) {
  std::istringstream status(read_file("/proc/" + std::to_string(pid) + "/status"));
  std::size_t kilobytes = 0;
  for (std::string word; status >> word;)
    if (word == "VmRSS:") status >> kilobytes;
  return 1024 * kilobytes;
}

bool wait_until_gone(pid_t pid) {
  return eventually([&] { return !is_alive(pid); });
}

std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> children;
  for (const auto& task : std::filesystem::directory_iterator("/proc/" + std::to_string(parent) + "/task")) {
    std::istringstream list(read_file(task.path() / "children"));
    for (pid_t child = 0; list >> child;) children.push_back(child);
  }
  return children;
}

ReservedDomain::ReservedDomain() {
  for (std::uint32_t i = 0; i <= last_domain - first_domain; ++i) {
    number_ = first_domain + (static_cast<std::uint32_t>(getpid()) + i) % (last_domain - first_domain + 1);
    lock_ = lock_domain(number_);
    if (lock_ >= 0 && port_is_free(number_)) return;
    if (lock_ >= 0) close(lock_);
  }
  throw std::runtime_error("no free DDS domain");
}

ReservedDomain::~ReservedDomain() { close(lock_); }

std::string cohort_program() { return COHORT_BUILD_DIR "/bin/cohort"; }
std::string test_controller(const std::string& name) {
  return COHORT_BUILD_DIR "/lib/test_controllers/" + name + ".so";
}
std::string demo_experiment() { return COHORT_SOURCE_DIR "/worlds/experiments/obstacle_avoidance.yaml"; }

nlohmann::json read_json(const std::filesystem::path& file) { return nlohmann::json::parse(read_file(file)); }
std::string hash_in(const std::filesystem::path& summary) {
  return read_json(summary).value("state_hash", "no summary");
}

nlohmann::json run_experiment(const std::string& experiment, const std::vector<std::string>& arguments,
                              const Process::Environment& environment) {
  const ScratchFolder folder;
  const std::string summary = (folder / "summary.json").string();
  std::vector<std::string> command = {cohort_program(), "run", experiment, "--summary", summary};
  command.insert(command.end(), arguments.begin(), arguments.end());
  Process process(command, environment);
  EXPECT_EQ(process.wait_for_exit(), 0) << process.output();
  return read_json(summary);
}

nlohmann::json run_demo(const std::vector<std::string>& arguments, const Process::Environment& environment) {
  return run_experiment(demo_experiment(), arguments, environment);
}

std::string reference_hash(double seconds) {
  const nlohmann::json summary = run_demo({"--controllers", "inprocess", "--duration", std::to_string(seconds)});
  return summary.value("state_hash", "no summary");
}

}  // namespace cohort::test
