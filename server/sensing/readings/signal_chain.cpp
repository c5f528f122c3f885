// SPDX-License-Identifier: Apache-2.0
#include "server/sensing/readings/signal_chain.hpp"

#include <algorithm>
#include <cmath>

#include "server/core/state_visitors.hpp"

namespace cohort::sensing {
namespace {

// Kinds of random draws; each value has draws of its own.
enum Draw : std::uint32_t { gaussian = 0, uniform = 1, drop_out = 2, bias = 3, drift = 4 };
constexpr std::uint32_t most_values = 1u << 24;
// The tick of draws that are made only once.
constexpr std::uint64_t never = ~std::uint64_t{0};

std::uint32_t draw_of(Draw what, std::size_t value) {
  return static_cast<std::uint32_t>(value) + static_cast<std::uint32_t>(what) * most_values;
}

std::string quantity_of(const Channel& channel) { return channel.name.substr(channel.name.rfind('/') + 1); }

}  // namespace

SignalPlan::SignalPlan(const description::Readout& readout, const std::vector<Channel>& channels,
                       std::chrono::nanoseconds step)
    : readout_(readout), step_(step), measurements_(readout.period, step) {
  for (const Channel& channel : channels) {
    for (std::uint32_t i = 0; i < channel.size; ++i) {
      const int place = channel.is_measured ? description::noise_on(readout_, quantity_of(channel), i) : -1;
      Value value{place, 0.0, channel.lower, channel.upper, channel.neutral};
      if (place >= 0) {
        const description::Noise& noise = readout_.noises[static_cast<std::size_t>(place)];
        wanders_ = wanders_ || noise.drift_deviation > 0.0;
        draws_bias_ = draws_bias_ || noise.bias_deviation > 0.0;
        value.constant = noise.mean + noise.bias;
      }
      values_.push_back(value);
    }
  }
  const std::optional<std::uint64_t> whole_latency = whole_steps(readout_.latency, step);
  latency_ = whole_latency.value_or(static_cast<std::uint64_t>(readout_.latency / step));
  if (!whole_latency) latency_beyond_ = readout_.latency % step;
  sample_time_ = static_cast<double>(measurements_.period().count()) * 1e-9;
  const bool has_latency = latency_ > 0 || latency_beyond_.count() > 0;
  is_immediate_ = measurements_.is_every_tick() && !has_latency && readout_.drop_out == 0.0;
}

// Returns the ticks from a measurement, by its number, to its report. A part of a tick becomes a whole one for some of
// the measurements, so that the average is exact.
std::uint64_t SignalPlan::latency_of(std::uint64_t measurement) const {
  if (latency_beyond_.count() == 0) return latency_;
  const auto ticks_before = [&](std::uint64_t number) {
    return static_cast<std::uint64_t>((static_cast<std::int64_t>(number) * latency_beyond_ + step_ / 2) / step_);
  };
  return latency_ + ticks_before(measurement + 1) - ticks_before(measurement);
}

SignalChain::SignalChain(std::shared_ptr<const SignalPlan> plan, std::uint64_t seed, const std::string& robot,
                         const std::string& device)
    : plan_(std::move(plan)), random_(seed, robot, device) {
  if (plan_->is_immediate_ && !plan_->draws_bias_ && !plan_->wanders_) return;
  memory_ = std::make_unique<Memory>();
  const std::vector<SignalPlan::Value>& values = plan_->values_;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const SignalPlan::Value& value = values[i];
    if (!plan_->is_immediate_) memory_->reported.push_back(value.neutral);
    if (!plan_->draws_bias_) continue;
    double& constant = memory_->constants.emplace_back(value.constant);
    if (value.noise < 0) continue;
    const double deviation = plan_->readout_.noises[static_cast<std::size_t>(value.noise)].bias_deviation;
    if (deviation > 0.0) constant += deviation * random_.normal(never, draw_of(bias, i));
  }
  if (plan_->wanders_) memory_->drift.assign(values.size(), 0.0);
  memory_->drift_before = memory_->drift;
}

// The bias drift is a first-order Gauss-Markov process, stepped exactly. Its standard deviation is the given one,
// except at the start, and its autocorrelation decreases by 1/e in `drift_time` (Gelb, "Applied Optimal Estimation",
// 1974, section 3.6).
void SignalChain::disturb(std::uint64_t tick, std::span<double> values) {
  const std::vector<description::Noise>& noises = plan_->readout_.noises;
  if (noises.empty()) return;
  if (plan_->wanders_) {
    if (tick == memory_->drift_tick)
      memory_->drift = memory_->drift_before;
    else
      memory_->drift_before = memory_->drift;
    memory_->drift_tick = tick;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const SignalPlan::Value& value = plan_->values_[i];
    if (value.noise < 0) {
      if (std::isinf(values[i])) values[i] = std::clamp(values[i], value.lower, value.upper);
      continue;
    }
    const description::Noise& noise = noises[static_cast<std::size_t>(value.noise)];
    double reading = values[i] + (plan_->draws_bias_ ? memory_->constants[i] : value.constant);
    if (noise.deviation > 0.0) reading += noise.deviation * random_.normal(tick, draw_of(gaussian, i));
    if (noise.uniform > 0.0) reading += noise.uniform * (2.0 * random_.uniform(tick, draw_of(uniform, i)) - 1.0);
    if (noise.drift_deviation > 0.0) {
      const double kept = noise.drift_time > 0.0 ? std::exp(-plan_->sample_time_ / noise.drift_time) : 0.0;
      double& wandered = memory_->drift[i];
      wandered = kept * wandered +
                 noise.drift_deviation * std::sqrt(1.0 - kept * kept) * random_.normal(tick, draw_of(drift, i));
      reading += wandered;
    }
    if (noise.precision > 0.0) reading = noise.precision * std::round(reading / noise.precision);
    values[i] = std::clamp(reading, value.lower, value.upper);
  }
}

// Returns whether the report of the measurement of a tick is lost.
bool SignalChain::is_lost(std::uint64_t measured) const {
  const double drop_out_rate = plan_->readout_.drop_out;
  return drop_out_rate > 0.0 && random_.uniform(measured, draw_of(drop_out, 0)) < drop_out_rate;
}

std::optional<std::uint64_t> SignalChain::measurement_at(std::uint64_t tick) const {
  if (plan_->is_immediate_) return tick;
  constexpr double always = 1.0;
  if (tick < plan_->latency_ || plan_->readout_.drop_out >= always) return std::nullopt;
  const PeriodicTicks& measurements = plan_->measurements_;
  for (std::uint64_t number = measurements.count(tick - plan_->latency_) + 1; number-- > 0;) {
    const std::uint64_t measured = measurements.tick_of(number);
    if (measured + plan_->latency_of(number) <= tick && !is_lost(measured)) return measured;
  }
  return std::nullopt;
}

void SignalChain::take(std::uint64_t tick, std::span<const double> values) {
  if (is_lost(tick)) return;
  std::vector<Report>& under_way = memory_->under_way;
  const std::uint64_t due = tick + plan_->latency_of(plan_->measurements_.count(tick));
  if (!under_way.empty() && under_way.back().due == due) under_way.pop_back();
  under_way.push_back({due, {values.begin(), values.end()}});
}

void SignalChain::report(std::uint64_t tick, std::span<double> values) {
  std::vector<Report>& under_way = memory_->under_way;
  auto next = under_way.begin();
  for (; next != under_way.end() && next->due <= tick; ++next) memory_->reported = std::move(next->values);
  under_way.erase(under_way.begin(), next);
  std::ranges::copy(memory_->reported, values.begin());
}

template <class Memories, class Visit>
void SignalChain::visit_state(Memories& memory, Visit&& visit) {
  for (auto& number : memory.drift) visit(number);
  for (auto& number : memory.reported) visit(number);
  for (auto& report : memory.under_way) {
    visit(report.due);
    for (auto& number : report.values) visit(number);
  }
}

void SignalChain::hash(StateHash& hash) const {
  if (memory_) visit_state(std::as_const(*memory_), [&](const auto& number) { hash.add(number); });
}

void SignalChain::save(SnapshotWriter& writer) const {
  writer.add_count(memory_ ? memory_->under_way.size() : 0);
  if (!memory_) return;
  visit_state(std::as_const(*memory_), StateSaver{writer});
  if (!plan_->wanders_) return;
  writer.add(memory_->drift_tick);
  for (const double drift : memory_->drift_before) writer.add(drift);
}

void SignalChain::restore(SnapshotReader& reader) {
  constexpr std::size_t least_bytes = sizeof(std::uint64_t);
  const std::size_t reports = reader.read_count(least_bytes);
  if (reports > 0 && plan_->is_immediate_) throw SnapshotError("snapshot: a delayed reading of a sensor without delay");
  if (!memory_) return;
  memory_->under_way.assign(reports, {0, std::vector<double>(plan_->values_.size())});
  visit_state(*memory_, StateRestorer{reader});
  if (!plan_->wanders_) return;
  reader.read(memory_->drift_tick);
  for (double& drift : memory_->drift_before) reader.read(drift);
}

}  // namespace cohort::sensing
