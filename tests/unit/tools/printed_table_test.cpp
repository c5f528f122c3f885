// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/terminal/printed_table.hpp"

#include <gtest/gtest.h>

#include "tests/support/files.hpp"
#include "tests/support/worlds/small_world.hpp"

namespace cohort::tool {
namespace {

using namespace std::chrono_literals;
using namespace test;

TEST(PrintedTable, HasWhatABreakableJointExertsAtBothEnds) {
  description::Experiment experiment;
  description::World& world = experiment.world;
  world = world_with_floor();
  world.gravity = {0, 0, -10.0};
  const std::uint32_t beam = place(world, static_shape("beam", description::Box{{1.0, 0.1, 0.1}}), "beam", at(0, 0, 1));
  const Eigen::Vector3d size = Eigen::Vector3d::Constant(0.2);
  const std::uint32_t box =
      place(world, loose("box", description::Box{size}, solid_box(2.0, size)), "box", at(0, 0, 0.5));
  description::BreakableJoint joint{"hook", box, 0, beam, 0};
  joint.X_LP = Pose{};
  world.breakable_joints.push_back(joint);
  experiment.prints.push_back({description::Quantity::joint_force, "", {}, {0}, 20ms});
  experiment.prints.push_back({description::Quantity::joint_torque, "", {}, {0}, 50ms});

  Simulation simulation(experiment, 1);
  PrintedTable table(experiment, simulation, false);
  for (int i = 0; i < 4; ++i) {
    simulation.step();
    table.boundary();
  }
  const std::vector<std::string> lines = lines_of(table.text());
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[0],
            "time,hook/first_fx,hook/first_fy,hook/first_fz,hook/second_fx,hook/second_fy,hook/second_fz,"
            "hook/first_tx,hook/first_ty,hook/first_tz,hook/second_tx,hook/second_ty,hook/second_tz");
  std::vector<std::string> cells;
  std::istringstream stream(lines[2]);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  EXPECT_NEAR(std::stod(cells.at(3)), 20.0, 1e-3);
  EXPECT_NEAR(std::stod(cells.at(6)), -20.0, 1e-3);
  EXPECT_TRUE(lines[2].ends_with(",,,,,,")) << "torques are due every fifth tick";
}

}  // namespace
}  // namespace cohort::tool
