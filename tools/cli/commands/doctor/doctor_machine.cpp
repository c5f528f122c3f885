// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <sys/resource.h>

#include <charconv>
#include <cmath>
#include <ctime>
#include <fstream>
#include <limits>
#include <set>
#include <thread>

#include "idl/dds/survey.hpp"
#include "server/core/processors.hpp"
#include "tools/cli/commands/doctor/doctor.hpp"

namespace cohort::tool {
namespace {

namespace fs = std::filesystem;

// Returns the first line of a file; empty if the file does not exist.
std::string line_of(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line;
}

std::optional<std::uint64_t> number_of(const fs::path& file) {
  const std::string line = line_of(file);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
  return error == std::errc() ? std::optional(number) : std::nullopt;
}

// A limit that is a number; the value `max` means no limit.
struct ProcessLimit {
  std::uint64_t most = 0;
  std::uint64_t now = 0;
};

// Returns the process limit of this process's control group.
std::optional<ProcessLimit> process_limit(const fs::path& proc, const fs::path& sys) {
  std::string group = line_of(proc / "self/cgroup");
  if (!group.starts_with("0::/")) return std::nullopt;
  const fs::path folder = sys / "fs/cgroup" / group.substr(4);
  const auto most = number_of(folder / "pids.max");
  const auto now = number_of(folder / "pids.current");
  if (!most || !now) return std::nullopt;
  return ProcessLimit{*most, *now};
}

double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

Finding check_buffers(const fs::path& proc) {
  constexpr std::uint64_t wanted = 4'194'304;  // as Cohort asks for
  const auto most = number_of(proc / "sys/net/core/rmem_max");
  if (!most) return {"buffers", Health::ok, "the kernel does not report the limit of UDP receive buffers"};
  const std::string found =
      fmt::format("UDP receive buffers are limited to {} kB; Cohort requests {} kB", *most / 1024, wanted / 1024);
  if (*most >= wanted) return {"buffers", Health::ok, found};
  return {"buffers", Health::warning, found,
          fmt::format(
              "With many clients or large observations, frames are lost and resent. This costs time and does not "
              "change results. As root: sysctl -w net.core.rmem_max={}; to make it permanent, add it to /etc/sysctl.d",
              wanted)};
}

Finding check_limits(const fs::path& proc, const fs::path& sys) {
  constexpr rlim_t enough_files = 1024;
  constexpr std::uint64_t enough_processes = 200;
  rlimit files{};
  rlimit processes{};
  getrlimit(RLIMIT_NOFILE, &files);
  getrlimit(RLIMIT_NPROC, &processes);
  const auto text = [](rlim_t limit) { return limit == RLIM_INFINITY ? "no limit" : fmt::format("{}", limit); };
  std::string found =
      fmt::format("open files {}, processes and threads {}", text(files.rlim_cur), text(processes.rlim_cur));
  std::string advice;
  if (files.rlim_cur < enough_files)
    advice = fmt::format("Each client needs several files: run 'ulimit -n {}' in this shell. ", enough_files);
  if (processes.rlim_cur < enough_processes)
    advice += "Each client needs about ten threads: raise the limit with 'ulimit -u' in this shell or in limits.conf. ";
  if (const auto group = process_limit(proc, sys)) {
    found += fmt::format(", in this control group {} of {}", group->now, group->most);
    if (group->now + enough_processes > group->most)
      advice +=
          "The control group (of a container or a systemd unit) is near its limit: raise pids.max, --pids-limit of the "
          "container or TasksMax of the unit. ";
  }
  if (!advice.empty()) advice.pop_back();
  return {"limits", advice.empty() ? Health::ok : Health::warning, found, advice};
}

Finding check_clock(const fs::path& sys) {
  const std::string source = line_of(sys / "devices/system/clocksource/clocksource0/current_clocksource");
  timespec resolution{};
  clock_getres(CLOCK_MONOTONIC, &resolution);
  // Drift between the wall clock and the steady clock in a short time: slewing is slow, a jump is not.
  constexpr auto moment = std::chrono::milliseconds(200);
  constexpr double least_jump = 0.005;  // [s]
  const double before = seconds_of(CLOCK_REALTIME) - seconds_of(CLOCK_MONOTONIC);
  std::this_thread::sleep_for(moment);
  const double jump = seconds_of(CLOCK_REALTIME) - seconds_of(CLOCK_MONOTONIC) - before;
  Finding finding{"clock", Health::ok,
                  fmt::format("source {}, steady clock with a resolution of {} ns", source.empty() ? "unknown" : source,
                              resolution.tv_nsec)};
  if (source == "hpet" || source == "acpi_pm" || source == "jiffies") {
    finding.health = Health::warning;
    finding.advice =
        "This clock is slow to read, which costs time in each tick; 'dmesg | grep -i tsc' shows why it is used.";
  }
  if (std::abs(jump) > least_jump) {
    finding.health = Health::warning;
    finding.found += fmt::format(", the wall clock has just jumped by {:.3f} s", jump);
    finding.advice =
        "Runs are not affected, because they use the steady clock. Times in logs and checks of certificates are "
        "affected: check the clock synchronization.";
  }
  return finding;
}

Finding check_processor(const fs::path& sys) {
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  std::set<std::string> governors;
  for (unsigned core = 0; core < cores; ++core) {
    std::string governor = line_of(sys / fmt::format("devices/system/cpu/cpu{}/cpufreq/scaling_governor", core));
    if (!governor.empty()) governors.insert(std::move(governor));
  }
  Finding finding{"processor", Health::ok, fmt::format("{} core{}", cores, cores == 1 ? "" : "s")};
  if (const unsigned available = available_processors(); available < cores)
    finding.found += fmt::format(", a control group limits them to {}", available);
  if (!governors.empty()) finding.found += fmt::format(", frequency governor {}", fmt::join(governors, ", "));
  if (governors.contains("powersave") || governors.contains("conservative")) {
    finding.health = Health::warning;
    finding.advice =
        "With short ticks, these cores stay at a low frequency. As root: cpupower frequency-set -g performance";
  }
  return finding;
}

Finding check_library() {
  const std::string built = wire::dds_version();
  const fs::path library = wire::dds_library();
  const std::string found = fmt::format("Cyclone DDS {}, {}", built, library.string());
  if (library.filename().string().find("so." + built) != std::string::npos) return {"library", Health::ok, found};
  return {"library", Health::warning, found,
          fmt::format("Cohort was built with {}, but another version seems to be loaded: rebuild Cohort, or correct "
                      "LD_LIBRARY_PATH",
                      built)};
}

}  // namespace cohort::tool
