// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/recording/recording.hpp"
#include "tests/commands/cohort_command.hpp"
#include "tests/support/control.hpp"
#include "tests/support/recordings.hpp"
#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {
namespace {

// Runs `cohort` with these arguments.
// Two robots that drive for two seconds, recorded.
class Recordings : public ::testing::Test {
 protected:
  std::string record(const std::string& name, const std::vector<std::string>& more = {},
                     const std::string& velocity = "0.1") {
    const FieldOfRobots field(
        2, 2.0, "", "constant, parameters: {treel/left/velocity: 0.1, treel/right/velocity: " + velocity + "}");
    const std::string file = folder_ / name;
    std::vector<std::string> arguments = {"--controllers", "inprocess", "--record", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_experiment(field.file(), arguments);
    return file;
  }
  std::string operator/(const std::string& name) const { return folder_ / name; }

 private:
  ScratchFolder folder_;
};

TEST_F(Recordings, AreReplayedWithoutTheirExperiment) {
  const std::string file = record("run.mcap");
  const Ended replayed = cohort({"replay", file});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
  EXPECT_TRUE(replayed.out.starts_with("replayed 201 ticks, state hash ")) << replayed.out;
  EXPECT_EQ(cohort({"replay", file, "--verify", "--from", "0.5", "--to", "1"}).out, "identical, 51 ticks\n");
}

TEST_F(Recordings, ListTheirContents) {
  const std::string file = record("run.mcap");
  const Ended listed = cohort({"recordings", "list", file, file});
  EXPECT_EQ(listed.exit_code, 0) << listed.err;
  EXPECT_TRUE(listed.out.starts_with(file + "\n")) << listed.out;
  for (const char* fact : {"\n  robots                 2\n", "\n  end                    finished\n", " bytes, inputs/",
                           "/robots/sbot/model.sdf\n"})
    EXPECT_NE(listed.out.find(fact), std::string::npos) << fact << listed.out;
}

// Simulates a disk that is full after 100 kB with a limit of file sizes.
TEST_F(Recordings, AreReportedIfTheyEndEarlyAndEndTheRunOnRequest) {
  const std::string file = *this / "run.mcap";
  const std::string summary = *this / "summary.json";
  const auto run = [&](const FieldOfRobots& field, const std::string& controllers,
                       const std::vector<std::string>& more) {
    std::vector<std::string> command = {"/bin/sh", "-c", "ulimit -f 200; exec \"$@\"", "sh", cohort_program(), "run"};
    command.insert(command.end(), {field.file(), "--controllers", controllers, "--record", file, "--summary", summary});
    command.insert(command.end(), more.begin(), more.end());
    return run_to_end(command);
  };
  const auto unrecorded = [&] { return events_of(read_json(summary), "unrecorded"); };
  for (const char* const controllers : {"inprocess", "process"}) {
    const Ended stopped = run(FieldOfRobots(8, 1e5), controllers, {"--record-or-stop"});
    EXPECT_EQ(stopped.exit_code, 4) << controllers << stopped.err;
    EXPECT_NE(stopped.err.find("ulimit -f"), std::string::npos) << "what to do is said: " << stopped.err;
    ASSERT_EQ(unrecorded().size(), 1u) << controllers;
    EXPECT_NE(unrecorded()[0]["text"].get<std::string>().find(file), std::string::npos);
    EXPECT_LT(read_json(summary)["ticks"], 1'000'000) << "it would have gone on for 10 million";
  }
  const Ended whole = run(FieldOfRobots(8, 60.0), "inprocess", {});
  EXPECT_EQ(whole.exit_code, 1) << whole.err;
  EXPECT_NE(whole.out.find("\nrecording         INCOMPLETE: the recording " + file), std::string::npos) << whole.out;
  EXPECT_NE(whole.err.find(": unrecorded: "), std::string::npos) << whole.err;
  EXPECT_EQ(read_json(summary)["ticks"], 6000);
  EXPECT_EQ(unrecorded().size(), 1u) << "also if the disk says so when the run is over";
}

// The run ends before a chunk is due, so that its end is the first to find the disk full.
TEST_F(Recordings, AreReportedBeforeTheSummaryIfTheyEndEarly) {
  const FieldOfRobots field(8, 60.0);
  const Ended ended = run_to_end({"/bin/sh", "-c", "ulimit -f 200; exec \"$@\" 2>&1", "sh", cohort_program(), "run",
                                  field.file(), "--controllers", "inprocess", "--record", *this / "run.mcap"});
  EXPECT_EQ(ended.exit_code, 1) << ended.out;
  const std::size_t told = ended.out.find("unrecorded: ");
  ASSERT_NE(told, std::string::npos) << ended.out;
  EXPECT_LT(told, ended.out.find("experiment        ")) << ended.out;
}

TEST_F(Recordings, AreInTheHistoryIfTheyEndEarlyWhileTheRunContinues) {
  const FieldOfRobots field(8, 1e5);
  const ReservedDomain domain;
  const std::vector<std::string> serve = field.serve(domain, {"--paused", "--record", *this / "run.mcap"});
  std::vector<std::string> command = {"/bin/sh", "-c", "ulimit -f 200; exec \"$@\"", "sh"};
  command.insert(command.end(), serve.begin(), serve.end());
  Process server(command);
  Process controllers(FieldOfRobots::host(domain, "all"));
  EXPECT_TRUE(eventually([&] {
    control(domain, {"step", "1000"});
    return control(domain, {"history"}).find("ulimit -f") != std::string::npos;
  })) << server.output();
  EXPECT_TRUE(server.wait_for_output("NOT RECORDED")) << server.output();
  control(domain, {"step", "1"});
  control(domain, {"shutdown"});
  EXPECT_EQ(server.wait_for_exit(), 1) << server.output();
}

TEST_F(Recordings, ShowWhereTwoRunsDiverge) {
  const std::string file = record("run.mcap");
  const Ended same = cohort({"diff", file, record("again.mcap")});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_EQ(same.out, "identical, 201 ticks\n");

  const Ended other = cohort({"diff", "--json", file, record("other.mcap", {}, "0.11")});
  EXPECT_EQ(other.exit_code, 1);
  const auto found = nlohmann::json::parse(other.out);
  EXPECT_EQ(found["tick"], 0);
  EXPECT_EQ(found["settings"], nlohmann::json::parse(R"([{"setting": "parameter 'treel/right/velocity' of team 'swarm'",
            "first": "0.1", "second": "0.11"}])"));
  ASSERT_EQ(found["differences"].size(), 2u) << other.out;
  EXPECT_EQ(found["differences"][0],
            nlohmann::json::parse(R"({"object": "swarm/sbot_0", "quantity": "command", "detail":
            "treel/right/velocity", "first": "0.1", "second": "0.11"})"));

  const Ended shorter = cohort({"diff", file, record("shorter.mcap", {"--duration", "1"})});
  EXPECT_EQ(shorter.exit_code, 1);
  EXPECT_TRUE(shorter.out.starts_with("the runs have different settings:\n  duration: 2 s | 1 s\n")) << shorter.out;
  EXPECT_NE(shorter.out.find("shorter.mcap ends at tick 100, and the other recording is longer"), std::string::npos)
      << shorter.out;
  EXPECT_NE(shorter.out.find("identical, 101 ticks"), std::string::npos) << shorter.out;

  const Ended noise = cohort({"diff", file, record("seed.mcap", {"--seed", "2"})});
  EXPECT_EQ(noise.exit_code, 1);
  EXPECT_TRUE(
      noise.out.starts_with("the runs have different settings:\n  seed: 1 | 2\n"
                            "they diverge at tick 0 (0.000 s), after 0 identical ticks\n  observation  swarm/sbot_0"))
      << noise.out;
}

TEST_F(Recordings, ExplainHowToRecordAnExperiment) {
  const FieldOfRobots field(2, 2.0);
  const std::string picture = *this / "run.svg";
  for (const std::vector<std::string>& command : {std::vector<std::string>{"replay", field.file()},
                                                  {"view", field.file()},
                                                  {"page", field.file(), "--output", *this / "run.html"},
                                                  {"plot", field.file(), "--output", picture}}) {
    const Ended refused = cohort(command);
    EXPECT_EQ(refused.exit_code, 2) << command[0] << refused.err;
    EXPECT_NE(refused.err.find("is an experiment, not a recording. To run it: cohort run"), std::string::npos)
        << command[0] << refused.err;
  }
}

TEST_F(Recordings, ContainTheRequestedData) {
  const recording::Recording recorded(record("run.mcap", {"--record-poses", "50", "--record-observations", "20",
                                                          "--record-robots", "1", "--record-snapshots", "0.5"}));
  const auto count = [&](const std::string& topic) {
    const recording::Channel* const channel = recorded.reader().channel(topic);
    if (channel == nullptr) return std::uint64_t{0};
    const auto& counts = recorded.reader().statistics().messages_of_channels;
    return counts.contains(channel->id) ? counts.at(channel->id) : 0;
  };
  EXPECT_EQ(count("/tf"), 101u + 41u) << "with each observation the links that have sensors";
  EXPECT_EQ(count("/tf_static"), 1u);
  EXPECT_EQ(count("/clock"), 101u);
  EXPECT_EQ(count("/swarm/sbot_1/observation"), 41u);
  EXPECT_EQ(count("/swarm/sbot_0/observation"), 0u);
  EXPECT_EQ(count("/cohort/snapshot"), 4u);
  EXPECT_EQ(count("/cohort/boundary"), 201u);
  EXPECT_EQ(count("/cohort/commands"), 1u) << "they are always the same";
  EXPECT_EQ(recorded.end(), "finished");
  EXPECT_EQ(recorded.facts().at("robots"), "2");
}

TEST_F(Recordings, AreExportedAsTables) {
  const std::string file = record("run.mcap", {"--record-observations", "10"});
  ASSERT_EQ(cohort({"export-data", file, "--csv", *this / "tables"}).exit_code, 0);
  const auto poses = lines_of(read_file(*this / "tables/trajectories.csv"));
  ASSERT_EQ(poses.size(), 1u + 2 * 21);
  EXPECT_EQ(poses[0], "run,time,object,team,x,y,z,qx,qy,qz,qw");
  EXPECT_TRUE(poses[2].starts_with("0,0,swarm/sbot_1,swarm,")) << poses[2];
  const auto commands = lines_of(read_file(*this / "tables/commands_sbot.csv"));
  ASSERT_EQ(commands.size(), 3u);
  EXPECT_TRUE(commands[0].starts_with("run,time,robot,team,treel_left_velocity,treel_right_velocity,")) << commands[0];
  EXPECT_TRUE(commands[1].starts_with("0,0,swarm/sbot_0,swarm,0.1,0.1,")) << commands[1];
  EXPECT_EQ(lines_of(read_file(*this / "tables/observations_sbot.csv")).size(), 1u + 2 * 21);
  EXPECT_EQ(lines_of(read_file(*this / "tables/ticks.csv")).size(), 202u);

  const auto units = read_json(*this / "tables/units.json");
  EXPECT_EQ(units["trajectories"]["x"], "m");
  EXPECT_EQ(units["commands_sbot"]["treel_left_velocity"], "m/s");
  EXPECT_EQ(units["ticks"], nlohmann::json::parse(R"({"time": "s"})"));

  ASSERT_EQ(
      cohort({"export-data", file, "--csv", *this / "part", "--robots", "1", "--from", "1", "--to", "1.5"}).exit_code,
      0);
  const auto part = lines_of(read_file(*this / "part/observations_sbot.csv"));
  ASSERT_EQ(part.size(), 1u + 6);
  EXPECT_TRUE(part[1].starts_with("0,1,swarm/sbot_1,")) << part[1];

  ASSERT_EQ(cohort({"export-data", file, "--hdf5", *this / "run.h5"}).exit_code, 0);
  EXPECT_TRUE(read_file(*this / "run.h5").starts_with("\x89HDF\r\n"));
}

// The same recording, as if another build had made it.
void claim_other_build(const std::string& file, const std::string& key, const std::string& value) {
  recording::Bytes bytes;
  {
    const recording::McapReader reader(file);
    recording::McapWriter writer(
        [&](recording::ByteView part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    for (const auto& [id, schema] : reader.schemas()) writer.add(schema);
    for (const auto& [id, channel] : reader.channels()) writer.add(channel);
    for (const auto& index : reader.attachments()) writer.add_attachment(reader.attachment(index));
    for (const auto& index : reader.metadata()) {
      recording::Metadata metadata = reader.metadata(index);
      if (metadata.entries.contains(key)) metadata.entries[key] = value;
      writer.add_metadata(metadata);
    }
    recording::MessageStream messages = reader.messages({.order = recording::Order::file});
    while (const auto message = messages.next())
      writer.write_message(message->channel, message->sequence, message->log_time, message->publish_time,
                           message->data);
    writer.close();
  }
  write_bytes(file, bytes);
}

TEST_F(Recordings, NameTheirBuildAndReplaysWarnOfOtherArithmetic) {
  const std::string file = record("run.mcap");
  const std::string listed = cohort({"recordings", "list", file}).out;
  for (const char* const fact : {"\n  arithmetic             ", "\n  commit                 "})
    EXPECT_NE(listed.find(fact), std::string::npos) << listed;
  EXPECT_EQ(cohort({"replay", file, "--verify"}).err, "");

  claim_other_build(file, "commit", "0123456789ab");
  EXPECT_EQ(cohort({"replay", file, "--verify"}).err, "") << "the arithmetic is the same";
  EXPECT_NE(cohort({"replay", file, "--verify", "--verbose"}).err.find("another commit of Cohort (0123456789ab)"),
            std::string::npos);

  claim_other_build(file, "arithmetic", "0123456789abcdef");
  const Ended warned = cohort({"replay", file, "--verify"});
  EXPECT_EQ(warned.exit_code, 0);
  EXPECT_NE(warned.err.find("its arithmetic differs, so results will differ"), std::string::npos) << warned.err;
}

// As on a full disk, files are truncated. HDF5 fails again when it is closed.
TEST_F(Recordings, ExitWithOneIfTablesCannotBeWritten) {
  const std::string file = record("run.mcap", {"--record-observations", "10"});
  for (const std::vector<std::string>& target :
       {std::vector<std::string>{"--csv", *this / "tables"}, std::vector<std::string>{"--hdf5", *this / "run.h5"}})
    for (const char* const blocks : {"1", "8"}) {
      std::vector<std::string> command = {"/bin/sh",
                                          "-c",
                                          "trap '' XFSZ; ulimit -f " + std::string(blocks) + "; exec \"$@\"",
                                          "sh",
                                          cohort_program(),
                                          "export-data",
                                          file};
      command.insert(command.end(), target.begin(), target.end());
      const Ended ended = run_to_end(command);
      EXPECT_EQ(ended.exit_code, 1) << target[0] << " " << blocks << ended.err;
      EXPECT_NE(ended.err.find("cannot be written"), std::string::npos) << ended.err;
      EXPECT_FALSE(std::filesystem::exists(*this / "run.h5"));
    }
}

// Rows of the part include commands that were sent before it and are still in effect.
TEST_F(Recordings, ExportTheSameRowsForAPart) {
  run_experiment(COHORT_SOURCE_DIR "/worlds/experiments/chain.yaml",
                 {"--controllers", "inprocess", "--duration", "12", "--record", *this / "run.mcap"});
  ASSERT_EQ(cohort({"export-data", *this / "run.mcap", "--csv", *this / "whole"}).exit_code, 0);
  ASSERT_EQ(cohort({"export-data", *this / "run.mcap", "--csv", *this / "part", "--from", "6"}).exit_code, 0);
  const auto whole = lines_of(read_file(*this / "whole/commands_sbot.csv"));
  const auto part = lines_of(read_file(*this / "part/commands_sbot.csv"));
  ASSERT_GT(part.size(), 100u);
  ASSERT_GT(whole.size(), part.size());
  EXPECT_TRUE(std::equal(part.rbegin(), part.rend() - 1, whole.rbegin()));
}

TEST_F(Recordings, AreDrawnAsPlots) {
  const std::string file = record("run.mcap", {"--plot", *this / "live.svg"});
  ASSERT_EQ(cohort({"plot", file, "-o", *this / "paths.svg"}).exit_code, 0);
  EXPECT_EQ(read_file(*this / "paths.svg"), read_file(*this / "live.svg")) << "the picture that the run drew itself";
  const Ended series = cohort({"plot", file, "-o", *this / "series.svg", "--what", "speed,treel/left/position"});
  ASSERT_EQ(series.exit_code, 0) << series.err;
  EXPECT_NE(read_file(*this / "series.svg").find("treel/left/position"), std::string::npos);
  const Ended png = cohort({"plot", file, "-o", *this / "paths.png"});
  ASSERT_EQ(png.exit_code, 0) << png.err;
  EXPECT_TRUE(read_file(*this / "paths.png").starts_with("\x89PNG"));
  ASSERT_EQ(cohort({"plot", file, "-o", *this / "same.svg", "--what", "paths"}).exit_code, 0);
  EXPECT_EQ(read_file(*this / "same.svg"), read_file(*this / "paths.svg"));
  ASSERT_EQ(cohort({"plot", file, "-o", *this / "one.svg", "--robots", "swarm/sbot_1"}).exit_code, 0);
  const std::string one = read_file(*this / "one.svg");
  EXPECT_NE(one.find("swarm/sbot_1"), std::string::npos);
  EXPECT_EQ(one.find("swarm/sbot_0"), std::string::npos) << "it was not asked for";
}

TEST_F(Recordings, AreDrawnOverTimeInTheColoursOfTeams) {
  const std::string file = *this / "run.mcap";
  run_experiment(COHORT_SOURCE_DIR "/worlds/experiments/lifting.yaml",
                 {"--controllers", "inprocess", "--duration", "0.5", "--record", file});
  const auto has_legend = [&](const std::vector<std::string>& selection, const std::vector<std::string>& teams) {
    std::vector<std::string> plot = {"plot", file, "-o", *this / "speed.svg", "--what", "speed"};
    plot.insert(plot.end(), selection.begin(), selection.end());
    ASSERT_EQ(cohort(plot).exit_code, 0);
    const std::string svg = read_file(*this / "speed.svg");
    EXPECT_EQ(svg.find("id=\"legend\"") != std::string::npos, !teams.empty());
    for (const std::string& team : teams) EXPECT_NE(svg.find(">team " + team + "<"), std::string::npos) << team;
  };
  has_legend({}, {"load", "lifter", "anchor"});
  has_legend({"--robots", "0"}, {});
}

TEST_F(Recordings, AreDrawnInTheFormatOfTheFilesNameOrRefused) {
  const std::string file = record("run.mcap", {"--plot", *this / "live.pdf"});
  EXPECT_TRUE(read_file(*this / "live.pdf").starts_with("%PDF"));
  record("again.mcap", {"--plot", *this / "live.PNG"});
  EXPECT_TRUE(read_file(*this / "live.PNG").starts_with("\x89PNG"));
  ASSERT_EQ(cohort({"plot", file, "-o", *this / "paths.pdf"}).exit_code, 0);
  EXPECT_TRUE(read_file(*this / "paths.pdf").starts_with("%PDF"));

  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& reason) {
    const Ended ended = cohort(arguments);
    EXPECT_EQ(ended.exit_code, 2) << reason;
    EXPECT_NE(ended.err.find(reason), std::string::npos) << ended.err;
  };
  const std::string formats = "expected a file name that ends in .svg, .png or .pdf";
  refused({"plot", file, "-o", *this / "paths.jpg"}, formats);
  refused({"run", "obstacle_avoidance", "--plot", *this / "paths.jpg"}, formats);
  for (const char* const what : {"paths", "speed"})
    refused({"plot", file, "-o", *this / "none.svg", "--what", what, "--robots", "green/*"},
            "there is no robot 'green/*'; known: swarm/sbot_0, swarm/sbot_1");
  refused({"plot", file, "-o", *this / "none.svg", "--what", "speed,paths"}, "'paths' makes a separate picture");
  refused({"plot", file, "-o", *this / "none.svg", "--what", "path"}, "did you mean 'paths'?");
  EXPECT_FALSE(std::filesystem::exists(*this / "none.svg"));
}

TEST_F(Recordings, AreRejectedWithTheReasonIfInvalid) {
  write_file(*this / "text.mcap", "not a recording");
  const std::string file = record("run.mcap");
  const auto refused = [](const std::vector<std::string>& arguments, const std::string& reason) {
    const Ended ended = cohort(arguments);
    EXPECT_EQ(ended.exit_code, 2) << arguments[0];
    EXPECT_NE(ended.err.find(reason), std::string::npos) << arguments[0] << ": " << ended.err;
  };
  for (const char* command : {"replay", "diff", "plot", "export-data"}) {
    std::vector<std::string> arguments = {command, *this / "text.mcap"};
    if (command == std::string("diff")) arguments.push_back(file);
    if (command == std::string("plot")) arguments.insert(arguments.end(), {"-o", *this / "x.svg"});
    if (command == std::string("export-data")) arguments.insert(arguments.end(), {"--csv", *this / "x"});
    refused(arguments, "text.mcap: byte 0");
  }
  refused({"replay", *this / "none.mcap"}, "none.mcap");
  refused({"plot", file, "-o", *this / "x.svg", "--what", "treel/left/positon"}, "did you mean 'treel/left/position'?");
  refused({"plot", file, "-o", *this / "x.jpg"}, "expected a file name that ends in .svg, .png or .pdf");
  refused({"replay", file, "--from", "5"}, "no data between '--from' and '--to'");
  refused({"replay", file, "--verify", "--from", "5"}, "no data between '--from' and '--to'");
  refused({"plot", file, "-o", *this / "x.svg", "--from", "5"}, "no data between '--from' and '--to'");
  refused({"export-data", file, "--csv", *this / "x", "--robots", "7"}, "7");
  refused({"run", demo_experiment(), "--record", "/nowhere/run.mcap"}, "/nowhere");
}

}  // namespace
}  // namespace cohort::test
