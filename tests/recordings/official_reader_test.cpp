// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "server/recording/mcap/reading/recover.hpp"
#include "server/recording/mcap/writing/recording_file.hpp"
#include "server/recording/ros_channels.hpp"
#include "tests/support/any_message.hpp"
#include "tests/support/every_ros_message.hpp"
#include "tests/support/node_folder.hpp"
#include "tests/support/process.hpp"
#include "tests/support/recordings.hpp"

namespace cohort::recording {

namespace {

using namespace test;
using nlohmann::json;
namespace fs = std::filesystem;

class OfficialReader : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const auto missing = folder.prepare(script)) GTEST_SKIP() << *missing;
  }

  // The contents that the reader found in the file.
  static json read(const fs::path& file) {
    const Ended ended = folder.run(script, {file});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    json found = json::parse(ended.out, nullptr, false);
    EXPECT_TRUE(found.is_object()) << ended.out;
    EXPECT_TRUE(found["data_crc_is_right"] == true && found["is_read_to_its_end"] == true);
    return found;
  }

 private:
  inline static const std::string script = "read_recording.mjs";
  inline static const NodeFolder folder{COHORT_NODE, COHORT_NPM, COHORT_SOURCE_DIR "/tests/recordings",
                                        COHORT_NODE_FOLDER};
};

// Messages are text, in a channel without a schema.
Bytes text_recording(int count, const McapWriterOptions& options) {
  Bytes bytes;
  McapWriter writer([&](ByteView more) { bytes.insert(bytes.end(), more.begin(), more.end()); }, options);
  const SchemaId schema = writer.add_schema("Text", "text", "anything");
  const ChannelId channels[] = {writer.add_channel("/even", schema, "text", {{"key", "value"}}),
                                writer.add_channel("/odd", 0, "text")};
  writer.add_metadata({"run", {{"seed", "7"}, {"experiment", "demo"}}});
  for (int i = 0; i < count; ++i) {
    const Timestamp time(static_cast<std::uint64_t>((i / 3 * 3 + 2 - i % 3) * 1000));  // back and forth
    writer.write_message(channels[i % 2], static_cast<std::uint32_t>(i), time, time + Timestamp(1), bytes_of(said(i)));
    if (i == count / 2) writer.add_attachment({Timestamp(5), Timestamp(6), "snapshot", "text/plain", Bytes(1000)});
  }
  writer.close();
  return bytes;
}

void expect_text_recording(const json& found, int count) {
  EXPECT_EQ(found["header"]["profile"], "ros2");
  EXPECT_EQ(found["schemas"], json::parse(R"([{"id": 1, "name": "Text", "encoding": "text"}])"));
  EXPECT_EQ(found["channels"].size(), 2U);
  EXPECT_EQ(found["channels"][0]["topic"], "/even");
  EXPECT_EQ(found["channels"][0]["metadata"], json::parse(R"([["key", "value"]])"));
  EXPECT_EQ(found["channels"][1]["schemaId"], 0);
  EXPECT_EQ(found["attachments"], json::parse(R"([{"name": "snapshot", "media_type": "text/plain", "size": 1000}])"));
  EXPECT_EQ(found["metadata"], json::parse(R"([{"name": "run", "entries": [["experiment", "demo"], ["seed", "7"]]}])"));
  const json& statistics = found["statistics"];
  EXPECT_EQ(statistics["messageCount"], count);
  EXPECT_EQ(statistics["channelCount"], 2);
  EXPECT_EQ(statistics["attachmentCount"], 1);
  EXPECT_EQ(statistics["metadataCount"], 1);
  EXPECT_EQ(statistics["chunkCount"], found["records"]["Chunk"]);
  EXPECT_EQ(statistics["channelMessageCounts"], (json{{1, (count + 1) / 2}, {2, count / 2}}));
  EXPECT_EQ(found["records"]["Message"], count);
  EXPECT_EQ(found["records"]["ChunkIndex"], found["records"]["Chunk"]);

  ASSERT_EQ(found["messages"].size(), static_cast<std::size_t>(count));
  std::set<int> sequences;
  for (std::size_t i = 0; i < found["messages"].size(); ++i) {
    const json& message = found["messages"][i];
    const int sequence = message["sequence"];
    EXPECT_TRUE(i == 0 || found["messages"][i - 1]["log_time"] <= message["log_time"]);
    EXPECT_EQ(message["message"], said(sequence));
    EXPECT_EQ(message["topic"], sequence % 2 == 0 ? "/even" : "/odd");
    EXPECT_EQ(message["log_time"], (sequence / 3 * 3 + 2 - sequence % 3) * 1000);
    EXPECT_EQ(message["publish_time"], message["log_time"].get<int>() + 1);
    sequences.insert(sequence);
  }
  EXPECT_EQ(sequences.size(), static_cast<std::size_t>(count));
}

TEST_F(OfficialReader, ReadsAllMessagesOfTheWriter) {
  for (const bool compress : {true, false}) {
    const TemporaryFile file(text_recording(300, {.chunk_size = 1000, .compress = compress}));
    const json found = read(file.path());
    EXPECT_GT(found["records"]["Chunk"], 5);
    expect_text_recording(found, 300);
    // Schema, channel, chunk index, attachment index, statistics, metadata index: each group can be found.
    EXPECT_EQ(found["summary_offsets"], (json{0x03, 0x04, 0x08, 0x0A, 0x0B, 0x0D}));
  }
}

TEST_F(OfficialReader, ReadsARecordingWithoutMessages) {
  Bytes bytes;
  McapWriter writer([&](ByteView more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
  writer.close();
  const TemporaryFile file(bytes);
  const json found = read(file.path());
  EXPECT_EQ(found["statistics"]["messageCount"], 0);
  EXPECT_TRUE(found["messages"].empty());
}

TEST_F(OfficialReader, ReadsThreadedAndRecoveredFiles) {
  const TemporaryFile file;
  constexpr int count = 5000;
  {
    RecordingFile recording(file.path(), {.mcap = {.chunk_size = 20'000}});
    const SchemaId schema = recording.add_schema("Text", "text", "anything");
    const ChannelId channel = recording.add_channel("/t", schema, "text");
    for (int i = 0; i < count; ++i)
      recording.write_message(channel, static_cast<std::uint32_t>(i), Timestamp(static_cast<std::uint64_t>(i)), {},
                              bytes_of(said(i)), Importance::essential);
  }
  EXPECT_EQ(read(file.path())["messages"].size(), static_cast<std::size_t>(count));

  const Bytes bytes = read_bytes(file.path());
  write_bytes(file.path(), ByteView(bytes).first(bytes.size() / 2));
  const std::uint64_t kept = recover(file.path(), file.path()).kept.message_count;
  EXPECT_GT(kept, 1000U);
  const json found = read(file.path());
  EXPECT_EQ(found["messages"].size(), kept);
  EXPECT_EQ(found["messages"].back()["message"], said(static_cast<int>(kept) - 1));
}

// The message, as decoders of ROS return it.
template <class Value>
json as_json(const Value& value) {
  if constexpr (messages::RosMessage<Value>) {
    json object = json::object();
    std::apply([&](const auto&... fields) { ((object[fields.name] = as_json(value.*fields.member)), ...); },
               Value::fields);
    return object;
  } else if constexpr (requires { value.c_str(); } || std::is_arithmetic_v<Value>) {
    return value;
  } else {
    json array = json::array();
    for (const auto& element : value) array.push_back(as_json(element));
    return array;
  }
}

template <class Message>
void write_any(McapWriter& writer, AnyMessage& any, std::vector<json>& written) {
  const ChannelId channel = add_ros_channel(writer, "/any", add_ros_schema<Message>(writer));
  for (int i = 0; i < 5; ++i) {
    Message message;
    any.fill(message);
    writer.write_message(channel, 0, Timestamp(written.size()), {}, messages::encode(message));
    written.push_back(as_json(message));
  }
}

// Decodes with the schemas in the file only, and with foreign code.
TEST_F(OfficialReader, DecodesRosMessagesByTheirSchemas) {
  Bytes bytes;
  McapWriter writer([&](ByteView more) { bytes.insert(bytes.end(), more.begin(), more.end()); });
  AnyMessage any;
  std::vector<json> written;
  const auto write_all = [&]<class... Message>(std::tuple<Message...>*) {
    (write_any<Message>(writer, any, written), ...);
  };
  using Messages = test::StandardMessages;
  write_all(static_cast<Messages*>(nullptr));
  writer.close();
  const TemporaryFile file(bytes);
  const json found = read(file.path());
  ASSERT_EQ(found["messages"].size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i)
    EXPECT_EQ(found["messages"][i]["message"], written[i]) << found["schemas"][i / 5];
}

// The recording of a run, with Cohort's own messages.
TEST_F(OfficialReader, ReadsARunOfCohort) {
  const ScratchFolder scratch;
  run_demo({"--controllers", "inprocess", "--duration", "1", "--record", scratch / "run.mcap", "--record-observations",
            "10", "--record-snapshots", "0.5"});
  const json found = read(scratch / "run.mcap");
  std::map<std::string, std::vector<json>> messages;  // by topic
  for (const json& message : found["messages"]) messages[message["topic"]].push_back(message["message"]);
  EXPECT_EQ(messages["/cohort/boundary"].size(), 101u);
  EXPECT_EQ(messages["/cohort/boundary"][50]["tick"], 50);
  ASSERT_EQ(messages["/tf"].size(), 22u) << "of robots and of their sensors, in turn";
  ASSERT_EQ(messages["/tf"][0]["transforms"].size(), 16u);
  EXPECT_EQ(messages["/tf"][0]["transforms"][3]["child_frame_id"], "explorers/sbot_3");
  EXPECT_EQ(messages["/tf"][20]["transforms"][3]["header"]["stamp"]["sec"], 1);
  ASSERT_EQ(messages["/explorers/sbot_7/range/proximity_3"].size(), 11u);
  EXPECT_EQ(messages["/explorers/sbot_7/range/proximity_3"][5]["header"]["frame_id"], "explorers/sbot_7/proximity_3");
  EXPECT_EQ(messages["/cohort/roster"][0]["robots"][15]["name"], "explorers/sbot_15");
  EXPECT_EQ(messages["/cohort/world"][0]["duration_ns"], 1'000'000'000);
  EXPECT_EQ(messages["/cohort/snapshot"].size(), 2u);
  ASSERT_EQ(messages["/explorers/sbot_7/observation"].size(), 11u);
  EXPECT_TRUE(messages["/explorers/sbot_7/observation"][5]["proximity_3_reading"].is_number());
  ASSERT_GE(found["attachments"].size(), 3u) << "experiment, world and robot";
}

// A wall 2 m in front of a robot that has an arm, and every sensor for which ROS has a message.
constexpr const char* sensors = R"(world:
  name: sensors
  gravity: [0, 0, -9.81]
  magnetic_field: [2e-5, 0, -4e-5]
  model:
    - {name: wall, static: true, pose: [2.05, 0, 0, 0, 0, 0], link: {name: body, collision: {name: wall, geometry: {box: {size: [0.1, 8, 8]}}}}}
    - name: robot
      cohort:battery: {name: cell, capacity: 3600, charge: 0.75, idle_power: 0}
      cohort:climate_sensor: {name: air, link: base}
      cohort:accelerometer: {name: shake, link: base}
      joint:
        - {name: mount, type: fixed, parent: world, child: base}
        - {name: hinge, type: revolute, parent: base, child: arm, axis: {xyz: [0, 1, 0], limit: {lower: 0, upper: 0}},
           sensor: {name: strain, type: force_torque, force_torque: {frame: child, measure_direction: child_to_parent}}}
      link:
        - name: base
          inertial: {mass: 1}
          sensor:
            - {name: scan, type: lidar, pose: [0, 0, 0.5, 0, 0, 0], lidar: {scan: {horizontal: {samples: 5, min_angle: -1, max_angle: 1}}, range: {min: 0.1, max: 3}}}
            - {name: cloud, type: lidar, lidar: {scan: {horizontal: {samples: 3, min_angle: -2, max_angle: 2}, vertical: {samples: 2, min_angle: 0, max_angle: 0.5}}, range: {min: 0.1, max: 3}}}
            - {name: imu, type: imu}
            - {name: compass, type: magnetometer}
            - {name: barometer, type: air_pressure}
        - {name: arm, pose: [0, 0, 1, 0, 0, 0], inertial: {mass: 2}}
)";

TEST_F(OfficialReader, ReadsStandardSensorsAsRosMessages) {
  const ScratchFolder scratch;
  write_file(scratch / "world.yaml", sensors);
  write_file(scratch / "experiment.yaml",
             "world: world.yaml\nduration: 1\nrecord: {observations: 10, joints: 5}\n"
             "teams:\n  - {name: all, robots: robot, controller: constant}\n");
  run_experiment(scratch / "experiment.yaml", {"--controllers", "inprocess", "--record", scratch / "run.mcap"});
  const json found = read(scratch / "run.mcap");
  std::map<std::string, json> last;  // by topic
  for (const json& message : found["messages"]) last[message["topic"]] = message["message"];
  const auto near = [](const json& value, double expected, double tolerance = 1e-6) {
    return value.is_number() && std::abs(value.get<double>() - expected) < tolerance;
  };

  const json& scan = last["/robot/scan"];
  EXPECT_EQ(scan["header"]["frame_id"], "robot/scan");
  EXPECT_EQ(scan["header"]["stamp"]["sec"], 1);
  EXPECT_TRUE(near(scan["angle_increment"], 0.5)) << scan;
  ASSERT_EQ(scan["ranges"].size(), 5U);
  EXPECT_TRUE(near(scan["ranges"][2], 2.0)) << scan;
  EXPECT_TRUE(near(scan["ranges"][1], 2.0 / std::cos(0.5))) << scan;
  EXPECT_TRUE(scan["ranges"][0].is_null()) << "infinite: nothing within 3 m. " << scan;
  const json& cloud = last["/robot/points"];
  EXPECT_EQ(cloud["width"], 2) << "straight ahead, in both rows";
  EXPECT_EQ(cloud["data"].size(), 24U);
  EXPECT_EQ(cloud["fields"][2]["name"], "z");
  EXPECT_TRUE(near(last["/robot/imu"]["linear_acceleration"]["z"], 9.81)) << last["/robot/imu"];
  EXPECT_TRUE(near(last["/robot/imu"]["orientation"]["w"], 1.0)) << last["/robot/imu"];
  EXPECT_EQ(last["/robot/accelerometer"]["orientation_covariance"][0], -1.0) << "not measured";
  EXPECT_TRUE(near(last["/robot/magnetic_field"]["magnetic_field"]["z"], -4e-5, 1e-12))
      << last["/robot/magnetic_field"];
  EXPECT_TRUE(near(last["/robot/fluid_pressure"]["fluid_pressure"], 101325.0, 1.0)) << last["/robot/fluid_pressure"];
  EXPECT_TRUE(near(last["/robot/battery_state"]["percentage"], 0.75)) << last["/robot/battery_state"];
  EXPECT_TRUE(last["/robot/temperature"]["temperature"].is_number());
  EXPECT_TRUE(last["/robot/relative_humidity"]["relative_humidity"].is_number());
  EXPECT_TRUE(near(last["/robot/wrench/strain"]["wrench"]["force"]["z"], -2 * 9.81, 1e-3))
      << last["/robot/wrench/strain"];
  EXPECT_EQ(last["/robot/joint_states"]["name"], json{"hinge"});

  std::map<std::string, json> places;  // by frame
  for (const json& message : found["messages"])
    if (message["topic"] == "/tf" || message["topic"] == "/tf_static")
      for (const json& each : message["message"]["transforms"]) places[each["child_frame_id"]] = each["transform"];
  EXPECT_EQ(places["robot/scan"]["translation"]["z"], 0.5);
  EXPECT_EQ(places["robot/arm"]["translation"]["z"], 1.0);
  EXPECT_TRUE(places.contains("robot/strain"));
  EXPECT_FALSE(places.contains("robot/cell")) << "it is nowhere";
  for (const json& each : last["/tf_static"]["transforms"])
    EXPECT_EQ(each["header"]["frame_id"], each["child_frame_id"] == "robot/strain" ? "robot/arm" : "robot") << each;
}

}  // namespace
}  // namespace cohort::recording
