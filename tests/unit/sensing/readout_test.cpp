// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "server/core/infinity.hpp"
#include "server/sensing/readings/signal_chain.hpp"

/// The path from measurement to reading, without a world.
namespace cohort::sensing {
namespace {

using namespace std::chrono_literals;

constexpr std::uint64_t samples = 20'000;

SignalChain readout_of(const description::Readout& readout, double lower = -infinity, double upper = infinity,
                       const std::string& robot = "robot", std::uint32_t size = 1, double neutral = 0.0) {
  return {readout, {{"sensor/0/reading", "1", size, lower, upper, neutral}}, 7, robot, "sensor", 10ms};
}
description::Readout with_noise(const description::Noise& noise) { return {{noise}}; }

double disturbed(SignalChain& readout, std::uint64_t tick, double value) {
  double values[] = {value};
  readout.disturb(tick, values);
  return values[0];
}

// Returns the reading at each tick for a measurement that is the tick's number. `neutral`: before the first report.
std::vector<double> reports(const description::Readout& described, std::uint64_t ticks, double neutral = 0.0) {
  SignalChain readout = readout_of(described, -infinity, infinity, "robot", 1, neutral);
  std::vector<double> out;
  for (std::uint64_t tick = 0; tick < ticks; ++tick) {
    double values[] = {static_cast<double>(tick)};
    if (readout.measures_at(tick, true)) readout.take(tick, values);
    readout.report(tick, values);
    out.push_back(values[0]);
  }
  return out;
}

TEST(Readout, KnowsWhenTheReportedValueWasMeasured) {
  constexpr double none = -1.0;
  const std::vector<description::Readout> all = {{{}, 0.0, 100ms, 30ms}, {{}, 0.0, 33ms, 27ms}, {{}, 0.0, 20ms, 95ms},
                                                 {{}, 0.6, 33ms, 7ms},   {{}, 0.9, 0ms, 0ms},   {{}, 1.0, 0ms, 0ms}};
  for (const description::Readout& described : all) {
    const SignalChain readout = readout_of(described);
    const std::vector<double> reported = reports(described, 1000, none);
    for (std::uint64_t tick = 0; tick < reported.size(); ++tick) {
      const std::optional<std::uint64_t> measured = readout.measurement_at(tick);
      EXPECT_EQ(measured ? static_cast<double>(*measured) : none, reported[tick]) << tick;
    }
  }
  EXPECT_EQ(readout_of({}).measurement_at(7), 7u);
}

TEST(Readout, OfAnExactSensorIsTheMeasuredValue) {
  SignalChain readout = readout_of({});
  EXPECT_TRUE(readout.is_immediate());
  EXPECT_EQ(disturbed(readout, 3, 0.123456789), 0.123456789);
}

TEST(Readout, GaussianNoiseHasItsMeanAndItsDeviation) {
  description::Noise noise;
  noise.mean = 0.5;
  noise.deviation = 2.0;
  SignalChain readout = readout_of(with_noise(noise));
  double sum = 0.0, squares = 0.0;
  for (std::uint64_t tick = 0; tick < samples; ++tick) {
    const double error = disturbed(readout, tick, 10.0) - 10.0;
    sum += error;
    squares += error * error;
  }
  const double n = samples;
  const double mean = sum / n;
  EXPECT_NEAR(mean, 0.5, 4.0 * 2.0 / std::sqrt(n));
  EXPECT_NEAR(std::sqrt(squares / n - mean * mean), 2.0, 4.0 * 2.0 / std::sqrt(2.0 * n));
}

TEST(Readout, UniformNoiseFillsItsRangeExactly) {
  description::Noise noise;
  noise.uniform = 0.25;
  SignalChain readout = readout_of(with_noise(noise));
  double least = 1.0, greatest = -1.0, squares = 0.0;
  for (std::uint64_t tick = 0; tick < samples; ++tick) {
    const double error = disturbed(readout, tick, 0.0);
    least = std::min(least, error);
    greatest = std::max(greatest, error);
    squares += error * error;
  }
  EXPECT_GE(least, -0.25);
  EXPECT_LE(greatest, 0.25);
  EXPECT_LT(least, -0.249);
  EXPECT_GT(greatest, 0.249);
  EXPECT_NEAR(squares / static_cast<double>(samples), 0.25 * 0.25 / 3.0, 0.001);
}

TEST(Readout, ABiasIsDrawnOnceForEachValueOfEachRobot) {
  description::Noise noise;
  noise.bias = 1.0;
  noise.bias_deviation = 0.5;
  std::set<double> biases;
  double sum = 0.0, squares = 0.0;
  constexpr int robots = 2000;
  for (int robot = 0; robot < robots; ++robot) {
    SignalChain readout = readout_of(with_noise(noise), -infinity, infinity, std::to_string(robot), 2);
    double first[] = {0.0, 0.0}, later[] = {0.0, 0.0};
    readout.disturb(0, first);
    readout.disturb(99, later);
    EXPECT_EQ(first[0], later[0]);
    EXPECT_EQ(first[1], later[1]);
    for (const double bias : first) {
      biases.insert(bias);
      sum += bias - 1.0;
      squares += (bias - 1.0) * (bias - 1.0);
    }
  }
  EXPECT_EQ(biases.size(), 2u * robots);
  EXPECT_NEAR(sum / (2 * robots), 0.0, 4.0 * 0.5 / std::sqrt(2.0 * robots));
  EXPECT_NEAR(std::sqrt(squares / (2 * robots)), 0.5, 0.03);
}

// A first-order Gauss-Markov process: the same deviation at all times after the first ones, correlated by
// exp(-t / drift_time).
TEST(Readout, ABiasDriftDecorrelatesInItsTimeConstant) {
  description::Noise noise;
  noise.drift_deviation = 0.2;
  noise.drift_time = 0.1;  // ten ticks
  SignalChain readout = readout_of(with_noise(noise));
  std::vector<double> drift;
  for (std::uint64_t tick = 0; tick < 200'000; ++tick) drift.push_back(disturbed(readout, tick, 0.0));
  double squares = 0.0, products = 0.0;
  for (std::size_t i = 100; i + 10 < drift.size(); ++i) {
    squares += drift[i] * drift[i];
    products += drift[i] * drift[i + 10];
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(drift.size() - 110)), 0.2, 0.005);
  EXPECT_NEAR(products / squares, std::exp(-1.0), 0.03);
}

TEST(Readout, ReadingsAreMultiplesOfThePrecisionWithinTheRange) {
  description::Noise noise;
  noise.deviation = 0.3;
  noise.precision = 0.25;
  SignalChain readout = readout_of(with_noise(noise), 0.0, 1.0);
  std::set<double> seen;
  for (std::uint64_t tick = 0; tick < 1000; ++tick) seen.insert(disturbed(readout, tick, 0.6));
  EXPECT_EQ(seen, (std::set<double>{0.0, 0.25, 0.5, 0.75, 1.0}));
}

TEST(Readout, NoiseAppliesToItsQuantityOnly) {
  description::Noise noise;
  noise.bias = 1.0;
  noise.quantity = "velocity";
  SignalChain readout({{noise}},
                      {{"motor/0/position", "rad", 1, -infinity, infinity},
                       {"motor/0/velocity", "rad/s", 1, -infinity, infinity},
                       {"motor/0/count", "1", 1, -infinity, infinity, 0.0, false}},
                      7, "robot", "motor", 10ms);
  double values[] = {5.0, 5.0, 5.0};
  readout.disturb(0, values);
  EXPECT_EQ(values[0], 5.0);
  EXPECT_EQ(values[1], 6.0);
  EXPECT_EQ(values[2], 5.0);
}

TEST(Readout, ARateHoldsTheLastReading) {
  EXPECT_EQ(reports({{}, 0.0, 30ms, 0ms}, 8), (std::vector<double>{0, 0, 0, 3, 3, 3, 6, 6}));
}

TEST(Readout, ALatencyDelaysEveryReading) {
  EXPECT_EQ(reports({{}, 0.0, 0ms, 20ms}, 6), (std::vector<double>{0, 0, 0, 1, 2, 3}));
  EXPECT_EQ(reports({{}, 0.0, 20ms, 30ms}, 10), (std::vector<double>{0, 0, 0, 0, 0, 2, 2, 4, 4, 6}));
}

// One reading for each tick, with a step of 10 ms.
TEST(Readout, ARateIsExactOnAverageIfItsPeriodIsNoWholeNumberOfSteps) {
  for (const int rate : {30, 60, 70, 99}) {
    const std::chrono::nanoseconds period(std::llround(1e9 / rate));
    const std::vector<double> out = reports({{}, 0.0, period, 0ms}, 100'000);
    std::size_t measurements = 1;
    for (std::size_t tick = 1; tick < out.size(); ++tick)
      if (out[tick] != out[tick - 1]) ++measurements;
    EXPECT_NEAR(static_cast<double>(measurements), rate * 1000.0, 2.0) << rate;
  }
  EXPECT_EQ(reports({{}, 0.0, 33'333'333ns, 0ms}, 11), (std::vector<double>{0, 0, 0, 3, 3, 3, 3, 7, 7, 7, 10}));
}

TEST(Readout, ALatencyIsExactOnAverageIfItIsNoWholeNumberOfSteps) {
  for (const auto latency : {4ms, 15ms, 33ms}) {
    const std::vector<double> out = reports({{}, 0.0, 50ms, latency}, 100'000);
    double sum = 0.0;  // sum of the ages of readings when they are reported
    std::size_t count = 0;
    for (std::size_t tick = 1; tick < out.size(); ++tick)
      if (out[tick] != out[tick - 1]) {
        sum += static_cast<double>(tick) - out[tick];
        ++count;
      }
    EXPECT_NEAR(sum / static_cast<double>(count), 1e-7 * static_cast<double>(std::chrono::nanoseconds(latency).count()),
                1e-3);
  }
}

TEST(Readout, ARateThatDividesTheStepRateUpToNanosecondsIsRegular) {
  // Steps of 1/30 s and 1/60 s, rounded.
  EXPECT_TRUE(PeriodicTicks(100'000'000ns, 33'333'333ns).contains(3'000'000'000));
  EXPECT_EQ(PeriodicTicks(100'000'000ns, 33'333'333ns).count(3'000'000'000), 1'000'000'000U);
  EXPECT_TRUE(PeriodicTicks(16'666'667ns, 16'666'666ns).is_every_tick());
  EXPECT_EQ(PeriodicTicks(33'333'333ns, 16'666'667ns).count(2'000'000'000), 1'000'000'000U);
  EXPECT_EQ(PeriodicTicks(33'333'333ns, 10ms).count(3'000'000'000), 900'000'009U) << "at 30 Hz";
}

TEST(Readout, ADropoutKeepsThePreviousReading) {
  const std::vector<double> out = reports({{}, 0.3, 0ms, 0ms}, samples);
  std::uint64_t dropped = 0;
  for (std::uint64_t tick = 1; tick < samples; ++tick) {
    const bool is_new = out[tick] == static_cast<double>(tick);
    if (!is_new) ++dropped;
    EXPECT_TRUE(is_new || out[tick] == out[tick - 1]) << tick;
  }
  EXPECT_NEAR(static_cast<double>(dropped) / samples, 0.3, 4.0 * std::sqrt(0.3 * 0.7 / samples));
}

TEST(Readout, ContinuesIdenticallyFromASnapshot) {
  description::Noise noise;
  noise.drift_deviation = 0.2;
  noise.drift_time = 1.0;
  const description::Readout described{{noise}, 0.2, 20ms, 50ms};
  const auto run = [](SignalChain& readout, std::uint64_t from, std::uint64_t to) {
    std::vector<double> out;
    for (std::uint64_t tick = from; tick < to; ++tick) {
      double values[] = {static_cast<double>(tick)};
      if (readout.measures_at(tick, true)) {
        readout.disturb(tick, values);
        readout.take(tick, values);
      }
      readout.report(tick, values);
      out.push_back(values[0]);
    }
    return out;
  };
  SignalChain readout = readout_of(described);
  run(readout, 0, 31);
  SnapshotWriter writer;
  readout.save(writer);
  StateHash hash;
  readout.hash(hash);
  SignalChain restored = readout_of(described);
  SnapshotReader reader(writer.bytes());
  restored.restore(reader);
  EXPECT_TRUE(reader.is_at_end());
  StateHash again;
  restored.hash(again);
  EXPECT_EQ(hash.value(), again.value());
  EXPECT_EQ(run(restored, 31, 100), run(readout, 31, 100));
}

}  // namespace
}  // namespace cohort::sensing
