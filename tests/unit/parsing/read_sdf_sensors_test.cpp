// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/parsing/sdf/schema/yaml_sdf.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/parsing/writing/write_world.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort::description {
namespace {

std::string sensor(const std::string& type, const std::string& content, const std::string& name = "s") {
  return "<sensor name=\"" + name + "\" type=\"" + type + "\">" + content + "</sensor>";
}
std::string link(const std::string& name, const std::string& content) {
  return "<link name=\"" + name +
         "\"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
         "<collision name=\"foot\"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>" +
         content + "</link>";
}
std::string model(const std::string& content) { return "<model name=\"m\">" + content + "</model>"; }
/// The sensor is on line 3.
std::string on_a_link(const std::string& sensor_text) { return model(link("l", "\n" + sensor_text + "\n")); }

const std::string scan =
    "<scan><horizontal><samples>8</samples><resolution>1</resolution><min_angle>-1.1</min_angle><max_angle>0.9"
    "</max_angle></horizontal></scan>";
const std::string range = "<range><min>0.1</min><max>12.5</max></range>";

class SdfSensors : public Description {
 protected:
  Device device(const std::string& content) const {
    const World world = read(content);
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    EXPECT_EQ(world.robots.size(), 1u);
    EXPECT_EQ(world.models[0].devices.size(), 1u);
    return world.models[0].devices.at(0);
  }
};

TEST_F(SdfSensors, ReadLidarsWithScanRangeAndNoise) {
  for (const char* const type : {"lidar", "gpu_lidar", "ray", "gpu_ray"}) {
    const std::string element = std::string(type).ends_with("ray") ? "ray" : "lidar";
    const auto lidar = std::get<Lidar>(device(on_a_link(sensor(
        type,
        "<pose>0.1 0.2 0.3 0 0 0</pose><update_rate>20</update_rate><always_on>true</always_on>"
        "<visualize>true</visualize><topic>scan</topic><plugin name=\"p\" filename=\"libgazebo_ros_ray_sensor.so\"/><" +
            element +
            "><scan><horizontal><samples>8</samples><resolution>2</resolution><min_angle>-1.1</min_angle>"
            "<max_angle>0.9</max_angle></horizontal><vertical><samples>3</samples><min_angle>-0.2"
            "</min_angle><max_angle>0.3</max_angle></vertical></scan><range><min>0.1</min><max>12.5</max>"
            "<resolution>0.02</resolution></range><noise><type>gaussian</type><mean>0.01</mean>"
            "<stddev>0.03</stddev></noise></" +
            element + ">"))));
    EXPECT_EQ(lidar.name, "s");
    EXPECT_EQ(lidar.X_LS.position, Eigen::Vector3d(0.1, 0.2, 0.3));
    EXPECT_EQ(lidar.columns, 16u) << "samples times resolution";
    EXPECT_EQ(lidar.rows, 3u);
    EXPECT_EQ(lidar.min_bearing, -1.1);
    EXPECT_EQ(lidar.max_bearing, 0.9);
    EXPECT_EQ(lidar.min_elevation, -0.2);
    EXPECT_EQ(lidar.max_elevation, 0.3);
    EXPECT_EQ(lidar.min_range, 0.1);
    EXPECT_EQ(lidar.max_range, 12.5);
    EXPECT_EQ(lidar.readout.period, std::chrono::milliseconds(50));
    ASSERT_EQ(lidar.readout.noises.size(), 1u);
    EXPECT_EQ(lidar.readout.noises[0].mean, 0.01);
    EXPECT_EQ(lidar.readout.noises[0].deviation, 0.03);
    EXPECT_EQ(lidar.readout.noises[0].precision, 0.0) << "Gazebo does not round to <resolution> either";
  }
}

TEST_F(SdfSensors, UseTheDefaultsOfSdf) {
  const auto lidar = std::get<Lidar>(device(on_a_link(sensor("lidar", "<lidar><range><max>3</max></range></lidar>"))));
  EXPECT_EQ(lidar.columns, 640u);
  EXPECT_EQ(lidar.rows, 1u);
  EXPECT_EQ(lidar.min_bearing, 0.0);
  EXPECT_EQ(lidar.max_bearing, 0.0);
  EXPECT_EQ(lidar.min_range, 0.0);
  EXPECT_EQ(lidar.readout.period.count(), 0) << "every tick";
  EXPECT_TRUE(lidar.readout.noises.empty());
}

TEST_F(SdfSensors, HaveSeparateNoiseForEachAxis) {
  const auto magnetometer = std::get<Magnetometer>(device(on_a_link(sensor(
      "magnetometer",
      "<magnetometer><x><noise type=\"gaussian\"><mean>1e-7</mean><stddev>2e-7</stddev><bias_mean>3e-7</bias_mean>"
      "<bias_stddev>4e-7</bias_stddev><precision>9</precision></noise></x><y><noise type=\"none\"><stddev>1</stddev>"
      "</noise></y><z><noise type=\"gaussian_quantized\"><precision>5e-7</precision></noise></z></magnetometer>"))));
  ASSERT_EQ(magnetometer.readout.noises.size(), 2u);
  const Noise& x = magnetometer.readout.noises[0];
  EXPECT_EQ(x.quantity, "magnetic_field");
  EXPECT_EQ(x.element, 0);
  EXPECT_EQ(x.mean, 1e-7);
  EXPECT_EQ(x.deviation, 2e-7);
  EXPECT_EQ(x.bias, 3e-7);
  EXPECT_EQ(x.bias_deviation, 4e-7);
  EXPECT_EQ(x.precision, 0.0) << "of noise of the type gaussian_quantized alone";
  EXPECT_EQ(magnetometer.readout.noises[1].element, 2);
  EXPECT_EQ(magnetometer.readout.noises[1].precision, 5e-7);
}

// The process of SDF has the variance s^2 T / 2 in the long run: 0.02^2 * 50 / 2 = 0.1^2.
TEST_F(SdfSensors, ComputeTheDeviationOfADriftingBiasFromItsDensity) {
  const auto altimeter = std::get<Altimeter>(device(on_a_link(
      sensor("altimeter",
             "<altimeter><vertical_velocity><noise type=\"gaussian\"><dynamic_bias_stddev>0.02</dynamic_bias_stddev>"
             "<dynamic_bias_correlation_time>50</dynamic_bias_correlation_time></noise></vertical_velocity>"
             "</altimeter>"))));
  ASSERT_EQ(altimeter.readout.noises.size(), 1u);
  EXPECT_EQ(altimeter.readout.noises[0].quantity, "vertical_velocity");
  EXPECT_NEAR(altimeter.readout.noises[0].drift_deviation, 0.1, 1e-15);
  EXPECT_EQ(altimeter.readout.noises[0].drift_time, 50.0);
}

TEST_F(SdfSensors, ReadImusWithNoiseOnEachAxisAndAReferenceFrame) {
  const auto read_imu = [&](const std::string& content) {
    return std::get<Imu>(device(on_a_link(sensor("imu", content))));
  };
  const Imu simple = read_imu("");
  EXPECT_TRUE(simple.has_orientation);
  EXPECT_FALSE(simple.is_relative_to_world);
  const Imu imu = read_imu(
      "<imu><angular_velocity><y><noise type=\"gaussian\"><stddev>2e-4</stddev></noise></y></angular_velocity>"
      "<linear_acceleration><z><noise type=\"gaussian\"><mean>0.1</mean></noise></z></linear_acceleration>"
      "<orientation_reference_frame><localization>CUSTOM</localization><custom_rpy parent_frame=\"world\">0.1 0.2 0.3"
      "</custom_rpy></orientation_reference_frame><enable_orientation>false</enable_orientation></imu>");
  EXPECT_FALSE(imu.has_orientation);
  EXPECT_TRUE(imu.is_relative_to_world);
  EXPECT_EQ(imu.reference_rpy, Eigen::Vector3d(0.1, 0.2, 0.3));
  ASSERT_EQ(imu.readout.noises.size(), 2u);
  EXPECT_EQ(imu.readout.noises[0].quantity, "angular_velocity");
  EXPECT_EQ(imu.readout.noises[0].element, 1);
  EXPECT_EQ(imu.readout.noises[1].quantity, "linear_acceleration");
  EXPECT_EQ(imu.readout.noises[1].element, 2);
  EXPECT_TRUE(read_imu("<imu><orientation_reference_frame><localization>ENU</localization>"
                       "</orientation_reference_frame></imu>")
                  .is_relative_to_world);
}

TEST_F(SdfSensors, WarnOfUnsupportedReferenceFrames) {
  const World world = read(on_a_link(sensor("imu",
                                            "<imu><orientation_reference_frame>\n<localization>NED</localization>"
                                            "</orientation_reference_frame></imu>")));
  EXPECT_NE(texts_of(world.warnings)
                .find(":4: world/model[m]/link[l]/sensor[s]/imu/orientation_reference_frame/"
                      "localization: the localization 'NED' is not supported"),
            std::string::npos)
      << texts_of(world.warnings);
  EXPECT_FALSE(std::get<Imu>(world.models[0].devices.at(0)).is_relative_to_world);
}

std::string held_by(const std::string& sensor_text) {
  return model(link("a", "") + link("b", "") + "<joint name=\"j\" type=\"fixed\"><parent>a</parent><child>b</child>\n" +
               sensor_text + "</joint>");
}

TEST_F(SdfSensors, AssignForceTorqueSensorsToTheirJoints) {
  const auto simple = std::get<ForceTorqueSensor>(device(held_by(sensor("force_torque", ""))));
  EXPECT_EQ(simple.joint, 0u);
  EXPECT_EQ(simple.axes, ForceTorqueSensor::Frame::child);
  EXPECT_TRUE(simple.is_on_parent);
  const auto sensed = std::get<ForceTorqueSensor>(device(
      held_by(sensor("force_torque",
                     "<pose>0 0 0.1 0 0 0</pose><force_torque><frame>sensor</frame><measure_direction>"
                     "parent_to_child</measure_direction><torque><x><noise type=\"gaussian\"><stddev>0.5</stddev>"
                     "</noise></x></torque></force_torque>"))));
  EXPECT_EQ(sensed.axes, ForceTorqueSensor::Frame::sensor);
  EXPECT_FALSE(sensed.is_on_parent);
  EXPECT_EQ(sensed.X_JS.position.z(), 0.1);
  EXPECT_EQ(sensed.readout.noises.at(0).quantity, "torque");
  const std::string in_another_frame = held_by(sensor("force_torque", "<pose relative_to=\"a\">0 0 0 0 0 0</pose>"));
  expect_only_flaw({in_another_frame, 3, "world/model[m]/joint[j]/sensor[s]/pose", "in the frame of the joint"},
                   write_world(in_another_frame));
}

TEST_F(SdfSensors, AssignContactSensorsToCollisionsOfTheirLinks) {
  const auto contact = std::get<ContactSensor>(
      device(model(link("a", "") +
                   link("b",
                        "<collision name=\"hand\"><geometry><sphere><radius>0.1</radius></sphere>"
                        "</geometry></collision>" +
                            sensor("contact", "<contact><collision>hand</collision></contact>")) +
                   joint("j", "a", "b"))));
  EXPECT_EQ(contact.link, 1u);
  EXPECT_EQ(contact.collision, 1u);
}

TEST_F(SdfSensors, ReadTheFrustumOfLogicalCameras) {
  const auto camera = std::get<LogicalCamera>(
      device(on_a_link(sensor("logical_camera",
                              "<logical_camera><near>0.2</near><far>7</far><aspect_ratio>1.5</aspect_ratio>"
                              "<horizontal_fov>1.2</horizontal_fov></logical_camera>"))));
  EXPECT_EQ(camera.near, 0.2);
  EXPECT_EQ(camera.far, 7.0);
  EXPECT_EQ(camera.aspect_ratio, 1.5);
  EXPECT_EQ(camera.horizontal_fov, 1.2);
}

TEST_F(SdfSensors, UseTheMagneticFieldOfTheWorldOrTheDefaultOfSdf) {
  EXPECT_EQ(read("").magnetic_field, Eigen::Vector3d(5.5645e-6, 22.8758e-6, -42.3884e-6));
  EXPECT_EQ(read("<magnetic_field>1e-5 0 -4e-5</magnetic_field>").magnetic_field, Eigen::Vector3d(1e-5, 0, -4e-5));
}

TEST_F(SdfSensors, AcceptPosesInOtherFrames) {
  const auto altimeter = std::get<Altimeter>(
      device(model("<frame name=\"f\" attached_to=\"l\"><pose>0 0 0.5 0 0 0</pose></frame>" +
                   link("l", sensor("altimeter", "<pose relative_to=\"f\">0.1 0 0.25 0 0 0</pose>")))));
  EXPECT_TRUE(altimeter.X_LS.position.isApprox(Eigen::Vector3d(0.1, 0, 0.75), 1e-12));
}

TEST_F(SdfSensors, GetThePrefixOfNestedModels) {
  const World world = read("<model name=\"outer\">" + link("a", sensor("altimeter", "")) + "<model name=\"inner\">" +
                           link("b", sensor("altimeter", "")) + "</model>" + joint("j", "a", "inner::b") + "</model>");
  ASSERT_EQ(world.models[0].devices.size(), 2u);
  EXPECT_EQ(name_of(world.models[0].devices[0]), "s");
  EXPECT_EQ(name_of(world.models[0].devices[1]), "inner::s");
}

// Links come after their parents, and so do their sensors.
TEST_F(SdfSensors, KeepTheOrderOfTheLinks) {
  const World world = read(model(link("leaf", sensor("altimeter", "", "second")) +
                                 link("root", sensor("magnetometer", "", "first")) + joint("j", "root", "leaf")));
  ASSERT_EQ(world.models[0].devices.size(), 2u);
  EXPECT_EQ(std::get<Magnetometer>(world.models[0].devices[0]).link, 0u);
  EXPECT_EQ(std::get<Altimeter>(world.models[0].devices[1]).link, 1u);
}

TEST_F(SdfSensors, WarnOfUnsupportedTypes) {
  const World world = read(on_a_link(sensor("camera", "<camera><image/></camera>")));
  EXPECT_TRUE(world.robots.empty());
  const std::string warnings = texts_of(world.warnings);
  EXPECT_NE(warnings.find(":3: world/model[m]/link[l]/sensor[s]: a sensor of the type 'camera'"), std::string::npos)
      << warnings;
}

TEST_F(SdfSensors, WarnOfSensorsInStaticModels) {
  const World world = read(static_model_sdf("<link name=\"l\">" + sensor("altimeter", "") + "</link>"));
  EXPECT_TRUE(world.robots.empty());
  EXPECT_NE(texts_of(world.warnings).find("is static: its devices are ignored"), std::string::npos)
      << texts_of(world.warnings);
}

class FlawOfAnSdfSensor : public SdfSensors, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfAnSdfSensor, IsReportedWithItsPlace) {
  expect_only_flaw(GetParam(), write_world(on_a_link(GetParam().content)));
}

const std::string path = "world/model[m]/link[l]/sensor[s]";

INSTANTIATE_TEST_SUITE_P(
    Each, FlawOfAnSdfSensor,
    testing::Values(
        Flaw{sensor("lidar", "<lidar>\n" + scan + "</lidar>"), 3, path, "expected a <range> with a <max> > <min>"},
        Flaw{sensor("lidar", "<lidar>" + scan + "<range><min>2</min>\n<max>1</max></range></lidar>"), 4,
             path + "/lidar/range/max", "expected a <range> with a <max> > <min>"},
        Flaw{sensor("lidar", "<lidar>" + scan + "<range><min>0</min>\n<max>inf</max></range></lidar>"), 4,
             path + "/lidar/range/max", "expected a finite number"},
        Flaw{sensor("lidar",
                    "<lidar><scan><horizontal><samples>7</samples><min_angle>1\n</min_angle><max_angle>0.5"
                    "</max_angle></horizontal></scan>" +
                        range + "</lidar>"),
             3, path + "/lidar/scan/horizontal/min_angle", "the minimum angle exceeds the maximum"},
        Flaw{
            sensor("lidar", "<lidar><scan><horizontal><samples>7.5</samples></horizontal></scan>" + range + "</lidar>"),
            3, path + "/lidar/scan/horizontal/samples", "whole number"},
        Flaw{sensor("lidar",
                    "<lidar><scan><horizontal><samples>1000</samples></horizontal><vertical>\n<samples>1000"
                    "</samples></vertical></scan>" +
                        range + "</lidar>"),
             4, path + "/lidar/scan/vertical/samples", "expected at most 100000 rays"},
        Flaw{sensor("lidar", "<lidar>" + scan + range + "<noise><type>salt</type></noise></lidar>"), 3,
             path + "/lidar/noise", "not 'salt'"},
        Flaw{sensor("altimeter", "<update_rate>-1</update_rate>"), 3, path + "/update_rate", "expected a number >= 0"},
        Flaw{sensor("altimeter", "<update_rate>1,5</update_rate>"), 3, path + "/update_rate", "'1,5' is not a number"},
        Flaw{sensor("altimeter", "<update_rate>nan</update_rate>"), 3, path + "/update_rate", "'nan' is not a number"},
        Flaw{sensor("altimeter",
                    "<altimeter><vertical_position><noise type=\"gaussian\">\n<stddev>-1</stddev></noise>"
                    "</vertical_position></altimeter>"),
             4, path + "/altimeter/vertical_position/noise/stddev", "cannot have the value '-1'"},
        Flaw{sensor("altimeter",
                    "<altimeter><vertical_position>\n<noise type=\"white\"/></vertical_position></altimeter>"),
             4, path + "/altimeter/vertical_position/noise", "not 'white'"},
        Flaw{sensor("altimeter",
                    "<altimeter><vertical_position><noise type=\"gaussian\">\n<mean>x</mean></noise>"
                    "</vertical_position></altimeter>"),
             4, path + "/altimeter/vertical_position/noise/mean", "cannot have the value 'x'"},
        Flaw{sensor("contact", "<contact>\n<collision>food</collision></contact>"), 4, path + "/contact/collision",
             "the link has no collision 'food'; did you mean 'foot'?"},
        Flaw{sensor("contact", ""), 3, path, "missing: <contact><collision>"},
        Flaw{sensor("logical_camera", "<logical_camera><near>2</near><far>1</far></logical_camera>"), 3,
             path + "/logical_camera/far", "expected a distance > <near>"},
        Flaw{sensor("logical_camera", "<logical_camera><horizontal_fov>3.2</horizontal_fov></logical_camera>"), 3,
             path + "/logical_camera/horizontal_fov", "expected an angle > 0 and < pi"},
        Flaw{sensor("altimeter", "", "a/b"), 3, "world/model[m]/link[l]/sensor[a/b]", "without '/'"}));

TEST_F(SdfSensors, RejectDuplicateNames) {
  const std::string content = model(link("a", sensor("altimeter", "")) + "\n" +
                                    link("b", "\n" + sensor("magnetometer", "")) + joint("j", "a", "b"));
  expect_only_flaw({content, 4, "world/model[m]/link[b]/sensor[s]", "another device of the model has the name 's'"},
                   write_world(content));
  const std::string mixed = model(link("a", "\n" + sensor("altimeter", "")) +
                                  "<cohort:inclinometer name=\"s\"><cohort:link>a</cohort:link></cohort:inclinometer>");
  expect_only_flaw({mixed, 3, "world/model[m]/link[a]/sensor[s]", "another device of the model has the name 's'"},
                   write_world(mixed));
}

std::uint64_t hash_after(const World& world, int ticks) {
  Experiment experiment;
  experiment.world = world;
  Simulation simulation(experiment, 1);
  for (int tick = 0; tick < ticks; ++tick) simulation.step();
  return simulation.state_hash();
}

/// Every sensor, with unusual numbers.
std::string all_sensors() {
  const std::string noise =
      "<noise type=\"gaussian_quantized\"><mean>0.013</mean><stddev>0.017</stddev><bias_mean>0.0019</bias_mean>"
      "<bias_stddev>0.023</bias_stddev><dynamic_bias_stddev>0.029</dynamic_bias_stddev>"
      "<dynamic_bias_correlation_time>3.1</dynamic_bias_correlation_time><precision>0.0037</precision></noise>";
  const std::string pose = "<pose>0.11 -0.13 0.17 0.19 0.23 0.29</pose>";
  return sensor("lidar",
                pose +
                    "<update_rate>30</update_rate><ray><scan><horizontal><samples>7</samples><resolution>1"
                    "</resolution><min_angle>-1.1</min_angle><max_angle>0.9</max_angle></horizontal><vertical>"
                    "<samples>3</samples><min_angle>-0.31</min_angle><max_angle>0.07</max_angle></vertical></scan>"
                    "<range><min>0.07</min><max>3.3</max><resolution>0.0013</resolution></range><noise><type>"
                    "gaussian</type><mean>0.003</mean><stddev>0.007</stddev></noise></ray>",
                "lidar") +
         sensor("imu",
                pose + "<imu><angular_velocity><x>" + noise + "</x></angular_velocity><linear_acceleration><y>" +
                    noise +
                    "</y></linear_acceleration><orientation_reference_frame><localization>CUSTOM</localization>"
                    "<custom_rpy>0.31 0.37 0.41</custom_rpy></orientation_reference_frame></imu>",
                "imu") +
         sensor("contact", "<update_rate>7</update_rate><contact><collision>foot</collision></contact>", "contact") +
         sensor("altimeter",
                pose + "<altimeter><vertical_position>" + noise + "</vertical_position><vertical_velocity>" + noise +
                    "</vertical_velocity></altimeter>",
                "altimeter") +
         sensor("magnetometer", pose + "<magnetometer><x>" + noise + "</x><z>" + noise + "</z></magnetometer>",
                "magnetometer") +
         sensor("logical_camera",
                pose +
                    "<logical_camera><near>0.01</near><far>5.5</far><aspect_ratio>1.31</aspect_ratio>"
                    "<horizontal_fov>1.03</horizontal_fov></logical_camera>",
                "camera") +
         sensor("air_pressure",
                pose + "<air_pressure><reference_altitude>417.3</reference_altitude><pressure>" + noise +
                    "</pressure></air_pressure>",
                "pressure") +
         sensor("navsat",
                pose + "<navsat><position_sensing><horizontal>" + noise +
                    "</horizontal></position_sensing><velocity_sensing><vertical>" + noise +
                    "</vertical></velocity_sensing></navsat>",
                "navsat");
}

TEST_F(SdfSensors, SurviveAnExportUnchanged) {
  const std::string extension =
      "<cohort:accelerometer name=\"shake\"><cohort:link>b</cohort:link><cohort:bias>0.1</cohort:bias>"
      "</cohort:accelerometer><cohort:inclinometer name=\"lean\"><cohort:link>a</cohort:link><cohort:pose>0.1 0.2 0.3 "
      "0.4 0.5 0.6"
      "</cohort:pose><cohort:noise>0.013</cohort:noise></cohort:inclinometer>";
  const World world =
      read("<magnetic_field>1.1e-5 2.3e-6 -4.7e-5</magnetic_field>" +
           static_model_sdf(collision("<plane><normal>0 0 1</normal></plane>"), "floor") + "<model name=\"m\">" +
           "<pose>0 0 0.5 0.1 0.2 0.3</pose>" + link("b", sensor("altimeter", "", "other")) + link("a", all_sensors()) +
           "<joint name=\"j\" type=\"revolute\"><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz></axis>" +
           sensor("force_torque",
                  "<pose>0.1 0.2 0.3 0.4 0.5 0.6</pose><force_torque><frame>sensor</frame><measure_direction>"
                  "parent_to_child</measure_direction><force><y><noise type=\"gaussian\"><stddev>0.07</stddev></noise>"
                  "</y></force></force_torque>",
                  "wrench") +
           "</joint>" + extension + "</model>");
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  ASSERT_EQ(world.models[1].devices.size(), 12u);
  const auto text_of = [&](const World& each) { return parsing::xml_text(parsing::sdf_of(each, folder_)); };
  const World again = parsing::read_world(write("exported.sdf", text_of(world)), 1);
  EXPECT_TRUE(again.warnings.empty()) << texts_of(again.warnings);
  EXPECT_EQ(text_of(again), text_of(world));
  const World from_yaml =
      parsing::read_world(write("exported.yaml", parsing::yaml_of_sdf(parsing::sdf_of(world, folder_))), 1);
  EXPECT_EQ(text_of(from_yaml), text_of(world));
  EXPECT_EQ(hash_after(again, 100), hash_after(world, 100));
}

TEST_F(SdfSensors, MakeAModelARobotWithoutCommands) {
  Experiment experiment;
  experiment.world = read(on_a_link(sensor("altimeter", "")));
  const Simulation simulation(experiment, 1);
  ASSERT_EQ(simulation.robot_count(), 1u);
  EXPECT_EQ(simulation.kinds()[0].observation[0].name, "s/0/vertical_position");
  EXPECT_TRUE(simulation.kinds()[0].command.empty());
}

}  // namespace
}  // namespace cohort::description
