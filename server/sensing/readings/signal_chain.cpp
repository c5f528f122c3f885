#include "server/sensing/readings/signal_chain.hpp"

#include <algorithm>
#include <cmath>

#include "server/core/state_visitors.hpp"

namespace cohort::sensing {
namespace {

// What is drawn; each value has draws of its own.
enum Draw : std::uint32_t { gaussian = 0, uniform = 1, drop_out = 2, bias = 3, drift = 4 };
constexpr std::uint32_t most_values = 1u << 24;
// What is drawn once is drawn at no tick.
constexpr std::uint64_t never = ~std::uint64_t{0};

std::uint32_t draw_of(Draw what, std::size_t value) {
  return static_cast<std::uint32_t>(value) + static_cast<std::uint32_t>(what) * most_values;
}

std::string quantity_of(const Channel& channel) { return channel.name.substr(channel.name.rfind('/') + 1); }

std::uint64_t whole_ticks(std::chrono::nanoseconds time, std::chrono::nanoseconds step) {
  return static_cast<std::uint64_t>((time + step / 2) / step);
}

}  // namespace

SignalChain::SignalChain(const description::Readout& readout, std::vector<Channel> channels, std::uint64_t seed,
                         const std::string& robot, const std::string& device, std::chrono::nanoseconds step)
    : readout_(readout), random_(seed, robot, device) {
  for (const Channel& channel : channels) {
    for (std::uint32_t i = 0; i < channel.size; ++i) {
      const int place = channel.is_measured ? noise_on(channel, i) : -1;
      Value value{place, 0.0, channel.lower, channel.upper};
      if (place >= 0) {
        const description::Noise& noise = readout_.noises[static_cast<std::size_t>(place)];
        wanders_ = wanders_ || noise.drift_deviation > 0.0;
        value.constant = noise.mean + noise.bias;
        if (noise.bias_deviation > 0.0)
          value.constant += noise.bias_deviation * random_.normal(never, draw_of(bias, values_.size()));
      }
      values_.push_back(value);
      reported_.push_back(channel.neutral);
    }
  }
  period_ = std::max<std::uint64_t>(1, whole_ticks(readout_.period, step));
  latency_ = whole_ticks(readout_.latency, step);
  sample_time_ = static_cast<double>(period_) * static_cast<double>(step.count()) * 1e-9;
  is_immediate_ = period_ == 1 && latency_ == 0 && readout_.drop_out == 0.0;
  if (is_immediate_) reported_.clear();
  if (wanders_) drift_.assign(values_.size(), 0.0);
  drift_before_ = drift_;
}

int SignalChain::noise_on(const Channel& channel, std::uint32_t element) const {
  int place = -1;
  for (std::size_t i = 0; i < readout_.noises.size(); ++i) {
    const description::Noise& noise = readout_.noises[i];
    if ((noise.quantity.empty() || noise.quantity == quantity_of(channel)) &&
        (noise.element < 0 || noise.element == static_cast<int>(element)))
      place = static_cast<int>(i);
  }
  return place;
}

// The bias that wanders is a first-order Gauss-Markov process, stepped exactly: its deviation is the given one at all
// times but the first ones, and it forgets itself by 1/e in `drift_time` (Gelb, "Applied Optimal Estimation", 1974,
// section 3.6).
void SignalChain::disturb(std::uint64_t tick, std::span<double> values) {
  if (readout_.noises.empty()) return;
  if (wanders_) {
    if (tick == drift_tick_)
      drift_ = drift_before_;
    else
      drift_before_ = drift_;
    drift_tick_ = tick;
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Value& value = values_[i];
    if (value.noise < 0) {
      if (std::isinf(values[i])) values[i] = std::clamp(values[i], value.lower, value.upper);
      continue;
    }
    const description::Noise& noise = readout_.noises[static_cast<std::size_t>(value.noise)];
    double reading = values[i] + value.constant;
    if (noise.deviation > 0.0) reading += noise.deviation * random_.normal(tick, draw_of(gaussian, i));
    if (noise.uniform > 0.0) reading += noise.uniform * (2.0 * random_.uniform(tick, draw_of(uniform, i)) - 1.0);
    if (noise.drift_deviation > 0.0) {
      const double kept = noise.drift_time > 0.0 ? std::exp(-sample_time_ / noise.drift_time) : 0.0;
      drift_[i] = kept * drift_[i] +
                  noise.drift_deviation * std::sqrt(1.0 - kept * kept) * random_.normal(tick, draw_of(drift, i));
      reading += drift_[i];
    }
    if (noise.precision > 0.0) reading = noise.precision * std::round(reading / noise.precision);
    values[i] = std::clamp(reading, value.lower, value.upper);
  }
}

void SignalChain::take(std::uint64_t tick, std::span<const double> values) {
  if (readout_.drop_out > 0.0 && random_.uniform(tick, draw_of(drop_out, 0)) < readout_.drop_out) return;
  if (!under_way_.empty() && under_way_.back().due == tick + latency_) under_way_.pop_back();
  under_way_.push_back({tick + latency_, {values.begin(), values.end()}});
}

void SignalChain::report(std::uint64_t tick, std::span<double> values) {
  while (!under_way_.empty() && under_way_.front().due <= tick) {
    reported_ = std::move(under_way_.front().values);
    under_way_.pop_front();
  }
  std::ranges::copy(reported_, values.begin());
}

template <class Self, class Visit>
void SignalChain::visit_state(Self& self, Visit&& visit) {
  for (auto& number : self.drift_) visit(number);
  for (auto& number : self.reported_) visit(number);
  for (auto& report : self.under_way_) {
    visit(report.due);
    for (auto& number : report.values) visit(number);
  }
}

void SignalChain::hash(StateHash& hash) const {
  visit_state(*this, [&](const auto& number) { hash.add(number); });
}

void SignalChain::save(SnapshotWriter& writer) const {
  writer.add_count(under_way_.size());
  visit_state(*this, StateSaver{writer});
  if (!wanders_) return;
  writer.add(drift_tick_);
  for (const double drift : drift_before_) writer.add(drift);
}

void SignalChain::restore(SnapshotReader& reader) {
  constexpr std::size_t least_bytes = sizeof(std::uint64_t);
  under_way_.assign(reader.read_count(least_bytes), {0, std::vector<double>(values_.size())});
  visit_state(*this, StateRestorer{reader});
  if (!wanders_) return;
  reader.read(drift_tick_);
  for (double& drift : drift_before_) reader.read(drift);
}

}  // namespace cohort::sensing
