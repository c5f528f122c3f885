// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <utility>

#include "tests/commands/bench_command.hpp"

// Output of `cohort bench lockstep`. Durations are not checked.
namespace cohort::test {
namespace {

using Json = nlohmann::json;

Measured measure_lockstep(std::vector<std::string> arguments, bool draws = true) {
  arguments.insert(arguments.begin(), "lockstep");
  return measure(std::move(arguments), draws);
}

// Both methods, with any durations.
void expect_row(const Json& row) {
  for (const char* way : {"cohort", "udp"})
    for (const char* quantity :
         {"ticks_per_s", "barrier_p50_us", "barrier_p99_us", "server_cpu_us_per_tick", "clients_cpu_us_per_tick"})
      expect_spread(row[way][quantity]);
  expect_spread(row["ratio"]);
  expect_spread(row["barrier_ratio"]);
  EXPECT_GT(row.value("world_share", -1.0), 0.0) << row;
  EXPECT_LT(row.value("world_share", 1.0), 1.0) << row;
  EXPECT_GT(row.value("observation_bytes_per_tick", 0), 480 * row.value("robots", 1)) << row;
  EXPECT_GT(row.value("command_bytes_per_tick", 0), 40 * row.value("robots", 1)) << row;
}

TEST(BenchLockstep, PrintsBothMethodsAndTheirRatioForEachPlacement) {
  const Measured measured = measure_lockstep({"--robots", "1,8", "--seconds", "0.2"});
  const Json& rows = measured.json["results"];
  ASSERT_EQ(rows.size(), 6u) << measured.json;
  std::size_t i = 0;
  for (const char* place : {"one", "eights", "each"})
    for (const int robots : {1, 8}) {
      const Json& row = rows[i++];
      EXPECT_EQ(row.value("placement", ""), place);
      EXPECT_EQ(row.value("robots", 0), robots);
      EXPECT_EQ(row.value("processes", 0), std::string(place) == "each" ? robots : 1);
      expect_row(row);
    }
  EXPECT_TRUE(measured.ended.out.starts_with("place ")) << measured.ended.out;
  EXPECT_NE(measured.ended.out.find("UDP t/s"), std::string::npos) << measured.ended.out;
  for (const char* start : {"\none  ", "\neights  ", "\neach  "})
    EXPECT_NE(measured.ended.out.find(start), std::string::npos) << measured.ended.out;
  EXPECT_TRUE(measured.svg.starts_with("<svg ")) << measured.svg;
  EXPECT_NE(measured.svg.find("Raw UDP"), std::string::npos);
}

TEST(BenchLockstep, MeasuresClientsWithASeparateThread) {
  const Measured measured =
      measure_lockstep({"--robots", "2", "--placement", "each", "--seconds", "0.1", "--own-thread"});
  ASSERT_EQ(measured.json["results"].size(), 1u) << measured.json;
  EXPECT_EQ(measured.json.value("inline", true), false);
  expect_row(measured.json["results"][0]);
}

TEST(BenchLockstep, MeasuresLookAheadWithADelay) {
  const Measured measured = measure_lockstep({"--look-ahead", "--seconds", "0.1"}, false);
  const Json& rows = measured.json["results"];
  ASSERT_EQ(rows.size(), 6u) << measured.json;
  for (std::size_t i = 0; i < rows.size(); i += 2) {
    EXPECT_EQ(rows[i].value("delay", -1), 0);
    EXPECT_EQ(rows[i + 1].value("delay", -1), 1);
    EXPECT_EQ(rows[i]["work_ms"], rows[i + 1]["work_ms"]);
    // Two computations one after the other take at least the sum of their times, even on a busy machine.
    EXPECT_GE(rows[i]["ratio"].value("min", 0.0), 1.9) << rows[i];
    EXPECT_GE(rows[i + 1]["ratio"].value("min", 0.0), 0.9) << rows[i + 1];
  }
}

TEST(BenchLockstep, RejectsAnUnknownPlacement) {
  const Ended ended = run_to_end({cohort_program(), "bench", "lockstep", "--placement", "eigths"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_NE(ended.err.find("eights"), std::string::npos) << ended.err;
}

}  // namespace
}  // namespace cohort::test
