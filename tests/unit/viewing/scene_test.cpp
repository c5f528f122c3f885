// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "idl/messages/ros_schema.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/viewing/scene_maker.hpp"
#include "tests/support/files.hpp"
#include "tests/support/worlds/shipped_experiment.hpp"

namespace cohort::viewing {
namespace {

description::Experiment shipped(const std::string& name) {
  return parsing::read_experiment(test::shipped_experiments / (name + ".yaml"));
}

TEST(SceneOfAWorld, HasEveryObjectWithItsVisuals) {
  const description::Experiment experiment = shipped("obstacle_avoidance");
  const Simulation simulation(experiment, 1);
  const messages::Scene scene = SceneMaker(simulation, 7).scene();
  EXPECT_EQ(scene.revision, 7U);
  ASSERT_EQ(scene.entities.size(), simulation.objects().size());
  std::set<std::uint32_t> robots;
  for (const messages::SceneEntity& entity : scene.entities) {
    if (entity.robot == messages::none) continue;
    robots.insert(entity.robot);
    EXPECT_EQ(entity.name, simulation.robot_name(entity.robot));
    EXPECT_EQ(entity.team, "explorers");
  }
  EXPECT_EQ(robots.size(), 16U);
  const messages::SceneModel& sbot = scene.models[scene.entities[simulation.description().robots[0]].model];
  ASSERT_EQ(sbot.links.size(), 2U);
  // Hull and two tracks; the collision of the hull beside.
  const auto count = [](const messages::SceneLink& link, messages::ShapeRole role) {
    return std::ranges::count(link.shapes, static_cast<std::uint8_t>(role), &messages::SceneShape::role);
  };
  EXPECT_EQ(count(sbot.links[0], messages::ShapeRole::visual), 3);
  EXPECT_GE(count(sbot.links[0], messages::ShapeRole::collision), 1);
  EXPECT_EQ(count(sbot.links[0], messages::ShapeRole::collision_as_visual), 0);
  EXPECT_FLOAT_EQ(sbot.links[1].shapes[0].color[0], 0.85f);
  EXPECT_FALSE(sbot.observation.empty());
  EXPECT_FALSE(sbot.command.empty());
}

TEST(SceneOfAWorld, TellsWhereRaysBegin) {
  const description::Experiment experiment = shipped("obstacle_avoidance");
  const Simulation simulation(experiment, 1);
  const messages::Scene scene = SceneMaker(simulation, 1).scene();
  const messages::SceneModel& sbot = scene.models[scene.entities[simulation.description().robots[0]].model];
  const auto ring = std::ranges::find(sbot.sensors, "proximity_ring", &messages::SceneSensor::kind);
  ASSERT_NE(ring, sbot.sensors.end());
  EXPECT_EQ(ring->directions.size(), 45U);
  EXPECT_GT(ring->range, 0.0f);
  const auto channel = std::ranges::find(sbot.observation, ring->channel, &messages::SceneChannel::name);
  EXPECT_NE(channel, sbot.observation.end()) << ring->channel;
}

TEST(SceneOfAWorld, TellsWhichValuesDriveARobot) {
  const description::Experiment experiment = shipped("turtlebot3");
  const Simulation simulation(experiment, 1);
  const messages::Scene scene = SceneMaker(simulation, 1).scene();
  ASSERT_EQ(scene.drives.size(), 2U);
  const messages::SceneModel& model = scene.models[scene.drives[0].model];
  EXPECT_EQ(model.command[scene.drives[0].value].name, "drive/0/linear");
  EXPECT_EQ(scene.drives[0].ahead, 0.22);
  EXPECT_EQ(model.command[scene.drives[1].value].name, "drive/0/angular");
  EXPECT_EQ(scene.drives[1].turn, 2.84);
}

TEST(SceneOfAWorld, TellsWhereLinksRestAndWhatCommandsBeginWith) {
  const description::Experiment experiment = shipped("obstacle_avoidance");
  const Simulation simulation(experiment, 1);
  const messages::Scene scene = SceneMaker(simulation, 1).scene();
  const std::size_t model = scene.entities[simulation.description().robots[0]].model;
  const description::Model& described = simulation.description().models[model];
  for (std::size_t link = 0; link < described.links.size(); ++link)
    EXPECT_FLOAT_EQ(scene.models[model].links[link].pose[2],
                    static_cast<float>(described.links[link].X_ML.position.z()));
  const auto& channels = simulation.kinds()[simulation.kind_of(0)].command;
  ASSERT_EQ(scene.models[model].command.size(), channels.size());
  for (std::size_t i = 0; i < channels.size(); ++i)
    EXPECT_EQ(scene.models[model].command[i].neutral, channels[i].neutral) << channels[i].name;
}

TEST(SceneOfAWorld, AHeightMapIsAMeshAsHighAsItsGround) {
  const description::Experiment experiment = shipped("rough_terrain");
  const Simulation simulation(experiment, 1);
  const messages::Scene scene = SceneMaker(simulation, 1).scene();
  ASSERT_FALSE(scene.meshes.empty());
  const messages::SceneMesh& ground = scene.meshes[0];
  const geometry::Scene& solids = simulation.world().scene();
  // Straight down onto some of its vertices.
  const Eigen::Vector3d down = -Eigen::Vector3d::UnitZ();
  int compared = 0;
  for (std::size_t i = 0; i + 2 < ground.vertices.size() && compared < 50; i += 3 * 97) {
    const Eigen::Vector3d vertex(ground.vertices[i], ground.vertices[i + 1], ground.vertices[i + 2]);
    const auto hit = solids.cast_ray({vertex.x(), vertex.y(), 10.0}, down, 20.0);
    if (!hit || !geometry::is_ground(solids.solid(hit->solid).shape())) continue;
    EXPECT_NEAR(10.0 - hit->distance, vertex.z() + solids.solid(hit->solid).X_WC.position.z(), 2e-3);
    ++compared;
  }
  EXPECT_GT(compared, 10);
}

TEST(SceneOfAWorld, AMeshHasTheColoursOfItsFileUnlessItsVisualHasOne) {
  const std::filesystem::path exhibits = COHORT_SOURCE_DIR "/tests/view/exhibits";
  setenv("COHORT_MODEL_PATH", COHORT_SOURCE_DIR "/worlds/robots", 1);
  const Simulation simulation(parsing::read_experiment(exhibits / "experiment.yaml"), 1);
  unsetenv("COHORT_MODEL_PATH");
  const messages::Scene scene = SceneMaker(simulation, 1).scene();
  const auto badge = std::ranges::find(scene.models, "badge", &messages::SceneModel::name);
  ASSERT_NE(badge, scene.models.end());
  ASSERT_EQ(badge->links[0].shapes.size(), 2U);
  const auto& [own, green] = std::tie(badge->links[0].shapes[0], badge->links[0].shapes[1]);
  EXPECT_TRUE(own.has_mesh_colors);
  EXPECT_FALSE(green.has_mesh_colors);
  EXPECT_EQ(own.mesh, green.mesh) << "the mesh is there once";
  const std::vector<std::uint8_t> red{204, 13, 13};
  const std::vector<std::uint8_t> blue{13, 26, 204};
  std::vector<std::uint8_t> expected;
  for (const auto* color : {&red, &red, &blue, &blue}) expected.insert(expected.end(), color->begin(), color->end());
  EXPECT_EQ(scene.meshes[own.mesh].colors, expected);
}

TEST(SceneOfAWorld, FramesHaveThePosesAndChangeNothing) {
  const description::Experiment experiment = shipped("obstacle_avoidance");
  Simulation simulation(experiment, 1);
  Simulation unseen(experiment, 1);
  const SceneMaker maker(simulation, 1);
  for (int tick = 0; tick < 20; ++tick) {
    simulation.step();
    unseen.step();
    const messages::SceneFrame frame = maker.frame(3, 4);
    maker.signals();
    maker.contacts();
    EXPECT_EQ(frame.tick, simulation.tick());
    EXPECT_EQ(simulation.state_hash(), unseen.state_hash());
  }
  const messages::SceneFrame frame = maker.frame(3, 4);
  const messages::Scene scene = maker.scene();
  std::size_t place = 0;
  for (std::uint32_t model = 0; model < scene.models.size(); ++model)
    for (std::size_t link = 0; link < scene.models[model].links.size(); ++link)
      for (std::uint32_t body = 0; body < scene.entities.size(); ++body) {
        if (scene.entities[body].model != model) continue;
        const Pose X_WL = simulation.world().link_pose(BodyId{body}, LinkId{link});
        for (int axis = 0; axis < 3; ++axis)
          EXPECT_NEAR(frame.positions[3 * place + static_cast<std::size_t>(axis)], X_WL.position[axis], 1e-6);
        const std::int16_t* const q = frame.orientations.data() + 4 * place;
        EXPECT_NEAR(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().angularDistance(X_WL.orientation), 0.0,
                    2e-4);
        ++place;
      }
  EXPECT_EQ(frame.positions.size(), 3 * place);
}

TEST(SceneOfAWorld, WhatComesLaterNeedsAnotherMaker) {
  const description::Experiment experiment = shipped("obstacle_avoidance");
  Simulation simulation(experiment, 1);
  const SceneMaker maker(simulation, 1);
  EXPECT_FALSE(maker.is_outdated());
  const std::size_t pillar = simulation.world().model_of(BodyId{*simulation.objects().find("pillar_0")});
  const std::string& model = simulation.description().models[pillar].name;
  Pose X_WM;
  X_WM.position = {0.0, 0.0, 3.0};
  simulation.act(SpawnObject{"another", model, X_WM});
  EXPECT_TRUE(maker.is_outdated());
  const messages::Scene scene = SceneMaker(simulation, 2).scene();
  EXPECT_EQ(scene.entities.back().name, "another");
}

// The definition of a message as docs/scenes.md has it, without its comments; empty if the page lacks it.
std::string definition_on_the_page(const std::string& name) {
  std::istringstream page(test::read_file(COHORT_SOURCE_DIR "/docs/scenes.md"));
  std::string line;
  while (std::getline(page, line) && line != "# " + name) {
  }
  std::string text;
  while (std::getline(page, line) && !line.empty() && line != "```") {
    line.resize(std::min(line.size(), line.find('#')));
    line.resize(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

void expect_on_the_page(const messages::RosDefinition& definition) {
  EXPECT_EQ(definition_on_the_page(definition.name), definition.text) << definition.name;
  for (const messages::RosDefinition& part : definition.parts) expect_on_the_page(part);
}

TEST(SceneMessages, AreDefinedOnTheirPageFieldByField) {
  expect_on_the_page(messages::definition<messages::Scene>());
  expect_on_the_page(messages::definition<messages::SceneFrame>());
  expect_on_the_page(messages::definition<messages::SceneSignals>());
  expect_on_the_page(messages::definition<messages::SceneContacts>());
  expect_on_the_page(messages::definition<messages::SceneRobots>());
}

}  // namespace
}  // namespace cohort::viewing
