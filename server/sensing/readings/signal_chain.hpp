// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "server/core/channel.hpp"
#include "server/core/hash.hpp"
#include "server/core/periodic_ticks.hpp"
#include "server/core/random.hpp"
#include "server/core/snapshot.hpp"
#include "server/description/readout.hpp"

namespace cohort::sensing {

/// Constant parameters of one sensor's signal chain, which are the same for all robots of a model and shared by their
/// chains.
class SignalPlan {
 public:
  SignalPlan(const description::Readout& readout, const std::vector<Channel>& channels, std::chrono::nanoseconds step);

 private:
  friend class SignalChain;
  struct Value {
    int noise = -1;         // index in the readout's noises, -1: none
    double constant = 0.0;  // bias plus mean of the noise
    double lower = 0.0;
    double upper = 0.0;
    double neutral = 0.0;
  };
  std::uint64_t latency_of(std::uint64_t measurement) const;

  description::Readout readout_;
  std::vector<Value> values_;
  bool draws_bias_ = false;  // for each robot
  bool wanders_ = false;
  bool is_immediate_ = true;
  std::chrono::nanoseconds step_;
  PeriodicTicks measurements_;
  std::uint64_t latency_ = 0;                   // in whole ticks
  std::chrono::nanoseconds latency_beyond_{0};  // the rest, less than a step
  double sample_time_ = 0.0;                    // from one measurement to the next [s]
};

/// The signal chain of one sensor of one robot, which implements description::Readout. Draws depend only on seed,
/// robot, device, tick and value. Each robot's chains are for one thread at a time.
class SignalChain {
 public:
  /// `robot`: scoped name.
  SignalChain(std::shared_ptr<const SignalPlan> plan, std::uint64_t seed, const std::string& robot,
              const std::string& device);
  SignalChain(const description::Readout& readout, const std::vector<Channel>& channels, std::uint64_t seed,
              const std::string& robot, const std::string& device, std::chrono::nanoseconds step)
      : SignalChain(std::make_shared<const SignalPlan>(readout, channels, step), seed, robot, device) {}

  /// Returns true if readings have no delay and need no memory; then only `disturb` is needed.
  bool is_immediate() const { return plan_->is_immediate_; }
  /// Returns true if the sensor measures at this tick. `is_due`: the robot is due at this tick.
  bool measures_at(std::uint64_t tick, bool is_due) const {
    return plan_->is_immediate_ ? is_due || plan_->wanders_ : plan_->measurements_.contains(tick);
  }
  /// Adds all errors to the values measured at this tick. Infinite values, which mean that the measured quantity is out
  /// of range, become the bound of their channel if the device has noise. Like `take` and `report`, it may be called
  /// again at the same tick after a change from outside, and then replaces its previous result.
  void disturb(std::uint64_t tick, std::span<double> values);
  /// Takes the values measured at this tick, with their errors.
  void take(std::uint64_t tick, std::span<const double> values);
  /// Returns the reading that is reported at this tick, after all previous measurements were taken.
  void report(std::uint64_t tick, std::span<double> values);

  /// Returns the tick of the measurement that is reported at this tick; nothing before the first report. The sensor has
  /// measured since tick 0.
  std::optional<std::uint64_t> measurement_at(std::uint64_t tick) const;

  /// Adds the state that determines later readings, besides the observation itself, to the hash; adds nothing if there
  /// is none.
  void hash(StateHash& hash) const;
  void save(SnapshotWriter& writer) const;
  void restore(SnapshotReader& reader);

 private:
  struct Report {
    std::uint64_t due = 0;  // tick of arrival
    std::vector<double> values;
  };
  struct Memory {
    std::vector<double> constants;     // by value, if a bias is drawn
    std::vector<double> drift;         // by value, if any drifts
    std::vector<double> drift_before;  // values before `drift_tick`
    std::uint64_t drift_tick = ~std::uint64_t{0};
    std::vector<double> reported;   // current reading, unless it is immediate
    std::vector<Report> under_way;  // oldest first
  };
  bool is_lost(std::uint64_t measured) const;
  template <class Memories, class Visit>
  static void visit_state(Memories& memory, Visit&& visit);

  std::shared_ptr<const SignalPlan> plan_;
  RandomStream random_;
  std::unique_ptr<Memory> memory_;  // null if it needs none
};

}  // namespace cohort::sensing
