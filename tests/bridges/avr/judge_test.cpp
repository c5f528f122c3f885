// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "tests/support/node_folder.hpp"
#include "tests/support/process.hpp"
#include "tools/bridges/avr/core.hpp"

// Another simulator, avr8js, runs the same images.
namespace cohort::avr {
namespace {

using nlohmann::json;

constexpr std::uint64_t cycles = 3'200'000;
constexpr int pins = 6;

// Outputs of a run of an image: cycles of the edges of each pin of port B, and bytes.
struct Signals {
  std::vector<std::vector<std::int64_t>> edges = std::vector<std::vector<std::int64_t>>(pins);
  std::string sent;
  std::vector<std::int64_t> sent_at{};  // [cycle], where a byte begins or ends
};

Signals of_ours(const std::string& image, const std::string& mcu) {
  Signals signals;
  Core core(read_image(image), {mcu, 16'000'000, 5.0});
  for (int bit = 0; bit < pins; ++bit)
    core.outputs().watch({'B', bit}).edge = [&signals, bit](std::uint64_t cycle, bool) {
      signals.edges[static_cast<std::size_t>(bit)].push_back(static_cast<std::int64_t>(cycle));
    };
  core.connect_serial(0, [&](std::uint8_t byte) {
    signals.sent += static_cast<char>(byte);
    signals.sent_at.push_back(static_cast<std::int64_t>(core.cycle()));
  });
  core.run_until(cycles);
  return signals;
}

Signals of_theirs(const json& found) {
  Signals signals;
  int before = 0;
  for (const json& change : found["edges"]) {
    const int levels = change[1];
    for (int bit = 0; bit < pins; ++bit)
      if (((levels ^ before) >> bit & 1) != 0) signals.edges[static_cast<std::size_t>(bit)].push_back(change[0]);
    before = levels;
  }
  for (const json& byte : found["bytes"]) {
    signals.sent += static_cast<char>(byte[1].get<int>());
    signals.sent_at.push_back(byte[0]);
  }
  return signals;
}

class AvrJudge : public ::testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(COHORT_AVR_FIRMWARE "/edges.hex"))
      GTEST_SKIP() << "there is no avr-gcc: tools/dev/install-packages tools/dev/packages-avr.txt";
    if (const auto missing = folder.prepare(script)) GTEST_SKIP() << *missing;
  }
  inline static const std::string script = "judge.mjs";
  inline static const test::NodeFolder folder{COHORT_NODE, COHORT_NPM, COHORT_SOURCE_DIR "/tests/bridges/avr",
                                              COHORT_NODE_FOLDER};
};

TEST_P(AvrJudge, AnotherSimulatorMakesTheSameEdgesAtTheSameCycles) {
  const std::string mcu = GetParam();
  const std::string image = std::string(COHORT_AVR_FIRMWARE) + (mcu == "atmega2560" ? "/mega.hex" : "/edges.hex");
  const test::Ended ended = folder.run(script, {image, mcu, std::to_string(cycles)});
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
  const Signals theirs = of_theirs(json::parse(ended.out)), ours = of_ours(image, mcu);

  // A loop: each edge at the same cycle.
  EXPECT_EQ(ours.edges[5].size(), 200U);
  EXPECT_EQ(ours.edges[5], theirs.edges[5]);
  EXPECT_EQ(ours.sent, "Hello, judge!\n");
  EXPECT_EQ(ours.sent, theirs.sent);
  // Ten bits of 136 cycles, and the loop that waits for their end. The first two are taken at once.
  for (std::size_t i = 3; i < ours.sent.size(); ++i)
    EXPECT_NEAR(static_cast<double>(ours.sent_at[i] - ours.sent_at[i - 1]),
                static_cast<double>(theirs.sent_at[i] - theirs.sent_at[i - 1]), 10.0);

  // Edges in interrupts of three timers: the same distances, but for the instruction that an interrupt waits for, other
  // interrupts before it, and some cycles of latency. Serial bytes take different times, so the beginnings differ.
  for (const std::size_t pin : {0U, 1U, 2U}) {
    const auto& mine = ours.edges[pin];
    const auto& other = theirs.edges[pin];
    const std::size_t count = std::min(mine.size(), other.size());
    ASSERT_GT(count, 150U) << "PB" << pin;
    std::int64_t worst = 0;
    for (std::size_t i = 2; i < count; ++i)
      worst = std::max(worst, std::abs((mine[i] - mine[1]) - (other[i] - other[1])));
    EXPECT_LT(worst, 120) << "PB" << pin;
  }
}

INSTANTIATE_TEST_SUITE_P(Chips, AvrJudge, ::testing::Values("atmega328p", "atmega2560"),
                         [](const auto& chip) { return std::string(chip.param); });

}  // namespace
}  // namespace cohort::avr
