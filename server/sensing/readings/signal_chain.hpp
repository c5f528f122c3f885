#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/core/channel.hpp"
#include "server/core/hash.hpp"
#include "server/core/random.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/readout.hpp"

namespace cohort::sensing {

/// What decides how the readings of one sensor come out and is the same for all robots of a model. Constant, and shared
/// by their signal chains.
class SignalPlan {
 public:
  SignalPlan(const description::Readout& readout, const std::vector<Channel>& channels, std::chrono::nanoseconds step);

 private:
  friend class SignalChain;
  struct Value {
    int noise = -1;         // place in the readout's, -1: none
    double constant = 0.0;  // bias and mean of the noise
    double lower = 0.0;
    double upper = 0.0;
    double neutral = 0.0;
  };
  int noise_on(const Channel& channel, std::uint32_t element) const;

  description::Readout readout_;
  std::vector<Value> values_;
  bool draws_bias_ = false;  // for each robot
  bool wanders_ = false;
  bool is_immediate_ = true;
  std::uint64_t period_ = 1;   // in ticks
  std::uint64_t latency_ = 0;  // in ticks
  double sample_time_ = 0.0;   // from one measurement to the next [s]
};

/// How the readings of one sensor of one robot come out: what description::Readout says, at work. Draws depend on seed,
/// robot, device, tick and value alone. One robot's is used by one thread at a time.
class SignalChain {
 public:
  /// `robot`: scoped name.
  SignalChain(std::shared_ptr<const SignalPlan> plan, std::uint64_t seed, const std::string& robot,
              const std::string& device);
  SignalChain(const description::Readout& readout, const std::vector<Channel>& channels, std::uint64_t seed,
              const std::string& robot, const std::string& device, std::chrono::nanoseconds step)
      : SignalChain(std::make_shared<const SignalPlan>(readout, channels, step), seed, robot, device) {}

  /// Whether readings are as old as the tick and need no memory; then `disturb` is all that there is to it.
  bool is_immediate() const { return plan_->is_immediate_; }
  /// Whether the sensor measures at this tick, for someone who asks it at `is_due` ticks.
  bool measures_at(std::uint64_t tick, bool is_due) const {
    return plan_->is_immediate_ ? is_due || plan_->wanders_ : tick % plan_->period_ == 0;
  }
  /// Adds all errors to what has been measured at this tick. What is infinite, where nothing was there to be measured,
  /// becomes the bound of its channel, if there is noise on the device at all. As `take` and `report`, it may be called
  /// again at the same tick, when something has been changed from outside; what it did before is then undone.
  void disturb(std::uint64_t tick, std::span<double> values);
  /// Takes what was measured at this tick, with its errors.
  void take(std::uint64_t tick, std::span<const double> values);
  /// What is reported at this tick, after all that was measured until then has been taken.
  void report(std::uint64_t tick, std::span<double> values);

  /// What decides later readings, beyond the observation itself; nothing if there is no such thing.
  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  void restore(SnapshotReader& reader);

 private:
  struct Report {
    std::uint64_t due = 0;  // the tick at which it arrives
    std::vector<double> values;
  };
  struct Memory {
    std::vector<double> constants;     // of each value, if a bias is drawn
    std::vector<double> drift;         // of each value, if any wanders
    std::vector<double> drift_before;  // before `drift_tick`
    std::uint64_t drift_tick = ~std::uint64_t{0};
    std::vector<double> reported;   // that holds now, unless it is immediate
    std::vector<Report> under_way;  // oldest first
  };
  template <class Memories, class Visit>
  static void visit_state(Memories& memory, Visit&& visit);

  std::shared_ptr<const SignalPlan> plan_;
  RandomStream random_;
  std::unique_ptr<Memory> memory_;  // null if it needs none
};

}  // namespace cohort::sensing
