// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/recording/mcap/reading/mcap_reader.hpp"
#include "server/recording/recorder.hpp"
#include "tests/support/files.hpp"
#include "tests/support/worlds/sensing_world.hpp"
#include "tests/support/worlds/small_world.hpp"

namespace cohort::recording {
namespace {

using namespace std::chrono_literals;

description::Imu imu(const std::string& name, std::chrono::nanoseconds period, std::chrono::nanoseconds latency) {
  description::Imu sensor;
  sensor.name = name;
  sensor.readout.period = period;
  sensor.readout.latency = latency;
  return sensor;
}

// Returns the milliseconds of the stamps of a topic's messages.
std::vector<int> stamps(const McapReader& reader, const std::string& topic) {
  std::vector<int> result;
  MessageStream messages = reader.messages();
  while (const auto message = messages.next())
    if (reader.channels().at(message->channel).topic == topic) {
      const auto stamp = messages::decode<ros::Imu>(message->data).header.stamp;
      result.push_back(1000 * stamp.sec + static_cast<int>(stamp.nanosec / 1'000'000));
    }
  return result;
}

TEST(Recordings, HaveEachMeasurementOnceWithItsTime) {
  test::SensingWorld world;
  description::Model model = test::loose("robot", description::Sphere{0.1}, description::solid_sphere(1.0, 0.1));
  model.devices = {imu("fast", 0ms, 0ms), imu("slow", 30ms, 0ms), imu("late", 30ms, 20ms)};
  world.add(model, "robot", test::at(0, 0, 1));
  world.experiment.recorded.observation_rate = 100.0;
  world.experiment.recorded.observed = {0};
  Simulation& simulation = world.simulation();
  ASSERT_EQ(world.experiment.world.step, 10ms);

  const test::ScratchFolder folder;
  Recorder recorder(folder / "run.mcap", world.experiment);
  recorder.begin(world.experiment, simulation, Beginning::first);
  recorder.boundary();
  while (simulation.time() < 100ms) {
    world.step();
    recorder.boundary();
  }
  recorder.finish("finished", "");

  const McapReader reader(folder / "run.mcap");
  EXPECT_EQ(stamps(reader, "/robot/imu/fast"), (std::vector<int>{0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100}));
  EXPECT_EQ(stamps(reader, "/robot/imu/slow"), (std::vector<int>{0, 30, 60, 90}));
  EXPECT_EQ(stamps(reader, "/robot/imu/late"), (std::vector<int>{0, 30, 60})) << "that of 90 ms arrives at 110 ms";
}

}  // namespace
}  // namespace cohort::recording
