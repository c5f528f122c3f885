// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "tests/commands/bench_command.hpp"

// Output of `cohort bench`. Durations are not checked.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::vector<std::string> known_engines() {
  return {"cohort", "cohort-matrix", "bullet", "ode-worldstep", "ode-quickstep", "mujoco", "enki"};
}

// Checks that each known engine is measured, skipped in this scene, or missing in this build. Returns the measured
// ones.
std::vector<Json> measured_engines(const Json& all, const Json& result) {
  std::vector<Json> measured;
  for (const std::string& name : known_engines()) {
    int mentioned = 0;
    for (const Json& engine : result["engines"]) {
      if (engine.value("engine", "") != name) continue;
      ++mentioned;
      if (!engine.contains("left_out")) measured.push_back(engine);
    }
    for (const Json& engine : all["missing_engines"])
      if (engine.value("engine", "") == name) ++mentioned;
    EXPECT_EQ(mentioned, 1) << name << " in " << result.dump(2);
  }
  return measured;
}

TEST(Bench, MeasuresAllEnginesOnTheSameCrowd) {
  const Measured measured = measure({"--scene", "crowd", "--robots", "16", "--seconds", "0.2"});
  ASSERT_EQ(measured.json["results"].size(), 1u) << measured.json;
  const Json& result = measured.json["results"][0];
  EXPECT_EQ(result.value("scene", ""), "crowd");
  EXPECT_EQ(result.value("robots", 0), 16);
  EXPECT_EQ(result.value("step_s", 0.0), 0.01);

  const std::vector<Json> engines = measured_engines(measured.json, result);
  ASSERT_FALSE(engines.empty());
  EXPECT_EQ(engines.front().value("engine", ""), "cohort");
  for (const Json& engine : engines) {
    expect_spread(engine["cpu_us_per_robot_step"]);
    expect_spread(engine["wall_us_per_robot_step"]);
    EXPECT_EQ(engine.value("threads", 0), 1);
    EXPECT_GE(engine.value("touches_per_robot", -1.0), 0.0);
    EXPECT_NEAR(engine.value("speed_ratio", 0.0), 1.0, 0.05) << engine;
    if (engine.value("engine", "") == "ode-quickstep") {
      EXPECT_EQ(engine["vs_ode_quickstep"], 1.0);
    }
  }
}

TEST(Bench, CollidingRobotsDoNotPenetrateInAnyEngine) {
  const Measured measured = measure({"--scene", "crowd_wheels", "--robots", "16", "--seconds", "1"});
  for (const Json& engine : measured_engines(measured.json, measured.json["results"][0]))
    EXPECT_LT(engine.value("deepest_overlap_m", 1.0), 0.01) << engine;
}

TEST(Bench, ReportsTheVersionsOfEngines) {
  const Measured measured = measure({"--scene", "free", "--robots", "1", "--seconds", "0.1"});
  const Json& versions = measured.json["engine_versions"];
  EXPECT_TRUE(versions.contains("bullet")) << versions;
  for (const Json& engine : measured.json["missing_engines"])
    EXPECT_FALSE(versions.contains(engine.value("engine", ""))) << versions;
  for (const auto& [engine, version] : versions.items())
    EXPECT_NE(measured.ended.out.find(engine + " " + version.get<std::string>()), std::string::npos)
        << measured.ended.out;
}

TEST(Bench, OnlyCohortUsesSeveralThreads) {
  const Measured measured =
      measure({"--scene", "free", "--robots", "1", "--seconds", "0.1", "--engines", "bullet", "--threads", "2"});
  const Json& engines = measured.json["results"][0]["engines"];
  ASSERT_EQ(engines.size(), 1u) << engines;
  EXPECT_EQ(engines[0].value("threads", 0), 1);
}

TEST(Bench, PrintsALineForEachEngineUnderOneHeading) {
  const Measured measured = measure({"--scene", "crowd", "--robots", "4", "--seconds", "0.1"});
  const std::vector<std::string> lines = lines_of(measured.ended.out);
  const auto title = std::find(lines.begin(), lines.end(), "crowd, 4 robots, steps of 10 ms");
  ASSERT_NE(title, lines.end()) << measured.ended.out;
  ASSERT_GT(std::distance(title, lines.end()), 2) << measured.ended.out;
  EXPECT_TRUE((title + 1)->starts_with("  engine ")) << measured.ended.out;
  for (const Json& engine : measured_engines(measured.json, measured.json["results"][0])) {
    const std::string start = "  " + engine.value("engine", "") + " ";
    const auto line = std::find_if(title, lines.end(), [&](const auto& text) { return text.starts_with(start); });
    ASSERT_NE(line, lines.end()) << start;
    EXPECT_EQ(line->size(), (title + 1)->size()) << "columns are not aligned: " << measured.ended.out;
  }
  for (const Json& engine : measured.json["missing_engines"]) {
    EXPECT_NE(measured.ended.out.find("not part of this build: " + engine.value("engine", "")), std::string::npos);
    EXPECT_NE(measured.ended.out.find(engine.value("package", "?")), std::string::npos);
  }
}

TEST(Bench, ComparesThreadsOfCohortInTheSameRun) {
  const Measured measured = measure(
      {"--scene", "crowd_wheels", "--robots", "4", "--seconds", "0.1", "--engines", "cohort", "--threads", "2"});
  const Json& engines = measured.json["results"][0]["engines"];
  ASSERT_EQ(engines.size(), 2u) << engines;
  EXPECT_EQ(engines[0].value("threads", 0), 1);
  EXPECT_TRUE(engines[0]["speed_up"].is_null());
  EXPECT_EQ(engines[1].value("threads", 0), 2);
  EXPECT_GT(engines[1].value("speed_up", 0.0), 0.0);
  EXPECT_EQ(engines[0]["touches_per_robot"], engines[1]["touches_per_robot"]) << "they do not drive alike";
  EXPECT_NEAR(engines[0].value("speed_ratio", 0.0), 1.0, 0.05);
}

TEST(Bench, DistantRobotsNeverTouch) {
  const Measured measured = measure({"--scene", "free", "--robots", "4", "--seconds", "0.2"});
  for (const Json& engine : measured_engines(measured.json, measured.json["results"][0]))
    EXPECT_EQ(engine.value("touches_per_robot", -1.0), 0.0) << engine;
}

TEST(Bench, NamesEnginesThatCannotConnectRobots) {
  const Measured measured = measure({"--scene", "chain", "--robots", "3", "--seconds", "0.1"});
  for (const Json& engine : measured.json["results"][0]["engines"]) {
    EXPECT_EQ(engine.contains("left_out"), !engine.contains("cpu_us_per_robot_step")) << engine;
    if (!engine.contains("left_out")) {
      EXPECT_LT(engine.value("connection_error_m", 1.0), 0.01) << engine;
      continue;
    }
    EXPECT_NE(measured.ended.out.find("skipped: " + engine.value("engine", "") + ": "), std::string::npos);
  }
}

// Cohort's own errors are deterministic, and have the values of docs/fidelity.md.
TEST(Bench, ComparesMotionWithExactSolutions) {
  const Measured measured = measure({"--scene", "accuracy", "--engines", "cohort"});
  const std::map<std::string, double> most = {{"free fall, distance in 1 s", 50.0},
                                              {"box sliding down a slope, speed after 1 s", 0.2},
                                              {"box at rest on a slope, creep in 5 s", 0.4},
                                              {"pendulum, period of 2 s", 0.1},
                                              {"double pendulum, energy of 29 J in 5 s, greatest", 3.2},
                                              {"tumbling box, energy after 10 s", 0.01},
                                              {"tumbling box, angular momentum after 10 s", 1e-6}};
  const Json& cases = measured.json["results"][0]["cases"];
  ASSERT_EQ(cases.size(), most.size()) << cases;
  for (const Json& of : cases) {
    ASSERT_TRUE(most.contains(of.value("case", ""))) << of;
    for (const Json& error : of["errors"]) {
      const double share = error.value("step_s", 0.0) == 0.01 ? 1.0 : 0.11;  // first order, or better
      EXPECT_LE(std::abs(error.value("error", 1e9)), share * most.at(of.value("case", ""))) << of;
    }
  }
}

// Engines differ in the softness of contacts and the rotation of free bodies, but not in how bodies fall and swing.
TEST(Bench, EnginesWithMechanismsFallAndSwingAlike) {
  const Measured measured = measure({"--scene", "accuracy"});
  std::set<std::string> compared = {"cohort", "cohort-matrix", "bullet", "mujoco"};
  for (const Json& engine : measured.json["missing_engines"]) compared.erase(engine.value("engine", ""));
  const std::map<std::string, double> alike = {{"free fall, distance in 1 s", 50.0},
                                               {"pendulum, period of 2 s", 0.1},
                                               {"double pendulum, energy of 29 J in 5 s, greatest", 3.2}};
  for (const Json& of : measured.json["results"][0]["cases"]) {
    std::set<std::string> engines;
    for (const Json& error : of["errors"]) {
      engines.insert(error.value("engine", ""));
      ASSERT_TRUE(error["error"].is_number()) << of;  // values that are not finite are null
      if (const auto most = alike.find(of.value("case", "")); most != alike.end()) {
        EXPECT_LE(std::abs(error.value("error", 1e9)), most->second) << of;
      }
    }
    EXPECT_EQ(engines, compared) << of;
  }
}

TEST(Bench, MeasuresRaysAndBuildingAWorld) {
  const Measured measured = measure({"--scene", "rays,build", "--robots", "50"});
  ASSERT_EQ(measured.json["results"].size(), 2u) << measured.json;
  for (const Json& result : measured.json["results"]) {
    if (result.value("scene", "") == "build") {
      for (const Json& engine : measured_engines(measured.json, result)) {
        expect_spread(engine["cpu_s"]);
        EXPECT_TRUE(engine["resident_bytes_per_robot"].is_number());
      }
    } else {
      EXPECT_EQ(result.value("scene", ""), "rays");
      ASSERT_EQ(result["densities"].size(), 2u);
      for (const Json& density : result["densities"]) expect_spread(density["mrays_per_s"]);
      EXPECT_LT(result["densities"][0]["hit_share"], result["densities"][1]["hit_share"]);
    }
  }
}

Measured measure_thesis(std::vector<std::string> arguments) {
  const ScratchFolder folder;
  const std::string file = (folder / "results.json").string();
  arguments.insert(arguments.begin(), {cohort_program(), "bench", "thesis"});
  arguments.insert(arguments.end(), {"--budget", "0.01", "--json", file});
  Measured measured{run_to_end(arguments), {}};
  EXPECT_EQ(measured.ended.exit_code, 0) << measured.ended.err;
  measured.json = read_json(file);
  return measured;
}

// Returns the columns of a row with their costs, in the order of the table, without those of missing engines.
void expect_costs(const Json& row, const std::vector<std::string>& columns) {
  for (const std::string& column : columns) {
    ASSERT_TRUE(row.contains(column)) << column << " in " << row;
    EXPECT_GT(row[column].value("seconds", 0.0), 0.0) << row;
    EXPECT_GT(row[column].value("us_per_robot_frame", 0.0), 0.0) << row;
  }
}

TEST(BenchThesis, ComparesProximitySensorsWithTheThesis) {
  const Measured measured = measure_thesis({"--table", "5.3", "--robots", "3,8", "--seconds", "0.2"});
  ASSERT_EQ(measured.json["results"].size(), 2u) << measured.json;
  EXPECT_NE(measured.ended.out.find("Table 5.3, proximity sensors: 2 frames of 100 ms"), std::string::npos);
  EXPECT_NE(measured.ended.out.find("Table 5.3, proximity sensors: 20 frames of 10 ms"), std::string::npos);
  for (const Json& table : measured.json["results"]) {
    ASSERT_EQ(table["rows"].size(), 2u) << table;
    for (const Json& row : table["rows"])
      expect_costs(row, {"ray", "samples", "shadow", "random_ray", "five_rays", "ray, whole tick"});
  }
  const Json& rows = measured.json["results"][0]["rows"];
  EXPECT_EQ(rows[1]["thesis raytracing"], 0.57722);
  EXPECT_EQ(rows[1]["thesis sampling"], 0.30498);
  EXPECT_EQ(rows[1]["thesis shadow"], 0.30375);
  EXPECT_TRUE(rows[0]["thesis shadow"].is_null()) << "the thesis has no row for 3 robots";
}

TEST(BenchThesis, RaysOfOdeHitTheSameObstacles) {
  const Measured measured = measure_thesis({"--table", "5.3", "--robots", "64", "--seconds", "0.1"});
  const Json& row = measured.json["results"][0]["rows"][0];
  EXPECT_GT(row["ray"].value("answer", 0.0), 0.01) << "nothing is near";
  if (row.contains("ODE rays")) {
    EXPECT_NEAR(row["ODE rays"].value("answer", 0.0), row["ray"].value("answer", 0.0), 1e-9);
  }
}

TEST(BenchThesis, PrintsLightAndSoundAndTheCostOfAThousandRobots) {
  const Measured measured = measure_thesis({"--table", "5.4", "--robots", "64,1000", "--seconds", "0.1"});
  const Json& rows = measured.json["results"][0]["rows"];
  ASSERT_EQ(rows.size(), 2u);
  for (const Json& row : rows) {
    expect_costs(row, {"light", "sound", "both", "both, whole tick"});
    const double seen = row["light"].value("answer", 0.0);
    EXPECT_GT(seen, 0.0);
    EXPECT_LT(seen, 1.0) << "no robot hides a lamp";
    if (row.contains("ODE rays of light")) {
      EXPECT_NEAR(row["ODE rays of light"].value("answer", 0.0), seen, 1e-3);
    }
  }
  EXPECT_NE(measured.ended.out.find("24 lamps and 24 sounds, 1000 robots"), std::string::npos) << measured.ended.out;
}

TEST(BenchThesis, RunsOnlySelectedTables) {
  const Measured measured = measure_thesis({"--table", "5.1", "--robots", "2", "--seconds", "0.1"});
  ASSERT_EQ(measured.json["results"].size(), 1u);
  const Json& row = measured.json["results"][0]["rows"][0];
  EXPECT_EQ(row["thesis worldstep"], 0.16606);
  EXPECT_GT(row["cohort 10 ms"].value("seconds", 0.0), 0.0);
  const Ended ended = run_to_end({cohort_program(), "bench", "thesis", "--table", "5.5"});
  EXPECT_EQ(ended.exit_code, 2);
}

// A copy of `cohort` in a folder without cohort-bench.
class BenchCommand : public ::testing::Test {
 protected:
  BenchCommand() {
    fs::create_directory(elsewhere_);
    fs::copy_file(cohort_program(), cohort_);
  }
  Ended run(const std::vector<std::string>& arguments) const {
    std::vector<std::string> command = {cohort_};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_to_end(command, {{"PATH", elsewhere_}});
  }
  // Makes a cohort-bench that prints its name and its arguments.
  static void make_bench(const fs::path& folder, const std::string& name) {
    const fs::path program = folder / "cohort-bench";
    write_file(program, "#!/bin/sh\nprintf '%s\\n' " + name + " \"$@\"\nexit 7\n");
    fs::permissions(program, fs::perms::owner_all);
  }

  const ScratchFolder folder_;
  const fs::path elsewhere_ = folder_ / "elsewhere";
  const fs::path cohort_ = folder_ / "cohort";
};

TEST_F(BenchCommand, StartsTheProgramBesideItsOwnWithTheSameArguments) {
  make_bench(elsewhere_, "elsewhere");
  make_bench(folder_.path(), "beside");
  const Ended ended = run({"--verbose", "bench", "thesis", "--json", "bench", "--help", "a b"});
  EXPECT_EQ(ended.out, "beside\n--verbose\nthesis\n--json\nbench\n--help\na b\n");
  EXPECT_EQ(ended.err, "");
  EXPECT_EQ(ended.exit_code, 7);
}

TEST_F(BenchCommand, StartsTheProgramInPathIfThereIsNoneBesideIt) {
  make_bench(elsewhere_, "elsewhere");
  const Ended ended = run({"bench", "--scene", "crowd"});
  EXPECT_EQ(ended.out, "elsewhere\n--scene\ncrowd\n");
  EXPECT_EQ(ended.exit_code, 7);
}

TEST_F(BenchCommand, SaysHowToGetTheProgramIfItIsMissing) {
  const Ended ended = run({"bench", "--help"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.out, "");
  EXPECT_EQ(ended.err, "cohort: error: 'cohort bench' requires the program cohort-bench, which is neither in " +
                           folder_.path().string() +
                           " nor in PATH; 'cmake --build --preset release --target cohort-bench' builds it from "
                           "source\n");
}

TEST_F(BenchCommand, SaysWhyTheProgramCannotStart) {
  make_bench(folder_.path(), "beside");
  fs::permissions(folder_ / "cohort-bench", fs::perms::owner_read);
  const Ended ended = run({"bench"});
  EXPECT_EQ(ended.exit_code, 2);
  EXPECT_EQ(ended.err, "cohort: error: cannot start cohort-bench: Permission denied\n");
}

TEST(Bench, RejectsAMissingEngineAndNamesItsPackage) {
  const Measured some = measure({"--scene", "rays", "--robots", "1"});
  for (const Json& engine : some.json["missing_engines"]) {
    const Ended ended = run_to_end({cohort_program(), "bench", "--engines", engine.value("engine", "")});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_NE(ended.err.find("is not part of this build: install the Debian package " + engine.value("package", "?")),
              std::string::npos)
        << ended.err;
    EXPECT_EQ(ended.out, "");
  }
}

}  // namespace
}  // namespace cohort::test
