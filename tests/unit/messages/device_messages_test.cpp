// SPDX-License-Identifier: Apache-2.0
#include "server/messages/device_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "idl/messages/cohort_device_messages.hpp"
#include "server/messages/command_messages.hpp"
#include "tests/support/worlds/sensing_world.hpp"

namespace cohort::messages {
namespace {

using namespace test;

constexpr double pi = std::numbers::pi;

description::Lidar lidar(const std::string& name) {
  description::Lidar device;
  device.name = name;
  device.X_LS.position = {0, 0, 0.3};
  device.columns = 3;
  device.min_bearing = -1.0;
  device.max_bearing = 1.0;
  device.min_range = 0.05;
  device.max_range = 2.0;
  return device;
}

// A robot with one of each of many devices, and two lidars.
description::Model robot_with_everything() {
  description::Model model = tracked_robot();
  model.devices.erase(model.devices.begin() + 1, model.devices.end());  // all but the tracks
  const Pose above{{0, 0, 0.2}, Eigen::Quaterniond::Identity()};
  description::ProximityRing ring{"proximity", 0, above, 4, 0.0, 0.5 * pi, 0.1, 0.5};
  ring.readout.period = std::chrono::milliseconds(50);
  description::LedRing leds{"leds", 0, above, 2, 0.0, pi, 0.1};
  description::Loudspeaker loudspeaker{"speaker", 0, above, 1000.0, 2.0};
  description::PanoramicCamera camera{"eye", 0, above, 8, 4, -0.5, 0.5, 3.0, {0.2, 0.4, 1.0}};
  description::Gripper gripper;
  gripper.name = "jaw";
  gripper.link = 1;
  gripper.depth = 0.02;
  gripper.half_angle = 0.3;
  gripper.height = 0.02;
  for (const description::Device& device : std::initializer_list<description::Device>{
           ring, description::GroundSensors{"ground", 0, {{0, 0, 0.15}}, 0.3}, lidar("front"), lidar("back"),
           description::Imu{"imu", 0, above}, description::JointEncoder{"turret_encoder", 0},
           description::JointEncoder{"another_turret_encoder", 0}, description::TreelEncoder{"treels", 0},
           description::LightSensors{"light", 0, above, 4, 0.0, 0.5 * pi},
           description::RangeAndBearing{"rab", 0, above, 5.0, 2, 3},
           description::OmnidirectionalCamera{"omni", 0, above, 3.0, -1, 1, 4},
           description::Inclinometer{"tilt", 0, above}, description::NavSat{"gps", 0, above}, camera, leds, loudspeaker,
           gripper, description::UserAction{"dig"}})
    model.devices.push_back(device);
  return model;
}

// Two such robots, 0.4 m apart, the second one ahead of the first.
class DeviceMessages : public testing::Test {
 protected:
  DeviceMessages() {
    world_.add(robot_with_everything(), "first", at(0, 0, 0));
    world_.add(robot_with_everything(), "second", at(0.4, 0, 0));
    world_.add(static_shape("wall", description::Box{{0.1, 4, 4}}), "wall", at(-0.45, 0, 0));
  }
  const RobotKind& kind() { return world_.simulation().kinds()[0]; }
  const description::Model& model() { return world_.simulation().description().robot_model(0); }
  std::vector<DeviceMessage> messages() { return device_messages(model(), kind().observation); }
  DeviceMessage find(const std::string& name) {
    for (const DeviceMessage& message : messages())
      if (message.name == name) return message;
    throw std::invalid_argument("no " + name);
  }
  template <RosMessage Message>
  Message now(const std::string& name) {
    const DeviceMessage message = find(name);
    EXPECT_STREQ(message.type, Message::type);
    CdrWriter writer;
    message.add(writer, {{1, 2}, "first/" + message.frame}, world_.simulation().observation(0));
    return decode<Message>(writer.bytes());
  }

  SensingWorld world_;
};

TEST_F(DeviceMessages, HaveTheNamesOfRosAndOfDevicesIfThereAreSeveral) {
  std::vector<std::string> names;
  for (const DeviceMessage& message : messages()) names.push_back(message.name);
  EXPECT_EQ(names, (std::vector<std::string>{"range/proximity_0", "range/proximity_1", "range/proximity_2",
                                             "range/proximity_3", "range/ground_0", "scan/front", "scan/back", "imu",
                                             "tracks", "light", "messages", "spots", "inclination", "navsat", "image",
                                             "gripper/state", "joint_states"}));
}

// A token of a topic may not begin with a digit.
TEST_F(DeviceMessages, HaveNamesThatRosAllows) {
  std::set<std::string> names;
  for (const DeviceMessage& message : messages()) names.insert(message.name);
  for (const CommandMessage& message : command_messages(model(), kind().command))
    EXPECT_TRUE(names.insert(message.name).second) << message.name;
  for (const std::string& name : names)
    for (std::size_t at = 0; at != std::string::npos; at = name.find('/', at + 1))
      EXPECT_TRUE(std::isalpha(static_cast<unsigned char>(name[at == 0 ? 0 : at + 1])) != 0) << name;
}

TEST_F(DeviceMessages, HaveTheDistancesOfProximitySensorsAndInfinityWithoutAnObstacle) {
  world_.step();
  const auto behind = now<ros::Range>("range/proximity_2");
  EXPECT_EQ(behind.header.frame_id, "first/proximity_2");
  EXPECT_EQ(behind.radiation_type, ros::Range::infrared);
  EXPECT_NEAR(behind.range, 0.3, 2e-3) << "the wall is 0.4 m away, the sensor 0.1 m";
  EXPECT_EQ(behind.min_range, 0.0F);
  EXPECT_EQ(behind.max_range, 0.5F);
  EXPECT_EQ(now<ros::Range>("range/proximity_1").range, std::numeric_limits<float>::infinity());
  EXPECT_NEAR(now<ros::Range>("range/ground_0").range, 0.15, 5e-3);
  EXPECT_EQ(find("range/proximity_2").period, std::chrono::milliseconds(50));
  EXPECT_EQ(find("imu").period.count(), 0);
}

TEST_F(DeviceMessages, HaveInfiniteRangesOutOfTheRangeOfALidar) {
  description::Model lone = robot_with_everything();
  description::Lidar sensor = lidar("front");
  sensor.rows = 2;
  sensor.max_elevation = 0.5;
  lone.devices = {sensor};
  const std::vector<Channel> ranges = {
      {"front/0/ranges", "m", 6, sensor.min_range, sensor.max_range, sensor.max_range}};
  const std::vector<double> readings = {sensor.min_range, 0.5, sensor.max_range, 0.5, sensor.max_range,
                                        sensor.max_range};
  CdrWriter cloud;
  device_messages(lone, ranges)[0].add(cloud, {}, readings);
  EXPECT_EQ(decode<ros::PointCloud2>(cloud.bytes()).width, 2u) << "only what was measured is a point";

  std::get<description::Lidar>(lone.devices[0]).rows = 1;
  CdrWriter scan;
  device_messages(lone, ranges)[0].add(scan, {}, readings);
  const float infinite = std::numeric_limits<float>::infinity();
  EXPECT_EQ(decode<ros::LaserScan>(scan.bytes()).ranges, (std::vector<float>{-infinite, 0.5F, infinite}));
}

TEST_F(DeviceMessages, HaveThePoseOfEachSensorWithItsXAxisInTheDirectionOfMeasurement) {
  const auto place = [this](const std::string& name) { return find(name).place_on_link.value(); };
  EXPECT_EQ(place("range/proximity_1").link, 0U);
  EXPECT_TRUE(place("range/proximity_1").X_LS.position.isApprox(Eigen::Vector3d(0, 0.1, 0.2), 1e-12));
  const auto axis = [&](const std::string& name) {
    return Eigen::Vector3d(place(name).X_LS.orientation * Eigen::Vector3d::UnitX());
  };
  EXPECT_TRUE(axis("range/proximity_1").isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE(axis("range/ground_0").isApprox(-Eigen::Vector3d::UnitZ(), 1e-12));
  EXPECT_FALSE(find("joint_states").place_on_link.has_value());
  const Pose X_WL = at(1, 2, 3);
  EXPECT_TRUE(
      find("scan/back").place([&](std::size_t) { return X_WL; }).position.isApprox(Eigen::Vector3d(1, 2, 3.3), 1e-12));
}

TEST(DeviceFrames, AreNotThoseOfLinks) {
  description::Model model = robot_with_everything();
  model.links[0].name = "imu";
  SensingWorld world;
  world.add(model, "robot", at(0, 0, 0));
  for (const DeviceMessage& message :
       device_messages(world.simulation().description().robot_model(0), world.simulation().kinds()[0].observation)) {
    EXPECT_NE(message.frame, "imu");
    EXPECT_TRUE(message.devices != std::vector<std::string>{"imu"} || message.frame == "imu_frame") << message.frame;
  }
}

TEST_F(DeviceMessages, NameTheDevicesWhoseMeasurementsTheyHave) {
  EXPECT_EQ(find("scan/back").devices, (std::vector<std::string>{"back"}));
  EXPECT_EQ(find("joint_states").devices, (std::vector<std::string>{"turret_encoder"}))
      << "the first of two encoders of a joint";
}

TEST_F(DeviceMessages, HaveAllJointsWithEncodersInOneMessage) {
  world_.step();
  const auto state = now<ros::JointState>("joint_states");
  EXPECT_EQ(state.name, (std::vector<std::string>{model().joints[0].name}));
  EXPECT_EQ(state.position.size(), 1U);
  EXPECT_EQ(state.velocity.size(), 1U);
  EXPECT_TRUE(state.effort.empty());
}

TEST_F(DeviceMessages, HaveAnImageOfThePanoramicCameraInBytes) {
  world_.step();
  const auto image = now<ros::Image>("image");
  EXPECT_EQ(image.encoding, "rgb8");
  EXPECT_EQ(image.width, 8U);
  EXPECT_EQ(image.height, 4U);
  EXPECT_EQ(image.step, 24U);
  ASSERT_EQ(image.data.size(), 96U);
  const std::vector<std::uint8_t> sky(image.data.begin() + 6, image.data.begin() + 9);
  EXPECT_EQ(sky, (std::vector<std::uint8_t>{51, 102, 255})) << "to the left there is nothing";
}

TEST_F(DeviceMessages, HaveTheVariancesOfTheNoiseInTheModel) {
  description::Model model = tracked_robot();
  description::Imu imu{"imu", 0, {}};
  imu.readout.noises = {{.quantity = "angular_velocity", .deviation = 0.1},
                        {.quantity = "angular_velocity", .element = 2, .deviation = 0.2, .bias_deviation = 0.1},
                        {.quantity = "linear_acceleration", .uniform = 0.3, .drift_deviation = 0.2, .precision = 0.6}};
  model.devices.emplace_back(imu);
  description::AirPressureSensor barometer;
  barometer.name = "barometer";
  barometer.readout.noises = {{.quantity = "", .deviation = 3.0}};
  model.devices.emplace_back(barometer);
  SensingWorld world;
  world.add(model, "robot", at(0, 0, 0));
  const RobotKind& kind = world.simulation().kinds()[0];
  std::map<std::string, CdrWriter> written;
  for (const DeviceMessage& message :
       device_messages(world.simulation().description().robot_model(0), kind.observation))
    message.add(written[message.name], {}, world.simulation().observation(0));
  const auto of_imu = decode<ros::Imu>(written.at("imu").bytes());
  EXPECT_DOUBLE_EQ(of_imu.angular_velocity_covariance[0], 0.01);
  EXPECT_DOUBLE_EQ(of_imu.angular_velocity_covariance[4], 0.01);
  EXPECT_DOUBLE_EQ(of_imu.angular_velocity_covariance[8], 0.05);
  EXPECT_EQ(of_imu.angular_velocity_covariance[1], 0.0);
  EXPECT_DOUBLE_EQ(of_imu.linear_acceleration_covariance[4], 0.03 + 0.04 + 0.03);
  EXPECT_DOUBLE_EQ(decode<ros::FluidPressure>(written.at("fluid_pressure").bytes()).variance, 9.0);
}

TEST_F(DeviceMessages, HaveLatitudesInAWorldWithAPlaceOnEarth) {
  for (const DeviceMessage& message : device_messages(model(), kind().observation, GeodeticPlace{45.0, 7.0, 100.0})) {
    if (message.name != "fix") continue;
    std::vector<double> values(world_.simulation().observation(0).size());
    std::size_t at = 0;
    for (const Channel& channel : kind().observation) {
      if (channel.name == "gps/0/position") std::copy_n(std::array{100.0, 200.0, 5.0}.begin(), 3, values.begin() + at);
      at += channel.size;
    }
    CdrWriter writer;
    message.add(writer, {}, values);
    const auto fix = decode<ros::NavSatFix>(writer.bytes());
    // A degree is 111,132 m along a meridian and 78,847 m along this parallel.
    EXPECT_NEAR(fix.latitude, 45.0 + 200.0 / 111132.0, 1e-7);
    EXPECT_NEAR(fix.longitude, 7.0 + 100.0 / 78847.0, 1e-7);
    EXPECT_NEAR(fix.altitude, 105.0, 1e-9);
    return;
  }
  FAIL() << "no fix";
}

class CommandMessages : public DeviceMessages {
 protected:
  template <RosMessage Message>
  void send(const std::string& name, const Message& message) {
    const Bytes bytes = encode(message);
    CdrReader reader(bytes);
    for (const CommandMessage& each : command_messages(model(), kind().command))
      if (each.name == name) {
        EXPECT_STREQ(each.type, Message::type);
        return each.read(reader, command_);
      }
    FAIL() << "no " << name;
  }
  double value(const std::string& channel, std::size_t index = 0) {
    std::size_t at = 0;
    for (const Channel& each : kind().command) {
      if (each.name == channel) return command_[at + index];
      at += each.size;
    }
    throw std::invalid_argument("no " + channel);
  }

  std::vector<double> command_ = std::vector<double>(kind().command_size, 0.25);
};

TEST_F(CommandMessages, SetOnlyTheValuesOfTheirDevice) {
  send("leds", ros::ColorRGBA{1.0F, 0.5F, 0.0F, 1.0F});
  EXPECT_EQ(value("leds/1/color", 1), 0.5);
  send("leds/leds_1", ros::ColorRGBA{0.0F, 0.0F, 1.0F, 1.0F});
  EXPECT_EQ(value("leds/1/color", 2), 1.0);
  EXPECT_EQ(value("leds/0/color", 0), 1.0);
  send("gripper/opening", ros::Float64{0.75});
  EXPECT_EQ(value("jaw/0/opening"), 0.75);
  send("sound", cohort_msgs::Sound{440.0, 1.5});
  EXPECT_EQ(value("speaker/0/frequency"), 440.0);
  EXPECT_EQ(value("speaker/0/intensity"), 1.5);
  send("message", ros::Float64MultiArray{{}, {3.0, 4.0}});
  EXPECT_EQ(value("rab/0/sending"), 1.0);
  EXPECT_EQ(value("rab/0/message", 1), 4.0);
  send("message", ros::Float64MultiArray{});
  EXPECT_EQ(value("rab/0/sending"), 0.0);
  EXPECT_EQ(value("dig/0/value"), 0.25) << "it has received no message";
  send("action/dig", ros::Float64{1.0});
  EXPECT_EQ(value("dig/0/value"), 1.0);
}

TEST_F(CommandMessages, AreRefusedIfValuesAreNotFiniteOrHaveTheWrongNumber) {
  const std::vector<double> before = command_;
  EXPECT_THROW(send("gripper/opening", ros::Float64{std::nan("")}), std::invalid_argument);
  EXPECT_THROW(send("leds", ros::ColorRGBA{1.0F, std::numeric_limits<float>::infinity(), 0.0F, 1.0F}),
               std::invalid_argument);
  try {
    send("message", ros::Float64MultiArray{{}, {1.0, 2.0, 3.0}});
    FAIL() << "taken";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "the message for 'rab' has 3 values; expected 2, or none to stop sending");
  }
  const Bytes too_short = encode(ros::Float32{});
  CdrReader reader(too_short);
  EXPECT_THROW(command_messages(model(), kind().command).front().read(reader, command_), CdrError);
  EXPECT_EQ(command_, before);
}

}  // namespace
}  // namespace cohort::messages
