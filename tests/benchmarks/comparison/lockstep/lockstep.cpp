// SPDX-License-Identifier: Apache-2.0
#include "tests/benchmarks/comparison/lockstep/lockstep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

#include "tests/benchmarks/comparison/lockstep/lockstep_report.hpp"
#include "tests/benchmarks/comparison/lockstep/lockstep_run.hpp"
#include "tests/benchmarks/comparison/lockstep/lockstep_world.hpp"
#include "tests/benchmarks/comparison/lockstep/look_ahead.hpp"
#include "tests/benchmarks/comparison/lockstep/udp_floor.hpp"
#include "tests/benchmarks/comparison/measuring/clocks.hpp"

namespace cohort::bench {
namespace {

constexpr double warm_up = 0.3;  // duration of each method before the first repetition [s]

// Counters of one turn.
class Counter {
 public:
  explicit Counter(BenchProcesses& processes) : processes_(processes) {}

  void begin() {
    barriers_.clear();
    ticks_ = 0;
    own_cpu_ = bench::cpu_seconds();
    clients_cpu_ = processes_.cpu_seconds();
    begin_ = wall_seconds();
  }
  void add_barrier(double seconds) { barriers_.push_back(seconds); }
  /// Counts a tick, and returns its duration.
  double add_tick() {
    ++ticks_;
    return wall_seconds() - begin_;
  }
  LockstepTurn end() {
    const double wall = wall_seconds() - begin_;
    const auto ticks = static_cast<double>(ticks_);
    LockstepTurn turn;
    turn.ticks_a_second = ticks / wall;
    turn.server_cpu = (bench::cpu_seconds() - own_cpu_) / ticks;
    turn.clients_cpu = (processes_.cpu_seconds() - clients_cpu_) / ticks;
    for (const double barrier : barriers_) turn.barrier_mean += barrier / static_cast<double>(barriers_.size());
    turn.barrier_median = quantile(0.5);
    turn.barrier_p99 = quantile(0.99);
    return turn;
  }

 private:
  double quantile(double share) {
    if (barriers_.empty()) return 0.0;
    const auto place =
        barriers_.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(barriers_.size() - 1));
    std::nth_element(barriers_.begin(), place, barriers_.end());
    return *place;
  }

  BenchProcesses& processes_;
  std::vector<double> barriers_;
  std::uint64_t ticks_ = 0;
  double own_cpu_ = 0.0;
  double clients_cpu_ = 0.0;
  double begin_ = 0.0;
};

// Returns the robots of each process.
Shares shares_of(ClientPlacement placement, std::uint32_t robots) {
  const std::uint32_t processes = process_count(placement, robots);
  Shares shares;
  for (std::uint32_t i = 0; i < processes; ++i)
    shares.emplace_back(robots * i / processes, robots * (i + 1) / processes);
  return shares;
}

std::vector<std::vector<std::string>> udp_clients(const Shares& shares, std::uint16_t port) {
  std::vector<std::vector<std::string>> arguments;
  for (const auto& [first, end] : shares)
    arguments.push_back({"--udp-port", std::to_string(port), "--number", std::to_string(arguments.size()),
                         "--command-bytes", std::to_string(command_bytes(end - first))});
  return arguments;
}

UdpFloor floor_of(const Shares& shares) {
  std::vector<std::size_t> observations;
  std::vector<std::size_t> commands;
  for (const auto& [first, end] : shares) {
    observations.push_back(observation_bytes(end - first));
    commands.push_back(command_bytes(end - first));
  }
  return {observations, commands};
}

// The raw UDP exchange takes its turns between two ticks of the server, on the server's thread: both methods run in the
// same minute, while the same processes wait.
class RowMeasurement {
 public:
  RowMeasurement(ClientPlacement placement, std::uint32_t robots, const LockstepOptions& options,
                 const Surroundings& surroundings)
      : shares_(shares_of(placement, robots)),
        options_(options),
        surroundings_(surroundings),
        floor_(floor_of(shares_)),
        udp_processes_(udp_clients(shares_, floor_.port()), [this](const std::string&) { broken_ = true; }),
        udp_counter_(udp_processes_) {
    row_.robots = robots;
    row_.placement = placement;
    row_.processes = static_cast<std::uint32_t>(shares_.size());
    for (const auto& [first, end] : shares_) {
      row_.observation_bytes += observation_bytes(end - first);
      row_.command_bytes += command_bytes(end - first);
    }
  }

  LockstepRow measure() {
    say("starting processes");
    if (!floor_.wait_for_clients(broken_, surroundings_.stop)) throw_why();
    LockstepRun run(row_.robots, 0, {shares_, options_.inline_step, 0.0});
    Counter counter(run.clients());
    bool is_warm = false;
    LockstepListener listener;
    listener.barrier = [&](double seconds) { counter.add_barrier(seconds); };
    listener.boundary = [&] {
      if (run.tick() == 0) return counter.begin();
      if (counter.add_tick() < (is_warm ? options_.seconds : warm_up)) return;
      if (is_warm) row_.cohort.push_back(counter.end());
      const LockstepTurn turn = exchange_for(is_warm ? options_.seconds : warm_up);
      if (is_warm) row_.udp.push_back(turn);
      is_warm = true;
      if (has_to_end() || row_.udp.size() == options_.repetitions) return run.stop();
      say(fmt::format("repetition {} of {}", row_.udp.size() + 1, options_.repetitions));
      counter.begin();
    };
    run.run(listener, surroundings_.stop);
    udp_processes_.may_end();
    if (has_to_end()) throw_why();
    return std::move(row_);
  }

 private:
  LockstepTurn exchange_for(double seconds) {
    udp_counter_.begin();
    do {
      const double begin = wall_seconds();
      if (!floor_.exchange(broken_, surroundings_.stop)) break;
      udp_counter_.add_barrier(wall_seconds() - begin);
    } while (udp_counter_.add_tick() < seconds);
    return udp_counter_.end();
  }

  bool has_to_end() const { return surroundings_.stop || broken_; }
  [[noreturn]] void throw_why() const {
    if (surroundings_.stop) throw Interrupted();
    throw std::runtime_error("a client of the UDP measurement ended");
  }

  void say(const std::string& what) const {
    surroundings_.progress(fmt::format("lockstep, {} robots, {}: {}", row_.robots, name_of(row_.placement), what));
  }

  Shares shares_;
  const LockstepOptions& options_;
  const Surroundings& surroundings_;
  std::atomic<bool> broken_ = false;
  UdpFloor floor_;
  BenchProcesses udp_processes_;
  Counter udp_counter_;
  LockstepRow row_;
};

}  // namespace

const std::vector<std::pair<std::string, ClientPlacement>>& placements() {
  static const std::vector<std::pair<std::string, ClientPlacement>> all = {
      {"one", ClientPlacement::one}, {"eights", ClientPlacement::eights}, {"each", ClientPlacement::each}};
  return all;
}

std::string name_of(ClientPlacement placement) {
  for (const auto& [name, value] : placements())
    if (value == placement) return name;
  return "?";
}

std::uint32_t process_count(ClientPlacement placement, std::uint32_t robots) {
  switch (placement) {
    case ClientPlacement::one: return 1;
    case ClientPlacement::eights: return (robots + 7) / 8;
    case ClientPlacement::each: return robots;
  }
  return 0;
}

Spread spread_of(const std::vector<LockstepTurn>& turns, double LockstepTurn::*quantity) {
  std::vector<double> values;
  values.reserve(turns.size());
  for (const LockstepTurn& turn : turns) values.push_back(turn.*quantity);
  return spread_of(std::move(values));
}

Spread LockstepRow::ratio() const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < cohort.size(); ++i) ratios.push_back(cohort[i].ticks_a_second / udp[i].ticks_a_second);
  return spread_of(std::move(ratios));
}

Spread LockstepRow::barrier_ratio() const {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < cohort.size(); ++i) ratios.push_back(udp[i].barrier_mean / cohort[i].barrier_mean);
  return spread_of(std::move(ratios));
}

LockstepResults measure_lockstep(const LockstepOptions& options, const Surroundings& surroundings,
                                 const std::function<void(const std::string&)>& print) {
  nlohmann::ordered_json all = {{"seconds", options.seconds},
                                {"repetitions", options.repetitions},
                                {"cores", std::thread::hardware_concurrency()},
                                {"inline", options.inline_step},
                                {"results", nlohmann::ordered_json::array()}};
  if (options.look_ahead) {
    print(look_ahead_heading());
    for (const LookAheadRow& row : measure_look_ahead(options, surroundings)) {
      print(line_of(row));
      all["results"].push_back(to_json(row));
    }
    return {all, {}};
  }
  std::vector<LockstepRow> rows;
  print(lockstep_heading());
  for (const ClientPlacement placement : options.placements)
    for (const std::uint32_t robots : options.robots) {
      rows.push_back(RowMeasurement(placement, robots, options, surroundings).measure());
      print(line_of(rows.back()));
      all["results"].push_back(to_json(rows.back()));
    }
  return {all, draw_rows(rows)};
}

}  // namespace cohort::bench
