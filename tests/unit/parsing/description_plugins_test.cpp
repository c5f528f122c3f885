// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "server/parsing/plugins/gazebo_plugins.hpp"
#include "server/parsing/world/read_world.hpp"
#include "server/parsing/writing/write_world.hpp"
#include "tests/support/worlds/written_worlds.hpp"

/// Tests of reading plugins of Gazebo.
namespace cohort::description {
namespace {

std::string plugin(const std::string& filename, const std::string& parameters, const std::string& name = "p") {
  return "<plugin filename=\"" + filename + "\" name=\"" + name + "\">" + parameters + "</plugin>";
}
std::string limited(const std::string& effort) { return "<xyz>0 1 0</xyz><limit>" + effort + "</limit>"; }
// The content of the model is on line 3.
std::string model_with(const std::string& plugins, const std::string& axis = "<xyz>0 1 0</xyz>") {
  return "<model name=\"m\">" + links("abc") + joint("l", "a", "b", axis) + joint("r", "a", "c", axis) + "\n" +
         plugins + "\n</model>";
}
const std::string wheels = "<left_joint>l</left_joint><right_joint>r</right_joint>";

class Plugins : public Description {
 protected:
  Model read_model(const std::string& plugins, const std::string& axis = "<xyz>0 1 0</xyz>") const {
    const World world = read(model_with(plugins, axis));
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    return world.models[0];
  }
  template <class Kind>
  Kind device(const std::string& plugins, const std::string& axis = "<xyz>0 1 0</xyz>") const {
    const Model model = read_model(plugins, axis);
    EXPECT_EQ(model.devices.size(), 1u);
    return std::get<Kind>(model.devices.at(0));
  }
  void expect_warning(const std::string& plugins, const std::string& message) const {
    const World world = read(model_with(plugins));
    ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
    expect_problem(world.warnings, folder_ / "world.sdf", {"", 3, "world/model[m]/plugin[p]", message});
  }
  void expect_flaw(const std::string& plugins, const std::string& child, const std::string& message) const {
    SCOPED_TRACE(plugins);
    expect_only_flaw({"", 3, "world/model[m]/plugin[p]" + child, message}, write_world(model_with(plugins)));
  }
};

// For includes in worlds, in models, and in models of which only the parts are kept.
TEST_F(Plugins, InAnIncludeBelongToTheIncludedModel) {
  const std::string axis = "<xyz>0 1 0</xyz>";
  write_model("cart", links("abc") + joint("l", "a", "b", axis) + joint("r", "a", "c", axis));
  const auto include = [](const std::string& name, const std::string& parts, const std::string& merge = "") {
    return "<include" + merge + "><uri>model://cart</uri><name>" + name + "</name>\n" + parts + "</include>";
  };
  const std::string drive = plugin("gz-sim-diff-drive-system", wheels);
  const World world =
      read(include("driven", drive) + include("bare", "") + "<model name=\"outer\">" + include("inner", drive) +
           "</model><model name=\"merged\">" + include("inner", drive, " merge=\"true\"") + "</model>" +
           include("odd", plugin("odd", "", "odd")));
  std::map<std::string, std::size_t> devices;
  for (const Instance& instance : world.instances) devices[instance.name] = world.models[instance.model].devices.size();
  EXPECT_EQ(devices,
            (std::map<std::string, std::size_t>{{"driven", 1}, {"bare", 0}, {"outer", 1}, {"merged", 1}, {"odd", 0}}));
  ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
  expect_problem(world.warnings, folder_ / "world.sdf",
                 {"", 7, "world/model[odd]/plugin[odd]", "is not supported and is ignored"});
}

TEST_F(Plugins, AreFoundByFilesOfAllGenerationsAndByClasses) {
  for (const char* file :
       {"gz-sim-diff-drive-system", "libgz-sim-diff-drive-system.so", "gz-sim8-diff-drive-system",
        "ignition-gazebo-diff-drive-system", "libignition-gazebo-diff-drive-system.so",
        "libignition-gazebo6-diff-drive-system.so", "libgazebo_ros_diff_drive.so", "libDiffDrivePlugin.so"})
    EXPECT_EQ(device<DifferentialDrive>(plugin(file, wheels)).name, "cmd_vel") << file;
  for (const char* name : {"gz::sim::systems::DiffDrive", "ignition::gazebo::systems::DiffDrive"})
    EXPECT_EQ(device<DifferentialDrive>(plugin("anything", wheels, name)).name, "cmd_vel") << name;
}

TEST_F(Plugins, ReportJointsThatCloseLoops) {
  const std::string loop = joint("k", "b", "c");
  expect_flaw(loop + plugin("gz-sim-joint-controller-system", "<joint_name>k</joint_name>"), "/joint_name",
              "the joint 'k' closes a kinematic loop");
  expect_flaw(loop + plugin("gz-sim-joint-controller-system", "<joint_name>kk</joint_name>"), "/joint_name",
              "the model has no joint 'kk'");
}

TEST_F(Plugins, WarnOnceOfUnknownPlugins) {
  const std::string unknown = plugin("libfoo.so", "<x/>") + plugin("libfoo.so", "<y/>");
  expect_warning(unknown, "the plugin 'libfoo.so' is not supported and is ignored");
  const World world = read(unknown + "\n" + plugin("gz-sim-physics-system", "") +
                           model_with(unknown + plugin("gz-sim-elevator-system", "")));
  ASSERT_EQ(world.warnings.size(), 2u) << texts_of(world.warnings);
  EXPECT_EQ(world.warnings[0].line, 2);
  EXPECT_NE(world.warnings[1].message.find("gz-sim-elevator-system"), std::string::npos);
}

TEST_F(Plugins, IgnorePluginsThatNeedNoEquivalent) {
  for (const parsing::PluginKind& kind : parsing::plugin_kinds()) {
    if (kind.in_model != nullptr || kind.in_world != nullptr) continue;
    const std::string known = plugin(std::string(kind.name), "<a/>");
    const World world = read(known + model_with(known));
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  }
}

TEST_F(Plugins, ConvertDiffDrive) {
  const std::string whole = wheels +
                            "<wheel_separation>0.5</wheel_separation><wheel_radius>0.1</wheel_radius>"
                            "<topic>t</topic><max_linear_velocity>2</max_linear_velocity>"
                            "<min_linear_velocity>-2</min_linear_velocity><max_angular_velocity>3"
                            "</max_angular_velocity>";
  const auto drive =
      device<DifferentialDrive>(plugin("gz-sim-diff-drive-system", whole), limited("<effort>4</effort>"));
  EXPECT_EQ(drive.left_joints, std::vector<std::size_t>{0});
  EXPECT_EQ(drive.right_joints, std::vector<std::size_t>{1});
  EXPECT_EQ(drive.wheel_separation, 0.5);
  EXPECT_EQ(drive.wheel_radius, 0.1);
  EXPECT_EQ(drive.max_torque, 4.0);
  EXPECT_EQ(drive.max_linear, 2.0);
  EXPECT_EQ(drive.max_angular, 3.0);

  const auto plain = device<DifferentialDrive>(plugin("gz-sim-diff-drive-system", wheels));
  EXPECT_EQ(plain.wheel_separation, 1.0);
  EXPECT_EQ(plain.wheel_radius, 0.2);
  EXPECT_DOUBLE_EQ(plain.max_torque, 3.0 * 9.8 * 0.2) << "it lifts the three kilograms of the model";
  EXPECT_EQ(plain.max_linear, 20.0) << "wheels of 100 rad/s";

  const auto classic = device<DifferentialDrive>(
      plugin("libDiffDrivePlugin.so",
             "<leftJoint>l</leftJoint><rightJoint>r</rightJoint><wheelSeparation>0.4"
             "</wheelSeparation><wheelDiameter>0.3</wheelDiameter><wheelTorque>7</wheelTorque>"));
  EXPECT_EQ(classic.wheel_separation, 0.4);
  EXPECT_EQ(classic.wheel_radius, 0.15);
  EXPECT_EQ(classic.max_torque, 7.0);
}

TEST_F(Plugins, ReportProblemsWithPosition) {
  const auto drive = [](const std::string& parameters) { return plugin("gz-sim-diff-drive-system", parameters); };
  expect_flaw(drive("<left_joint>l</left_joint><right_joint>x</right_joint>"), "/right_joint", "has no joint 'x'");
  expect_flaw(drive("<left_joint>l</left_joint>"), "/right_joint", "missing");
  expect_flaw(drive(wheels + "<wheel_radius>0</wheel_radius>"), "/wheel_radius", "a number > 0");
  expect_flaw(drive(wheels) + plugin("gz-sim-joint-controller-system", "<joint_name>l</joint_name>"), "/joint_name",
              "already has a motor");
  expect_flaw(plugin("gz-sim-lift-drag-system", "<link_name>z</link_name>"), "/link_name", "has no link 'z'");
  expect_flaw(plugin("gz-sim-lift-drag-system", "<link_name>a</link_name><upward>1 0 0</upward>"), "", "not parallel");
  expect_flaw(plugin("gz-sim-hydrodynamics-system", "<link_name>a</link_name><xU>5</xU>"), "/xU", "at most 0");
  expect_flaw(plugin("gz-sim-linearbatteryplugin-system", "<capacity>1</capacity>"), "/voltage", "missing");
  expect_flaw(plugin("gz-sim-multicopter-motor-model-system",
                     "<jointName>l</jointName><linkName>b</linkName><turningDirection>up</turningDirection>"),
              "/turningDirection", "did you mean 'cw'?");
  expect_warning(drive(wheels + "<max_jerk>1</max_jerk><min_jerk>1</min_jerk><max_jerk>1</max_jerk>"),
                 "this plugin does not support <max_jerk>, <min_jerk>");
}

TEST_F(Plugins, DoNotDriveJointsOfDevices) {
  const Model model = read_model(
      plugin("gz-sim-diff-drive-system", wheels) +
      "<cohort:velocity_motor name=\"v\"><cohort:joint>l</cohort:joint><cohort:max_velocity>1</cohort:max_velocity>"
      "<cohort:max_effort>1</cohort:max_effort></cohort:velocity_motor>");
  ASSERT_EQ(model.devices.size(), 1u);
  EXPECT_EQ(name_of(model.devices[0]), "v");
}

TEST_F(Plugins, ConvertJointControllersToMotorsAndEncoders) {
  const Model both =
      read_model(plugin("gz-sim-joint-controller-system", "<joint_name>r</joint_name><joint_name>l</joint_name>"),
                 limited("<effort>5</effort><velocity>6</velocity>"));
  ASSERT_EQ(both.devices.size(), 2u);
  const auto velocity = std::get<VelocityMotor>(both.devices[0]);
  EXPECT_EQ(velocity.name, "r");
  EXPECT_EQ(velocity.joint, 1u);
  EXPECT_EQ(velocity.max_effort, 5.0);
  EXPECT_EQ(velocity.max_velocity, 6.0);
  const auto position =
      device<PositionMotor>(plugin("libignition-gazebo-joint-position-controller-system.so",
                                   "<joint_name>l</joint_name><cmd_max>30</cmd_max><topic>t</topic>"));
  EXPECT_EQ(position.max_effort, 30.0);
  EXPECT_EQ(position.max_velocity, 10.0);
  const Model all = read_model(plugin("gz-sim-joint-state-publisher-system", "") +
                               plugin("gz-sim-joint-controller-system", "<joint_name>r</joint_name>"));
  ASSERT_EQ(all.devices.size(), 3u);
  EXPECT_EQ(std::get<JointEncoder>(all.devices[0]).name, "l");
  EXPECT_EQ(std::get<JointEncoder>(all.devices[1]).joint, 1u);
  EXPECT_EQ(std::get<JointEncoder>(
                read_model(plugin("gz-sim-joint-state-publisher-system", "<joint_name>r</joint_name>")).devices.at(0))
                .joint,
            1u);
}

TEST_F(Plugins, ConvertPropellersToRotors) {
  const auto rotor = device<Rotor>(
      plugin("libignition-gazebo-multicopter-motor-model-system.so",
             "<jointName>l</jointName><linkName>b</linkName><turningDirection>ccw</turningDirection><motorNumber>0"
             "</motorNumber><motorType>velocity</motorType><maxRotVelocity>800</maxRotVelocity><motorConstant>9e-6"
             "</motorConstant><momentConstant>0.02</momentConstant><timeConstantUp>0.01</timeConstantUp>"));
  EXPECT_EQ(rotor.link, 0u);
  EXPECT_EQ(rotor.direction, Rotor::Direction::ccw);
  EXPECT_EQ(rotor.max_velocity, 800.0);
  EXPECT_EQ(rotor.motor_constant, 9e-6);
  EXPECT_EQ(rotor.moment_constant, 0.02);
  EXPECT_EQ(rotor.time_constant_up, 0.01);
  EXPECT_EQ(rotor.time_constant_down, 0.025);

  const auto thruster = device<Rotor>(plugin("gz-sim-thruster-system",
                                             "<joint_name>r</joint_name><propeller_diameter>0.2"
                                             "</propeller_diameter><thrust_coefficient>0.004"
                                             "</thrust_coefficient><max_thrust_cmd>64</max_thrust_cmd>"));
  EXPECT_DOUBLE_EQ(thruster.motor_constant, 1000.0 * 0.004 * std::pow(0.2, 4));
  EXPECT_EQ(thruster.density, 1000.0);
  EXPECT_DOUBLE_EQ(thruster.motor_constant * std::pow(thruster.max_velocity, 2), 64.0);
  EXPECT_DOUBLE_EQ(thruster.motor_constant * std::pow(thruster.min_velocity, 2), 1000.0);
  EXPECT_TRUE((thruster.X_LR.orientation * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
}

TEST_F(Plugins, ConvertLiftDragAndHydrodynamics) {
  const Model model = read_model(
      plugin("gz-sim-lift-drag-system",
             "<link_name>b</link_name><area>0.5</area><a0>0.1</a0><cla>4</cla><cp>1 2 3</cp>"
             "<forward>0 1 0</forward><upward>0 0 1</upward><alpha_stall>2</alpha_stall>") +
      plugin("gz-sim-hydrodynamics-system",
             "<link_name>c</link_name><xU>-1</xU><yVabsV>-2</yVabsV><nRR>-3</nRR><water_density>1025</water_density>"));
  EXPECT_FALSE(model.is_robot());
  const Fin& fin = model.fins.at(0);
  EXPECT_EQ(model.links[fin.link].name, "b");
  EXPECT_EQ(fin.area, 0.5);
  EXPECT_EQ(fin.alpha0, 0.1);
  EXPECT_EQ(fin.cla, 4.0);
  EXPECT_EQ(fin.alpha_stall, Fin{}.alpha_stall);
  EXPECT_EQ(fin.X_LF.position, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE((fin.X_LF.orientation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE((fin.X_LF.orientation * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
  const Drag& drag = model.drags.at(0);
  EXPECT_EQ(model.links[drag.link].name, "c");
  EXPECT_EQ(drag.damping, Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(drag.quadratic_damping, Eigen::Vector3d(0, 2, 0));
  EXPECT_EQ(drag.quadratic_angular_damping, Eigen::Vector3d(0, 0, 3));
}

TEST_F(Plugins, ConvertLinearBatteryPlugin) {
  const auto battery =
      device<Battery>(plugin("gz-sim-linearbatteryplugin-system",
                             "<battery_name>cell</battery_name><voltage>12</voltage><capacity>2"
                             "</capacity><initial_charge>1</initial_charge><power_load>5</power_load>"));
  EXPECT_EQ(battery.name, "cell");
  EXPECT_EQ(battery.capacity, 2.0 * 3600.0 * 12.0);
  EXPECT_EQ(battery.charge, 0.5);
  EXPECT_EQ(battery.idle_power, 5.0);
}

TEST_F(Plugins, ConvertPluginsOfTheWorldToWaterAirAndWind) {
  const World graded =
      read(plugin("gz-sim-buoyancy-system",
                  "<graded_buoyancy><default_density>1020</default_density><density_change><above_depth>2"
                  "</above_depth><density>1.3</density></density_change></graded_buoyancy>"));
  EXPECT_TRUE(graded.warnings.empty()) << texts_of(graded.warnings);
  ASSERT_TRUE(graded.water);
  EXPECT_EQ(graded.water->level, 2.0);
  EXPECT_EQ(graded.water->density, 1020.0);
  EXPECT_EQ(graded.air.density, 1.3);
  EXPECT_FALSE(read(plugin("gz-sim-buoyancy-system", "<uniform_fluid_density>1.1</uniform_fluid_density>")).water);
  const World windy = read(plugin("gz-sim-wind-effects-system",
                                  "<force_approximation_scaling_factor>0.5"
                                  "</force_approximation_scaling_factor>"));
  EXPECT_EQ(windy.air.wind_force, 0.5);
}

TEST_F(Plugins, LetTheWindOfThirdPartyWorldsActOnLinks) {
  const std::string wind = "<wind>\n<linear_velocity>3 0 0</linear_velocity></wind>";
  const auto read_foreign = [&](const std::string& content) {
    return parsing::read_world(
        write("windy.sdf", "<sdf version=\"1.9\"><world name=\"w\">" + content + "</world></sdf>"), 1);
  };
  for (const char* const file : {"gz-sim-wind-effects-system", "libignition-gazebo6-wind-effects-system.so"}) {
    const World windy = read_foreign(wind + plugin(file, ""));
    EXPECT_TRUE(windy.warnings.empty()) << texts_of(windy.warnings);
    EXPECT_EQ(windy.air.wind_force, Air{}.wind_force) << file;
  }
  const World calm = read_foreign(wind);
  EXPECT_EQ(calm.air.wind_force, 0.0);
  ASSERT_EQ(calm.warnings.size(), 1u) << texts_of(calm.warnings);
  expect_problem(calm.warnings, folder_ / "windy.sdf",
                 {"", 2, "world/wind/linear_velocity", "exerts no force on links without the plugin"});
  EXPECT_TRUE(read_foreign("<wind><linear_velocity>0 0 0</linear_velocity></wind>").warnings.empty());

  const World ours = read(wind);
  EXPECT_TRUE(ours.warnings.empty()) << texts_of(ours.warnings);
  EXPECT_EQ(ours.air.wind_force, Air{}.wind_force);
}

std::string track(const std::string& side, const std::string& link) {
  return "<" + side + "_track><link>" + link + "</link></" + side + "_track>";
}
std::string controller(const std::string& parameters) {
  return plugin("gz-sim-track-controller-system", parameters, "gz::sim::systems::TrackController");
}
const std::string tracks = track("left", "b") + track("right", "c");

TEST_F(Plugins, ConvertTrackedVehicle) {
  const std::string whole =
      tracks +
      "<tracks_separation>0.4</tracks_separation><tracks_height>0.18</tracks_height><steering_efficiency>0.6"
      "</steering_efficiency><linear_velocity><min_velocity>-2</min_velocity><max_velocity>2</max_velocity>"
      "</linear_velocity><angular_velocity><max_velocity>1.5</max_velocity></angular_velocity>";
  const std::string limits = "<min_velocity>-3</min_velocity><max_velocity>3</max_velocity>";
  const auto drive = device<TrackedDrive>(plugin("gz-sim-tracked-vehicle-system", whole) +
                                          controller("<link>b</link>" + limits) + controller("<link>c</link>"));
  EXPECT_EQ(drive.name, "cmd_vel");
  EXPECT_EQ(drive.left_links, std::vector<std::size_t>{1});
  EXPECT_EQ(drive.right_links, std::vector<std::size_t>{2});
  EXPECT_EQ(drive.track_separation, 0.4);
  EXPECT_EQ(drive.steering_efficiency, 0.6);
  EXPECT_EQ(drive.max_velocity, 3.0) << "that of its tracks' controllers, which are no belts of their own";
  EXPECT_EQ(drive.max_linear, 2.0);
  EXPECT_EQ(drive.max_angular, 1.5);

  const auto plain = device<TrackedDrive>(plugin("libignition-gazebo6-tracked-vehicle-system.so", tracks));
  EXPECT_EQ(plain.steering_efficiency, 0.5);
  EXPECT_EQ(plain.max_linear, 10.0);
  EXPECT_EQ(plain.max_angular, 2.0 * 10.0 * 0.5 / 1.0);
}

TEST_F(Plugins, ConvertTrackController) {
  const auto belt = device<Belt>(
      controller("<link>b</link><min_velocity>-2</min_velocity><max_velocity>2</max_velocity>"
                 "<velocity_topic>t</velocity_topic><track_orientation>0 0 1.5707963267948966</track_orientation>"));
  EXPECT_EQ(belt.name, "b");
  EXPECT_EQ(belt.link, 1u);
  EXPECT_EQ(belt.max_velocity, 2.0);
  EXPECT_TRUE(belt.axis_L.isApprox(-Eigen::Vector3d::UnitX(), 1e-12)) << belt.axis_L.transpose();
  EXPECT_EQ(device<Belt>(controller("<link>b</link>")).axis_L, Eigen::Vector3d::UnitY());
  EXPECT_EQ(device<Belt>(controller("<link>b</link>")).max_velocity, 10.0);
  expect_warning(plugin("gz-sim-track-controller-system",
                        "<link>b</link><max_velocity>1</max_velocity><max_acceleration>1</max_acceleration>"),
                 "this plugin does not support <max_acceleration>");
}

TEST_F(Plugins, WarnOfTrackControllerInAStaticModel) {
  const World world = read("<model name=\"m\"><static>true</static>" + links("b") + "\n" +
                           plugin("gz-sim-track-controller-system", "<link>b</link>") + "</model>");
  ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
  expect_problem(world.warnings, folder_ / "world.sdf", {"", 3, "world/model[m]/plugin[p]", "the model is static"});
}

TEST_F(Plugins, ReportProblemsOfTracksWithPosition) {
  const auto vehicle = [](const std::string& parameters) {
    return plugin("gz-sim-tracked-vehicle-system", parameters);
  };
  expect_flaw(vehicle(track("left", "b")), "/right_track", "missing: a track");
  expect_flaw(vehicle(track("left", "b") + track("right", "x")), "/right_track/link", "has no link 'x'");
  expect_flaw(vehicle(track("left", "b") + track("right", "b")), "/right_track/link", "already has a belt");
  expect_flaw(vehicle(tracks + "<right_track/>"), "/right_track/link", "missing: the link");
  expect_flaw(vehicle(tracks + "<tracks_separation>0</tracks_separation>"), "/tracks_separation", "a number > 0");
  expect_flaw(vehicle(tracks + "<steering_efficiency>2</steering_efficiency>"), "/steering_efficiency", "at most 1");
  const std::string nowhere = plugin("gz-sim-track-controller-system", "");
  expect_flaw(nowhere, "/link", "missing");
}

TEST_F(Plugins, DoNotDriveTheBeltsOfDevices) {
  const std::string device =
      "<cohort:belt name=\"mine\"><cohort:link>b</cohort:link><cohort:max_velocity>1</cohort:max_velocity>"
      "</cohort:belt><cohort:loudspeaker name=\"horn\"><cohort:link>c</cohort:link></cohort:loudspeaker>";
  const Model model = read_model(device + controller("<link>b</link>") + controller("<link>c</link>"));
  ASSERT_EQ(model.devices.size(), 3u);
  EXPECT_EQ(std::get<Belt>(model.devices[0]).name, "mine");
  EXPECT_EQ(std::get<Belt>(model.devices[2]).name, "c") << "a loudspeaker on it drives nothing";
}

// Returns a world with a model with this plugin on line 3, and a crate on line 5.
std::string with_crate(const std::string& parameters) {
  return model_with(plugin("gz-sim-detachable-joint-system", parameters)) + "\n<model name=\"crate\">" + links("xy") +
         joint("j", "x", "y", "<xyz>0 1 0</xyz>") + "</model>";
}

TEST_F(Plugins, ConvertDetachableJoint) {
  const World world =
      read(with_crate("<parent_link>b</parent_link><child_model>crate</child_model><child_link>y</child_link>"
                      "<detach_topic>t</detach_topic><attach_topic>t</attach_topic><output_topic>t</output_topic>"));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  const auto its = std::get<DetachableJoint>(world.models.at(0).devices.at(0));
  EXPECT_EQ(its.name, "crate");
  EXPECT_EQ(its.link, 1u);
  EXPECT_EQ(its.child, "crate");
  EXPECT_EQ(its.child_link, "y");
  EXPECT_FALSE(its.may_be_missing);
  EXPECT_TRUE(its.is_initially_attached);
}

TEST_F(Plugins, LetDetachableJointsStartDetached) {
  const World world =
      read(with_crate("<parent_link>b</parent_link><child_model>crate</child_model>"
                      "<child_link>y</child_link><initial_attach>false</initial_attach>"));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  EXPECT_FALSE(std::get<DetachableJoint>(world.models.at(0).devices.at(0)).is_initially_attached);
}

TEST_F(Plugins, WarnOfMissingChildrenOfDetachableJoints) {
  const std::string missing = "<parent_link>b</parent_link><child_model>crat</child_model><child_link>y</child_link>";
  const World world = read(with_crate(missing));
  ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
  expect_problem(world.warnings, folder_ / "world.sdf",
                 {"", 3, "world/model[m]/plugin[p]/child_model",
                  "there is no object 'crat'; did you mean 'crate'?; nothing is attached"});
  EXPECT_TRUE(read(with_crate(missing + "<suppress_child_warning>true</suppress_child_warning>")).warnings.empty());
}

TEST_F(Plugins, ReportProblemsOfDetachableJointsWithPosition) {
  const auto expect = [&](const std::string& parameters, const std::string& child, const std::string& message) {
    SCOPED_TRACE(parameters);
    expect_only_flaw({"", 3, "world/model[m]/plugin[p]" + child, message}, write_world(with_crate(parameters)));
  };
  const std::string link = "<parent_link>b</parent_link>";
  expect(link + "<child_model>crate</child_model><child_link>z</child_link>", "/child_model",
         "'crate' has no link 'z'");
  expect(link + "<child_model>m</child_model><child_link>a</child_link>", "/child_model", "an object other than 'm'");
  expect("<parent_link>z</parent_link><child_model>crate</child_model>", "/parent_link", "has no link 'z'");
  expect(link, "/child_model", "missing");
}

TEST_F(Plugins, InANestedModelDriveItsJoints) {
  const Model model =
      read("<model name=\"o\">" + links("a") + "\n" + model_with(plugin("libgz-sim-diff-drive-system.so", wheels)) +
           joint("j", "a", "m::a", "", "fixed") + "</model>")
          .models[0];
  ASSERT_EQ(model.devices.size(), 1u);
  const auto drive = std::get<DifferentialDrive>(model.devices[0]);
  EXPECT_EQ(drive.name, "m::cmd_vel");
  EXPECT_EQ(model.joints[drive.left_joints.at(0)].name, "m::l");
}

TEST_F(Plugins, AreReadFromGazeboBlocksOfAUrdf) {
  const auto file = write("robot.urdf",
                          "<robot name='r'><link name='a'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' "
                          "ixy='0' ixz='0' iyz='0'/></inertial></link><link name='b'><inertial><mass value='1'/>"
                          "<inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial></link>"
                          "<joint name='j' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 1 0'/>"
                          "</joint><gazebo><plugin filename='gz-sim-joint-controller-system' name='p'><joint_name>j"
                          "</joint_name></plugin></gazebo></robot>");
  const World world = parsing::read_world_or_model(file, 1, {});
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  EXPECT_EQ(std::get<VelocityMotor>(world.models.at(0).devices.at(0)).name, "j");
}

TEST_F(Plugins, AreReadFromOlderVersionsOfSdf) {
  const auto file =
      write("old.sdf", "<sdf version=\"1.6\"><world name=\"w\">" +
                           model_with(plugin("libgazebo_ros_diff_drive.so",
                                             wheels + "<ros><namespace>/r</namespace></ros><wheel_diameter>0.3"
                                                      "</wheel_diameter><max_wheel_torque>5</max_wheel_torque>")) +
                           "</world></sdf>");
  const World world = parsing::read_world(file, 1);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  const auto drive = std::get<DifferentialDrive>(world.models.at(0).devices.at(0));
  EXPECT_EQ(drive.wheel_radius, 0.15);
  EXPECT_EQ(drive.max_torque, 5.0);
}

TEST_F(Plugins, AreWrittenBackAsDevices) {
  const World world = read(model_with(plugin("gz-sim-diff-drive-system", wheels) +
                                      plugin("gz-sim-lift-drag-system", "<link_name>b</link_name>") +
                                      plugin("gz-sim-tracked-vehicle-system", tracks) +
                                      plugin("gz-sim-track-controller-system", "<link>a</link>") +
                                      plugin("gz-sim-detachable-joint-system",
                                             "<parent_link>a</parent_link><child_model>o</child_model><child_link>b"
                                             "</child_link>")) +
                           "<model name=\"o\">" + links("b") + "</model>");
  const std::string text = parsing::xml_text(parsing::sdf_of(world, folder_));
  EXPECT_EQ(text.find("<plugin"), std::string::npos);
  const World again = parsing::read_world(write("again.sdf", text), 1);
  EXPECT_EQ(parsing::xml_text(parsing::sdf_of(again, folder_)), text);
}

TEST_F(Plugins, AreListedInTheManual) {
  std::ifstream file(source / "docs/gazebo.md");
  std::stringstream text;
  text << file.rdbuf();
  for (const parsing::PluginKind& kind : parsing::plugin_kinds())
    EXPECT_NE(text.str().find("`" + std::string(kind.name) + "`"), std::string::npos) << kind.name;
}

}  // namespace
}  // namespace cohort::description
