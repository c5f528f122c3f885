// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "server/description/experiment.hpp"
#include "server/description/input_error.hpp"
#include "server/description/select_robots.hpp"
#include "server/description/world.hpp"
#include "server/geometry/shapes/footprint.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort::description {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

const fs::path shipped_experiment = source / "worlds/experiments/obstacle_avoidance.yaml";
const fs::path shipped_arena = source / "worlds/arenas/obstacles.sdf";

const Instance& instance(const World& world, const std::string& name) {
  const auto found = std::find_if(world.instances.begin(), world.instances.end(),
                                  [&](const Instance& each) { return each.name == name; });
  if (found == world.instances.end()) throw std::out_of_range("no instance " + name);
  return *found;
}

double yaw(const Pose& pose) { return 2.0 * std::atan2(pose.orientation.z(), pose.orientation.w()); }

std::string population(const std::string& count, const std::string& placement) {
  return "<cohort:population name=\"p\"><cohort:uri>model://sbot</cohort:uri><cohort:count>" + count +
         "</cohort:count><cohort:placement>" + placement + "</cohort:placement></cohort:population>";
}
std::string uniform(const std::string& min, const std::string& max) {
  return "<cohort:uniform><cohort:min>" + min + "</cohort:min><cohort:max>" + max + "</cohort:max></cohort:uniform>";
}

// ---- Shipped worlds ----

TEST(ShippedWorlds, HaveSixteenRobotsWithOneModel) {
  const Experiment experiment = parsing::read_experiment(shipped_experiment);
  EXPECT_EQ(experiment.name, "obstacle_avoidance");
  EXPECT_EQ(experiment.duration, 60s);
  EXPECT_EQ(experiment.seed, 1u);
  ASSERT_EQ(experiment.world.robots.size(), 16u);
  for (std::uint32_t id = 0; id < 16; ++id) {
    EXPECT_EQ(experiment.world.robot(id).name, "explorers/sbot_" + std::to_string(id));
    EXPECT_EQ(experiment.world.robot(id).model, experiment.world.robot(0).model);
  }
  ASSERT_EQ(experiment.teams.size(), 1u);
  EXPECT_EQ(experiment.teams[0].controller, "obstacle_avoidance");
  EXPECT_EQ(experiment.teams[0].robots.size(), 16u);
  EXPECT_EQ(experiment.teams[0].policy.on_late, OnLate::wait);
  EXPECT_TRUE(experiment.world.warnings.empty()) << experiment.world.warnings[0].text();
}

TEST(ShippedWorlds, HaveFourWallsTwentyFourObstaclesAndAGround) {
  const World world = parsing::read_world(shipped_arena, 1);
  EXPECT_EQ(world.step, 10ms);
  EXPECT_EQ(world.gravity, Eigen::Vector3d(0.0, 0.0, -9.81));
  int planes = 0, walls = 0;
  std::vector<geometry::Footprint> obstacles;
  for (const Instance& each : world.instances) {
    const Model& model = world.models[each.model];
    if (!model.is_static) continue;
    const Shape& shape = model.links[0].collisions[0].shape;
    if (std::holds_alternative<Plane>(shape))
      ++planes;
    else if (each.name.starts_with("wall"))
      ++walls;
    else
      for (const geometry::Footprint& footprint : geometry::footprints_of(model, each.X_WM))
        obstacles.push_back(footprint);
  }
  EXPECT_EQ(planes, 1);
  EXPECT_EQ(walls, 4);
  ASSERT_EQ(obstacles.size(), 24u);
  for (const geometry::Footprint& a : obstacles) {
    EXPECT_LE((a.centre.cwiseAbs() + a.half_extent()).maxCoeff(), 2.0 - 0.35);
    for (const geometry::Footprint& b : obstacles) {
      if (&a != &b) {
        EXPECT_GE(a.distance(b.centre) - b.half.norm() - b.radius, 0.25);
      }
    }
  }
}

TEST(ShippedWorlds, HaveAnSbotWithFramesMassesAndDevices) {
  const World world = parsing::read_world(shipped_arena, 1);
  const Model& sbot = world.robot_model(0);
  ASSERT_EQ(sbot.links.size(), 2u);
  EXPECT_EQ(sbot.links[0].name, "chassis");
  EXPECT_DOUBLE_EQ(sbot.links[0].inertial.mass, 0.4);
  EXPECT_DOUBLE_EQ(sbot.links[0].inertial.X_LI.position.z(), 0.033);
  EXPECT_NEAR(sbot.links[0].inertial.inertia(0, 0), 0.4 * (3 * 0.05 * 0.05 + 0.05 * 0.05) / 12, 1e-12);
  EXPECT_DOUBLE_EQ(sbot.links[1].X_ML.position.z(), 0.055);
  EXPECT_DOUBLE_EQ(sbot.links[1].inertial.inertia(2, 2), 0.3 * 0.058 * 0.058 / 2);
  EXPECT_DOUBLE_EQ(sbot.links[1].collisions[0].surface.friction, 0.3);
  ASSERT_EQ(sbot.joints.size(), 1u);
  EXPECT_EQ(sbot.joints[0].type, JointType::revolute);
  EXPECT_TRUE(std::isinf(sbot.joints[0].axis.upper));

  ASSERT_EQ(sbot.devices.size(), 14u);
  EXPECT_DOUBLE_EQ(std::get<TreelDrive>(sbot.devices[0]).max_velocity, 0.2);
  EXPECT_DOUBLE_EQ(std::get<VelocityMotor>(sbot.devices[1]).max_effort, 0.3);
  EXPECT_EQ(std::get<TreelEncoder>(sbot.devices[2]).drive, 0u);
  EXPECT_EQ(std::get<JointEncoder>(sbot.devices[3]).joint, 0u);
  const auto& ring = std::get<ProximityRing>(sbot.devices[6]);
  EXPECT_EQ(ring.link, 1u);
  EXPECT_EQ(ring.count, 15u);
  EXPECT_DOUBLE_EQ(ring.X_LS.position.z(), 0.02);
  EXPECT_DOUBLE_EQ(ring.first_bearing, std::numbers::pi / 15);
}

// ---- Populations ----

TEST_F(Description, PlacesByTheSeed) {
  const World one = parsing::read_world(shipped_arena, 1), again = parsing::read_world(shipped_arena, 1),
              other = parsing::read_world(shipped_arena, 2);
  for (std::uint32_t id = 0; id < 16; ++id) {
    EXPECT_EQ(one.robot(id).X_WM.position, again.robot(id).X_WM.position);
    EXPECT_EQ(one.robot(id).X_WM.orientation.coeffs(), again.robot(id).X_WM.orientation.coeffs());
    EXPECT_NE(one.robot(id).X_WM.position, other.robot(id).X_WM.position);
  }
}

TEST_F(Description, KeepsTheGapBetweenPlacedRobots) {
  constexpr double radius = 0.058, gap = 0.08;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const World world = parsing::read_world(shipped_arena, seed);
    for (const std::size_t robot : world.robots) {
      const Eigen::Vector2d centre = world.instances[robot].X_WM.position.head<2>();
      EXPECT_EQ(world.instances[robot].X_WM.position.z(), 0.0);
      for (std::size_t i = 0; i < world.instances.size(); ++i) {
        if (i == robot) continue;
        for (const geometry::Footprint& part :
             geometry::footprints_of(world.models[world.instances[i].model], world.instances[i].X_WM)) {
          EXPECT_GE(part.distance(centre), radius + gap - 1e-12) << world.instances[i].name;
        }
      }
    }
  }
}

TEST_F(Description, PlacesThousandsOfRobots) {
  const World world = read(population("3000", uniform("-8 -8", "8 8")));
  ASSERT_EQ(world.robots.size(), 3000u);
  EXPECT_EQ(world.models.size(), 1u);
  double nearest = 1.0;
  for (std::uint32_t a = 0; a < 3000; ++a)
    for (std::uint32_t b = a + 1; b < 3000; ++b)
      nearest = std::min(nearest, (world.robot(a).X_WM.position - world.robot(b).X_WM.position).norm());
  EXPECT_GE(nearest, 2 * 0.058 + 0.01);
}

TEST_F(Description, ReportsHowManyInstancesFit) {
  const auto problems = problems_of([&] { read(population("100", uniform("0 0", "0.5 0.5"))); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].line, 2);
  EXPECT_NE(problems[0].message.find(" of 100 fit"), std::string::npos) << problems[0].message;
}

TEST_F(Description, PlacesOnAFloorAndUnderABridge) {
  const std::string slab = collision("<box><size>9 9 0.1</size></box>");
  const World world =
      read(static_model_sdf("<pose>0 0 -0.05 0 0 0</pose>" + slab, "floor") +
           static_model_sdf("<pose>0 0 0.3 0 0 0</pose>" + slab, "bridge") + population("3", uniform("-1 -1", "1 1")));
  EXPECT_EQ(world.robots.size(), 3u);
}

TEST(Footprints, AreExactForUprightBoxesAndContainTiltedCylinders) {
  const auto turned = [](double angle, const Eigen::Vector3d& axis) {
    return Pose{Eigen::Vector3d::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis))};
  };
  const auto box = geometry::footprint_of(Box{{4.0, 2.0, 1.0}}, turned(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()));
  EXPECT_NEAR(box->distance({3.0, 0.0}), 2.0, 1e-12);
  EXPECT_NEAR(box->distance({0.0, 3.0}), 1.0, 1e-12);
  EXPECT_NEAR(box->distance({4.0, 6.0}), 5.0, 1e-12);
  const auto lying = geometry::footprint_of(Cylinder{0.5, 4.0}, turned(std::numbers::pi / 2, Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(lying->distance({3.0, 0.0}), 1.0, 1e-12);
  EXPECT_NEAR(lying->distance({0.0, 3.0}), 2.5, 1e-12);
  EXPECT_NEAR(lying->highest, 0.5, 1e-12);
  EXPECT_FALSE(geometry::footprint_of(Plane{}, Pose{}));
}

// ---- Models, frames and files ----

TEST_F(Description, SharesModelsBetweenIncludes) {
  const World world = read(
      "<include><uri>model://sbot</uri></include>"
      "<include><name>second</name><uri>robots/sbot</uri><pose>1 0 0 0 0 0</pose></include>"
      "<include><name>third</name><uri>robots/sbot/model.sdf</uri><pose>2 0 0 0 0 0</pose></include>"
      "<include><name>parked</name><uri>model://sbot</uri><pose>3 0 0 0 0 0</pose><static>true</static></include>" +
      population("2", uniform("5 5", "9 9")));
  EXPECT_EQ(world.models.size(), 2u);
  ASSERT_EQ(world.robots.size(), 5u);
  EXPECT_EQ(world.robot(0).name, "sbot");
  EXPECT_EQ(world.robot(2).name, "third");
  EXPECT_EQ(world.robot(4).name, "p/sbot_1");
  EXPECT_EQ(world.robot_model(1).name, "sbot");
  EXPECT_TRUE(world.models[instance(world, "parked").model].is_static);
  ASSERT_EQ(world.warnings.size(), 1u);
  EXPECT_NE(world.warnings[0].message.find("not a robot"), std::string::npos);
}

TEST_F(Description, ResolvesPosesThroughFrames) {
  const World world = read(
      "<frame name=\"corner\"><pose degrees=\"true\">1 2 0 0 0 90</pose></frame>"
      "<include><name>a</name><uri>model://sbot</uri><pose relative_to=\"corner\">1 0 0 0 0 0</pose></include>"
      "<include><name>b</name><uri>model://sbot</uri><pose relative_to=\"a\">2 0 0 0 0 0</pose></include>"
      "<include><name>c</name><uri>model://sbot</uri><placement_frame>turret</placement_frame>"
      "<pose>0 0 1 0 0 0</pose></include>" +
      static_model_sdf(
          "<frame name=\"f\"><pose>0 0 1 0 0 0</pose></frame><link name=\"l\">"
          "<pose relative_to=\"f\">0 1 0 0 0 0</pose><collision name=\"c\"><pose relative_to=\"f\">0 0 2 0 0 0"
          "</pose><geometry><sphere><radius>1</radius></sphere></geometry></collision></link>"));
  const Pose& a = instance(world, "a").X_WM;
  EXPECT_TRUE(a.position.isApprox(Eigen::Vector3d(1, 3, 0), 1e-12)) << a.position.transpose();
  EXPECT_NEAR(yaw(a), std::numbers::pi / 2, 1e-12);
  EXPECT_TRUE(instance(world, "b").X_WM.position.isApprox(Eigen::Vector3d(1, 5, 0), 1e-12));
  EXPECT_NEAR(instance(world, "c").X_WM.position.z(), 1.0 - 0.055, 1e-12);
  const Link& link = world.models[instance(world, "m").model].links[0];
  EXPECT_TRUE(link.X_ML.position.isApprox(Eigen::Vector3d(0, 1, 1), 1e-12));
  EXPECT_TRUE(link.collisions[0].X_LC.position.isApprox(Eigen::Vector3d(0, -1, 2), 1e-12));
}

TEST_F(Description, OrdersLinksFromTheRoot) {
  const World world =
      read("<model name=\"m\">" + links("dbca") + joint("one", "c", "d") + joint("two", "a", "b") +
           joint("three", "b", "c", "<xyz>1 0 0</xyz><limit><lower>-1</lower><upper>2</upper></limit>", "prismatic") +
           "</model>");
  const Model& model = world.models[0];
  std::string order;
  for (const Link& link : model.links) order += link.name;
  EXPECT_EQ(order, "abcd");
  for (const Joint& each : model.joints) EXPECT_EQ(each.child, each.parent + 1);
  EXPECT_EQ(model.joints[2].type, JointType::prismatic);
  EXPECT_EQ(model.joints[2].axis.lower, -1.0);
  EXPECT_EQ(model.joints[2].axis.upper, 2.0);
  EXPECT_EQ(model.joints[0].axis.lower, -std::numeric_limits<double>::infinity());
}

TEST_F(Description, TransformsAxesIntoTheFrameOfTheJoint) {
  const World world =
      read("<model name=\"m\"><frame name=\"f\"><pose degrees=\"true\">0 0 0 0 0 90</pose></frame>" + links("ab") +
           joint("j", "a", "b",
                 "<xyz expressed_in=\"f\">2 0 0</xyz><dynamics><damping>0.5</damping>"
                 "</dynamics>") +
           "</model>");
  const Joint& found = world.models[0].joints[0];
  EXPECT_TRUE(found.axis.direction.isApprox(Eigen::Vector3d::UnitY(), 1e-12)) << found.axis.direction.transpose();
  EXPECT_EQ(found.axis.damping, 0.5);
}

TEST_F(Description, AddsLinksAndDevicesOfMergedModels) {
  write_model("tall",
              "<include merge=\"true\"><uri>model://sbot</uri></include>" + links("m") + joint("mast", "turret", "m") +
                  "<cohort:joint_encoder name=\"mast\"><cohort:joint>mast</cohort:joint></cohort:joint_encoder>");
  const World world = read("<include><uri>model://tall</uri></include>");
  EXPECT_EQ(world.models[0].links.size(), 3u);
  EXPECT_EQ(world.models[0].devices.size(), 15u);
}

TEST_F(Description, SearchesTheModelPathFirstAndNeverTheWorkingDirectory) {
  write("mine/sbot/model.config", "<model><name>x</name><sdf version=\"1.9\">model.sdf</sdf></model>");
  write("mine/sbot/model.sdf", "<sdf version=\"1.9\"><model name=\"mine\">" + links("a") + "</model></sdf>");
  const fs::path world = write_world("<include><uri>model://sbot</uri></include>");
  const fs::path before = fs::current_path();
  fs::current_path(folder_ / "mine");
  EXPECT_EQ(parsing::read_world(world, 1).models[0].name, "sbot");
  fs::current_path(before);
  setenv("COHORT_MODEL_PATH", ("/nowhere:" + (folder_ / "mine").string()).c_str(), 1);
  EXPECT_EQ(parsing::read_world(world, 1).models[0].name, "mine");
  unsetenv("COHORT_MODEL_PATH");
}

TEST_F(Description, SearchesTheFoldersOfTheInstallationLast) {
  write("installed/sbot/model.config", "<model><name>x</name><sdf version=\"1.9\">model.sdf</sdf></model>");
  write("installed/sbot/model.sdf", "<sdf version=\"1.9\"><model name=\"theirs\">" + links("a") + "</model></sdf>");
  const fs::path world = write_world("<include><uri>model://sbot</uri></include>");
  EXPECT_EQ(parsing::read_world(world, 1, {folder_ / "nowhere", folder_ / "installed"}).models[0].name, "sbot");
  fs::remove_all(folder_ / "robots");
  EXPECT_EQ(parsing::read_world(world, 1, {folder_ / "nowhere", folder_ / "installed"}).models[0].name, "theirs");
}

TEST_F(Description, ReportsTheSearchedFoldersForAMissingModel) {
  const auto message_of = [&](const std::vector<fs::path>& last_folders) {
    const auto problems = problems_of([&] { parsing::read_world(folder_ / "world.sdf", 1, last_folders); });
    return problems.empty() ? "" : problems.front().message;
  };
  write_world("<include><uri>model://sbit</uri></include>");
  fs::create_directories(folder_ / "installed");
  EXPECT_EQ(message_of({folder_ / "nowhere", folder_ / "installed"}),
            "there is no model 'sbit' in " + (folder_ / "robots").string() + ", " + (folder_ / "installed").string() +
                "; did you mean 'sbot'?");
  write_world("<include><uri>model://zeppelin</uri></include>");
  EXPECT_NE(message_of({}).find("; set COHORT_MODEL_PATH to search more folders"), std::string::npos);
  fs::remove_all(folder_ / "robots");
  EXPECT_NE(message_of({}).find("there is no folder 'robots' or 'objects' beside the world file"), std::string::npos);
}

TEST_F(Description, HasDefaultGravityAndStep) {
  const World world = read("<physics type=\"ode\"/>");
  EXPECT_EQ(world.step, 10ms);
  EXPECT_EQ(world.gravity, Eigen::Vector3d(0.0, 0.0, -9.8));
  EXPECT_TRUE(world.instances.empty());
}

TEST_F(Description, DoesNotWarnOfTheEngineThatAWorldNames) {
  for (const char* const engine : {"ode", "bullet", "dart", "ignored"})
    EXPECT_EQ(texts_of(read("<physics type=\"" + std::string(engine) + "\"/>").warnings), "");
}

TEST_F(Description, WarnsOnceOfEachUnsupportedElement) {
  const World world = read(
      "<state world_name=\"w\"/>\n"
      "<model name=\"m\"><gripper name=\"g\"><gripper_link>l</gripper_link><palm_link>l</palm_link></gripper>"
      "<link name=\"l\"><gravity>true</gravity>\n"
      "<sensor name=\"s\" type=\"camera\"/></link></model>");
  std::string all;
  for (const Problem& warning : world.warnings) all += warning.text() + "\n";
  EXPECT_EQ(world.warnings.size(), 5u) << all;  // and that the link has neither mass nor inertia
  EXPECT_NE(all.find(":2: world/state: "), std::string::npos) << all;
  EXPECT_NE(all.find(":3: world/model[m]/gripper[g]: "), std::string::npos) << all;
  EXPECT_NE(all.find(":4: world/model[m]/link[l]/sensor[s]: "), std::string::npos) << all;
}

TEST_F(Description, PrintsNothingForInvalidFiles) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  problems_of([&] { read("<model name=\"m\"><link name=\"l\"><inertial><mass>x</mass></inertial></link></model>"); });
  problems_of([&] { read("<include><uri>model://nothing</uri></include>"); });
  problems_of([&] { parsing::read_world(write("broken.sdf", "<sdf version='1.9'><world>"), 1); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

// ---- Invalid worlds ----

class FlawOfAWorld : public Description, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfAWorld, IsReportedAloneWithFileLineAndElement) {
  expect_only_flaw(GetParam(), write_world(GetParam().content));
}

std::string inertial(const std::string& mass, const std::string& izz) {
  return "<model name=\"m\"><link name=\"l\"><inertial>\n<mass>" + mass +
         "</mass>\n<inertia><ixx>1</ixx><iyy>1</iyy><izz>" + izz +
         "</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial></link></model>";
}
std::string motor(const std::string& keys, const std::string& kind = "cohort:velocity_motor") {
  return "<model name=\"m\">" + links("ab") + joint("hinge", "a", "b") + "\n<" + kind + " name=\"d\">\n" + keys +
         "\n</" + kind + "></model>";
}
const std::string in_motor = "world/model[m]/cohort:velocity_motor[d]";

INSTANTIATE_TEST_SUITE_P(
    Worlds, FlawOfAWorld,
    testing::Values(
        Flaw{inertial("0", "1"), 3, "world/model[m]/link[l]/inertial/mass", "expected a mass > 0"},
        Flaw{inertial("inf", "1"), 3, "world/model[m]/link[l]/inertial/mass", "expected a mass > 0"},
        Flaw{inertial("nan", "1"), 3, "world/model[m]/link[l]/inertial/mass", "'nan' is not a number"},
        Flaw{inertial("1,5", "1"), 3, "world/model[m]/link[l]/inertial/mass", "'1,5' is not a number"},
        Flaw{inertial("", "1"), 3, "world/model[m]/link[l]/inertial/mass", "expected a number"},
        Flaw{inertial("x", "1"), 3, "world/model[m]/link[l]/inertial/mass", "cannot have the value 'x'"},
        Flaw{inertial("1", "0"), 4, "world/model[m]/link[l]/inertial/inertia", "not positive definite"},
        Flaw{inertial("1", "3"), 4, "world/model[m]/link[l]/inertial/inertia", "exceeds the sum"},
        Flaw{static_model_sdf("\n" + collision("<sphere><radius>0</radius></sphere>")), 3,
             "world/model[m]/link[l]/collision[c]/geometry/sphere/radius", "expected a size > 0"},
        Flaw{static_model_sdf(collision("<box><size>1 -1 1</size></box>")), 2,
             "world/model[m]/link[l]/collision[c]/geometry/box/size", "expected a size > 0"},
        Flaw{static_model_sdf(
                 collision("<sphere><radius>1</radius></sphere>",
                           "<surface><bounce><restitution_coefficient>nan</restitution_coefficient></bounce>"
                           "</surface>")),
             2, "world/model[m]/link[l]/collision[c]/surface/bounce/restitution_coefficient", "'nan'"},
        Flaw{"<model name=\"m\"><link name=\"l\"><collision name=\"c\"><geometry><plane/></geometry></collision>"
             "</link></model>",
             2, "world/model[m]/link[l]/collision[c]/geometry", "<static>"},
        Flaw{static_model_sdf("\n<pose>0 0 0 1e100 0 0</pose>" + links("a")), 3, "world/model[m]/pose",
             "expected angles from -1e6 to 1e6 rad, not '0 0 0 1e100 0 0'"},
        Flaw{static_model_sdf("<pose degrees=\"true\">0 0 0 0 0 -6e7</pose>" + links("a")), 2, "world/model[m]/pose",
             "expected angles from -1e6 to 1e6 rad"},
        Flaw{static_model_sdf("<pose rotation_format=\"quat_xyzw\">0 0 0 0 0 0 1e200</pose>" + links("a")), 2,
             "world/model[m]/pose", "expected a unit quaternion"},
        Flaw{static_model_sdf("<link name=\"l\"><pose>0 0 0 0 2e6 0</pose></link>"), 2, "world/model[m]/link[l]/pose",
             "expected angles"},
        Flaw{static_model_sdf("<link name=\"l\"><visual name=\"v\"><pose>0 0 0 0 0 1e7</pose><geometry><sphere/>"
                              "</geometry></visual></link>"),
             2, "world/model[m]/link[l]/visual[v]/pose", "expected angles"},
        Flaw{"<frame name=\"f\"><pose>0 0 0 0 0 1e7</pose></frame>", 2, "world/frame[f]/pose", "expected angles"},
        Flaw{"<include><uri>model://sbot</uri>\n<pose>0 0 0 0 0 1e100</pose></include>", 3, "world/include[sbot]/pose",
             "expected angles from -1e6 to 1e6 rad"},
        Flaw{static_model_sdf("<pose>0 0 inf 0 0 0</pose>" + links("a")), 2, "world/model[m]/pose", "'0 0 inf 0 0 0'"},
        Flaw{static_model_sdf("<pse/>" + links("a")), 2, "world/model[m]/pse", "unknown element; did you mean 'pose'?"},
        Flaw{"<model name=\"m\">\n<link nam=\"l\"/></model>", 3, "world/model[m]/link/@nam",
             "unknown attribute; did you mean 'name'?"},
        Flaw{static_model_sdf(links("a")) + "\n" + static_model_sdf(links("a")), 3, "world/model[m]", "another model"},
        Flaw{static_model_sdf(links("a"), "sbot") + "\n<include><uri>model://sbot</uri></include>", 3,
             "world/include[sbot]", "another model"},
        Flaw{"\n<include><uri>model://sbit</uri></include>", 3, "world/include/uri", "there is no model 'sbit'"},
        Flaw{"<include>\n<uri>https://somewhere/sbot</uri></include>", 3, "world/include/uri",
             "Cohort does not download"},
        Flaw{"<physics type=\"ode\">\n<max_step_size>0</max_step_size></physics>", 3, "world/physics/max_step_size",
             "expected a step > 0"},
        Flaw{"<physics type=\"ode\">\n<max_step_size>1.5e-9</max_step_size></physics>", 3,
             "world/physics/max_step_size", "whole number of nanoseconds"},
        Flaw{"<model name=\"m\">" + links("ab") + "\n" + joint("j", "a", "b", "<xyz>0 0 1</xyz>", "revolut") +
                 "</model>",
             3, "world/model[m]/joint[j]", "'revolut' is not supported"},
        Flaw{"<model name=\"m\">" + links("ab") + "\n" + joint("j", "a", "b", "<xyz>0 0 0</xyz>") + "</model>", 3,
             "world/model[m]/joint[j]/axis/xyz", "not zero"},
        Flaw{"<include><uri>model://sbot</uri>\n<pose relativ_to=\"x\"/></include>", 3, "world/include/pose",
             "did you mean 'relative_to'?"},
        Flaw{"\n<include><name>s</name><uri>model://sbot</uri><pose relative_to=\"x\"/></include>", 3,
             "world/include[s]", "'x'"},
        Flaw{"<model name=\"m\">" + links("ab") + "\n" + joint("j", "a", "x") + "</model>", 3,
             "world/model[m]/joint[j]", "'x'"},
        Flaw{motor("<cohort:joint>hinge</cohort:joint>\n<cohort:max_velocity>1</cohort:max_velocity>"), 3,
             in_motor + "/cohort:max_effort", "missing"},
        Flaw{motor("<cohort:joint>hinge</cohort:joint><cohort:max_velocity>-1</cohort:max_velocity>\n"
                   "<cohort:max_effort>1</cohort:max_effort>"),
             4, in_motor + "/cohort:max_velocity", "expected a number > 0, not '-1'"},
        Flaw{motor("<cohort:joint>hing</cohort:joint><cohort:max_velocity>1</cohort:max_velocity>"
                   "<cohort:max_effort>1</cohort:max_effort>"),
             4, in_motor + "/cohort:joint", "did you mean 'hinge'?"},
        Flaw{motor("<cohort:joint>hinge</cohort:joint><cohort:max_velocity>1</cohort:max_velocity>"
                   "<cohort:max_effort>1</cohort:max_effort>\n<cohort:max_efort>1</cohort:max_efort>"),
             5, in_motor + "/cohort:max_efort", "did you mean 'cohort:max_effort'?"},
        Flaw{motor("<cohort:joint>hinge</cohort:joint><cohort:max_velocity>1</cohort:max_velocity>"
                   "\n<cohort:max_efort>1</cohort:max_efort>"),
             5, in_motor + "/cohort:max_efort", "did you mean 'cohort:max_effort'?"},
        Flaw{motor("", "cohort:velocity_moter"), 3, "world/model[m]/cohort:velocity_moter[d]",
             "did you mean 'cohort:velocity_motor'?"},
        Flaw{motor("", "cohort:population"), 3, "world/model[m]/cohort:population[d]", "must be in <world>"},
        Flaw{population("0", uniform("0 0", "1 1")), 2, "world/cohort:population[p]/cohort:count", "not '0'"},
        Flaw{population("1", "\n" + uniform("0 0", "1 -1")), 3,
             "world/cohort:population[p]/cohort:placement/cohort:uniform/cohort:min", "exceeds"}));

TEST_F(Description, ReportsInvalidXmlWithTheLine) {
  const fs::path file = write("w.sdf", "<sdf version=\"1.9\">\n<world name=\"w\">\n<model>\n</world></sdf>");
  const auto problems = problems_of([&] { parsing::read_world(file, 1); });
  expect_problem(problems, file, {"", 4, "", "</world> does not close <model> of line 3"});
}

TEST_F(Description, ReportsMissingFiles) {
  const auto problems = problems_of([&] { parsing::read_world(folder_ / "none.sdf", 1); });
  expect_problem(problems, folder_ / "none.sdf", {"", 0, "", "no such file"});
}

TEST_F(Description, ReportsProblemsOfIncludedFilesOnce) {
  write_model("bad", "<link name=\"l\">\n<inertial><mass>-1</mass></inertial></link>");
  write_model("worse", "<link name=\"l\">\n<inertial><mass>x</mass></inertial></link>");
  const fs::path file = write_world(
      "<include><uri>model://bad</uri></include><include><name>bad2</name><uri>model://bad</uri></include>"
      "<include><uri>model://worse</uri></include>\n"
      "<cohort:population name=\"p\"/>");
  const auto problems = problems_of([&] { parsing::read_world(file, 1); });
  expect_problem(problems, folder_ / "robots/bad/model.sdf",
                 {"", 3, "model[bad]/link[l]/inertial/mass", "expected a mass > 0"});
  expect_problem(problems, folder_ / "robots/worse/model.sdf",
                 {"", 3, "model[worse]/link[l]/inertial/mass", "cannot have the value 'x'"});
  expect_problem(problems, file, {"", 3, "world/cohort:population[p]/cohort:uri", "missing"});
  EXPECT_EQ(problems.size(), 5u);  // the population misses three things
}

TEST_F(Description, ReportsAnIncludeOutsideOfAllFoldersAtItsLine) {
  const fs::path file = write_world("\n<include><uri>/etc/passwd</uri></include>");
  const auto problems = problems_of([&] { parsing::read_world(file, 1); });
  expect_problem(problems, file, {"", 3, "world/include/uri", "the file is outside of all allowed folders"});
}

TEST_F(Description, ReportsNamesOfMergedModelsOnceEach) {
  write_model("part", links("ab"));
  std::string includes = links("c");
  for (int i = 0; i < 400; ++i)
    includes += "<include merge=\"true\"><name>p" + std::to_string(i) + "</name><uri>model://part</uri></include>";
  write_model("whole", includes);
  const fs::path file = write_world("<include><uri>model://whole</uri></include>");
  const auto problems = problems_of([&] { parsing::read_world(file, 1); });
  ASSERT_EQ(problems.size(), 2u);
  for (const Problem& problem : problems)
    EXPECT_NE(problem.message.find("is already used"), std::string::npos) << problem.text();
}

TEST_F(Description, ReportsAtMostAHundredNamesThatAreUsedTwice) {
  std::string model = "<model name=\"m\">";
  for (int i = 0; i < 300; ++i)
    model += "<link name=\"l" + std::to_string(i) + "\"/><link name=\"l" + std::to_string(i) + "\"/>";
  EXPECT_LE(problems_of([&] { read(model + "</model>"); }).size(), 100u);
}

TEST_F(Description, ShortensValuesOfAnyLengthInMessages) {
  const std::string value(1'000'000, 'x');
  const auto problems = problems_of([&] { read("<gravity>" + value + "</gravity>"); });
  ASSERT_FALSE(problems.empty());
  EXPECT_LT(problems.front().text().size(), 10'000u);
  EXPECT_NE(problems.front().message.find("'xxxx"), std::string::npos);
}

TEST_F(Description, WarnsOfRobotsWhoseSizesMayBeInMillimetres) {
  const auto robot = [](const std::string& radius) {
    return "<model name=\"m\"><link name=\"hull\"><inertial><mass>1</mass></inertial></link>"
           "<link name=\"wheel\"><inertial><mass>1</mass></inertial><collision name=\"c\"><geometry><sphere><radius>" +
           radius + "</radius></sphere></geometry></collision></link>" + joint("axle", "hull", "wheel") + "</model>";
  };
  const auto warning_of = [&](const std::string& world) {
    const auto warnings = read(world).warnings;
    const auto found = std::ranges::find_if(warnings, [](const Problem& warning) {
      return warning.message.find("sizes are in metres") != std::string::npos;
    });
    return found == warnings.end() ? "" : found->message;
  };
  EXPECT_TRUE(warning_of(robot("30")).starts_with("is 60 x 60 x 60 m large; sizes are in metres"))
      << warning_of(robot("30"));
  EXPECT_EQ(warning_of(robot("0.03")), "");
  EXPECT_EQ(warning_of("<model name=\"hall\"><static>true</static><link name=\"l\"><collision name=\"c\"><geometry>"
                       "<box><size>100 100 10</size></box></geometry></collision></link></model>"),
            "");
}

TEST_F(Description, ReportsInvalidValuesTogetherWithOtherProblems) {
  const fs::path file = write_world(
      "<gravity>0 0 x</gravity><model name=\"m\"><link name=\"l\">\n<inertial><mass>heavy</mass></inertial>\n"
      "<collision name=\"c\"><geometry><box><size>1 1</size></box></geometry></collision>\n"
      "<cohort:grip_ring name=\"r\"><cohort:radiuss>1</cohort:radiuss></cohort:grip_ring></link></model>");
  const auto problems = problems_of([&] { parsing::read_world(file, 1); });
  expect_problem(problems, file, {"", 2, "world/gravity", "cannot have the value '0 0 x'"});
  expect_problem(problems, file, {"", 3, "world/model[m]/link[l]/inertial/mass", "cannot have the value 'heavy'"});
  expect_problem(problems, file,
                 {"", 4, "world/model[m]/link[l]/collision[c]/geometry/box/size", "cannot have the value '1 1'"});
  expect_problem(problems, file,
                 {"", 5, "world/model[m]/link[l]/cohort:grip_ring[r]/cohort:radiuss", "did you mean 'cohort:radius'?"});
  EXPECT_EQ(problems.size(), 4u);
}

// ---- Experiments ----

class Experiments : public Description {
 protected:
  Experiments() { write_world(population("4", uniform("0 0", "2 2"))); }
  fs::path write_experiment(const std::string& text) const { return write("e.yaml", text); }
};

TEST_F(Experiments, ReadTeamsWithRobotsAndPolicies) {
  const Experiment experiment = parsing::read_experiment(write_experiment(
      "world: world.sdf\nduration: 0.25\nseed: 18446744073709551615\nteams:\n"
      "  - {name: a, robots: [3, p/*_0], controller: x, period: 3, phase: 2, delay: 1, on_late: hold, deadline: 0.05}\n"
      "  - {name: b, robots: 1..2, controller: y,\n     restart: never}\n"));
  EXPECT_EQ(experiment.duration, 250ms);
  EXPECT_EQ(experiment.seed, 18446744073709551615u);
  ASSERT_EQ(experiment.teams.size(), 2u);
  EXPECT_EQ(experiment.teams[0].robots, (std::vector<std::uint32_t>{0, 3}));
  EXPECT_EQ(experiment.teams[1].robots, (std::vector<std::uint32_t>{1, 2}));
  const Policy& policy = experiment.teams[0].policy;
  EXPECT_EQ(policy.period, 3u);
  EXPECT_EQ(policy.phase, 2u);
  EXPECT_EQ(policy.delay, 1u);
  EXPECT_EQ(policy.on_late, OnLate::hold);
  EXPECT_EQ(policy.deadline, 50ms);
  EXPECT_EQ(experiment.teams[0].restart, Restart::on_failure);
  EXPECT_EQ(experiment.teams[1].restart, Restart::never);
  EXPECT_EQ(experiment.teams[1].controller_line, 6);
}

TEST_F(Experiments, FlattenParametersInOrder) {
  const Experiment experiment = parsing::read_experiment(write_experiment(
      "world: world.sdf\nduration: 1\nteams:\n  - name: a\n    robots: all\n    controller: x\n    parameters:\n"
      "      wheel/0/velocity:\n        bias: 0.2\n        eye/*/reading: [1, -2]\n      mode: fast\n"));
  const Team& team = experiment.teams[0];
  EXPECT_EQ(team.controller_line, 6);
  ASSERT_EQ(team.parameters.size(), 3u);
  EXPECT_EQ(team.parameters[0].name, "wheel/0/velocity.bias");
  EXPECT_EQ(team.parameters[0].line, 9);
  EXPECT_EQ(team.parameters[1].name, "wheel/0/velocity.eye/*/reading");
  EXPECT_EQ(team.parameters[1].values, (std::vector<std::string>{"1", "-2"}));
  EXPECT_EQ(team.parameters[2].name, "mode");
  EXPECT_EQ(team.parameters[2].values, std::vector<std::string>{"fast"});
}

TEST_F(Experiments, UseSeedAndDurationOfTheCaller) {
  const fs::path file = write_experiment("world: world.sdf\nteams: [{name: a, robots: all, controller: x}]\n");
  const Experiment experiment = parsing::read_experiment(file, 7, 2s);
  EXPECT_EQ(experiment.seed, 7u);
  EXPECT_EQ(experiment.duration, 2s);
  EXPECT_EQ(experiment.world.robot(0).X_WM.position,
            parsing::read_world(folder_ / "world.sdf", 7).robot(0).X_WM.position);
}

TEST_F(Experiments, ResolveSelectors) {
  const World world = parsing::read_world(folder_ / "world.sdf", 1);
  using Ids = std::vector<std::uint32_t>;
  EXPECT_EQ(select_robots(world, "all"), (Ids{0, 1, 2, 3}));
  EXPECT_EQ(select_robots(world, " 2 "), (Ids{2}));
  EXPECT_EQ(select_robots(world, "1..3"), (Ids{1, 2, 3}));
  EXPECT_EQ(select_robots(world, "p/sbot_3"), (Ids{3}));
  EXPECT_EQ(select_robots(world, "*s*t_*"), (Ids{0, 1, 2, 3}));
  EXPECT_EQ(select_robots(world, "*_1"), (Ids{1}));
  for (const char* const wrong : {"", "4", "0..4", "3..1", "p/sbot_", "P/*", "1..", "-1"})
    EXPECT_THROW(select_robots(world, wrong), std::invalid_argument) << wrong;

  World large = world;
  while (large.robots.size() < 40) large.robots.push_back(large.robots[large.robots.size() % 4]);
  try {
    select_robots(large, "green/*");
    FAIL() << "no robot is called so";
  } catch (const std::invalid_argument& error) {
    EXPECT_STREQ(error.what(), "there is no robot 'green/*'; known: p/sbot_*") << "of many, how they are called";
  }
}

class FlawOfAnExperiment : public Experiments, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfAnExperiment, IsReportedAloneWithFileLineAndKey) {
  const fs::path file = write_experiment(GetParam().content);
  const auto problems = problems_of([&] { parsing::read_experiment(file); });
  expect_problem(problems, file, GetParam());
  EXPECT_EQ(problems.size(), 1u);
}

const std::string top = "world: world.sdf\nduration: 1\n";
std::string team(const std::string& robots, const std::string& rest = "") {
  return top + "teams:\n  - name: a\n    controller: x\n    robots: " + robots + "\n" + rest;
}

INSTANTIATE_TEST_SUITE_P(
    Experiments, FlawOfAnExperiment,
    testing::Values(
        Flaw{"world: [a\n", 2, "", "not YAML"}, Flaw{"- a\n", 1, "", "not a list"},
        Flaw{team("all", "sed: 3\n"), 7, "sed", "did you mean 'seed'?"},
        Flaw{team("all", "duration: 3\n"), 7, "duration", "given twice"},
        Flaw{team("all", "seed: -1\n"), 7, "seed", "not '-1'"},
        Flaw{team("all", "    controler: y\n"), 7, "teams[0].controler", "did you mean 'controller'?"},
        Flaw{"world: world.sdf\nduraton: 1\nteams: [{name: a, controller: x, robots: all}]\n", 2, "duraton",
             "did you mean 'duration'?"},
        Flaw{top + "teams:\n  - name: a\n    controller: x\n    robot: all\n", 6, "teams[0].robot",
             "did you mean 'robots'?"},
        Flaw{team("all", "    period: 0\n"), 7, "teams[0].period", "not '0'"},
        Flaw{team("all", "    phase: 1\n"), 7, "teams[0].phase", "less than the period"},
        Flaw{team("all", "    delay: [1]\n"), 7, "teams[0].delay", "not a list"},
        Flaw{team("all", "    on_late: halt\n"), 7, "teams[0].on_late", "unknown policy 'halt'"},
        Flaw{team("all", "    restart: nevr\n"), 7, "teams[0].restart", "did you mean 'never'?"},
        Flaw{team("all", "    restart: sometimes\n"), 7, "teams[0].restart", "known: on_failure, never"},
        Flaw{team("all", "    on_late: zero\n"), 4, "teams[0].deadline", "missing"},
        Flaw{team("all", "    deadline: 1\n"), 7, "teams[0].deadline", "waits without a time limit"},
        Flaw{team("all", "    parameters: [1]\n"), 7, "teams[0].parameters", "'NAME: VALUE' lines, not a list"},
        Flaw{team("all", "    parameters:\n      gain:\n"), 8, "teams[0].parameters.gain", "not nothing"},
        Flaw{team("all", "    parameters:\n      a:\n        b: [[1]]\n"), 9, "teams[0].parameters.a.b",
             "a list that contains lists or maps"},
        Flaw{team("all", "    parameters:\n      a: 1\n      a: 2\n"), 9, "teams[0].parameters.a", "given twice"},
        Flaw{team("p/bot_1"), 6, "teams[0].robots", "there is no robot 'p/bot_1'; did you mean 'p/sbot_1'?"},
        Flaw{team("[0..3, 9]"), 6, "teams[0].robots[1]", "the robots of this world are 0..3"},
        Flaw{team("[0, 1, 3]"), 4, "teams", "robots that are not in any team: 'p/sbot_2'"},
        Flaw{team("all", "  - {name: b, controller: x, robots: 1..2}\n"), 7, "teams[1].robots",
             "'p/sbot_1', 'p/sbot_2' ('a')"},
        Flaw{team("0..1", "  - {name: a, controller: x, robots: 2..3}\n"), 7, "teams[1].name", "another team"},
        Flaw{top + "teams: 4\n", 3, "teams", "expected a list"}, Flaw{top, 1, "teams", "missing"},
        Flaw{"world: none.sdf\nduration: 1\nteams: []\n", 1, "world", "there is no"},
        Flaw{"world: world.sdf\nduration: 1e300\nteams: [{name: a, controller: x, robots: all}]\n", 2, "duration",
             "<= 9e9 s"},
        Flaw{"world: world.sdf\nduration: 5 s\nteams: [{name: a, controller: x, robots: all}]\n", 2, "duration",
             "not '5 s'"}));

TEST_F(Experiments, ReportProblemsOfTheWorldToo) {
  const fs::path world = write_world("<include><uri>model://sbit</uri></include>");
  const fs::path file = write_experiment("world: world.sdf\nduration: 0\nteams: [{name: a, robots: all}]\n");
  const auto problems = problems_of([&] { parsing::read_experiment(file); });
  expect_problem(problems, file, {"", 2, "duration", "a time > 0 s"});
  expect_problem(problems, file, {"", 3, "teams[0].controller", "missing"});
  expect_problem(problems, world, {"", 2, "world/include/uri", "there is no model 'sbit'"});
  EXPECT_EQ(problems.size(), 3u);
}

}  // namespace
}  // namespace cohort::description
