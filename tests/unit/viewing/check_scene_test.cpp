// SPDX-License-Identifier: Apache-2.0
#include "server/viewing/check_scene.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/support/images.hpp"

namespace cohort::viewing {
namespace {

// Two objects of a model with two links, of which one is a mesh.
messages::Scene scene_of_two() {
  messages::Scene scene;
  scene.meshes = {{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}}};
  messages::SceneShape shape;
  shape.kind = static_cast<std::uint8_t>(messages::ShapeKind::mesh);
  shape.mesh = 0;
  messages::SceneModel model;
  model.links = {{"body", {}, {shape}}, {"arm", {}, {}}};
  scene.models = {model};
  scene.entities = {{"one", 0}, {"two", 0}};
  return scene;
}

TEST(CheckScene, CountsTheLinksOfAFrame) {
  EXPECT_EQ(check_scene(scene_of_two()), 4U);
  messages::SceneFrame frame;
  frame.positions.resize(12);
  frame.orientations.resize(16);
  check_frame(frame, 4);
  EXPECT_THROW(check_frame(frame, 5), messages::CdrError);
  frame.orientations.pop_back();
  EXPECT_THROW(check_frame(frame, 4), messages::CdrError);
}

TEST(CheckScene, RefusesIndicesOfNothing) {
  messages::Scene of_model = scene_of_two();
  of_model.entities[1].model = 1;
  EXPECT_THROW(check_scene(of_model), messages::CdrError);
  messages::Scene of_mesh = scene_of_two();
  of_mesh.models[0].links[0].shapes[0].mesh = messages::none;
  EXPECT_THROW(check_scene(of_mesh), messages::CdrError);
  messages::Scene of_vertex = scene_of_two();
  of_vertex.meshes[0].triangles[2] = 3;
  EXPECT_THROW(check_scene(of_vertex), messages::CdrError);
}

TEST(CheckScene, RefusesDrivesOfNothing) {
  messages::Scene scene = scene_of_two();
  scene.models[0].command.emplace_back().size = 2;
  scene.drives = {{0, 1, 0.5, -0.5}};
  EXPECT_EQ(check_scene(scene), 4U);
  scene.drives[0].value = 2;
  EXPECT_THROW(check_scene(scene), messages::CdrError);
  scene.drives = {{1, 0, 0.5, -0.5}};
  EXPECT_THROW(check_scene(scene), messages::CdrError);
  scene.drives = {{0, 0, std::numeric_limits<double>::quiet_NaN(), 0.0}};
  EXPECT_THROW(check_scene(scene), messages::CdrError);
}

TEST(CheckScene, RefusesColoursOfNothing) {
  messages::Scene scene = scene_of_two();
  scene.models[0].links[0].shapes[0].has_mesh_colors = true;
  EXPECT_THROW(check_scene(scene), messages::CdrError);
  scene.meshes[0].colors = {10, 20, 30};
  EXPECT_EQ(check_scene(scene), 4U);
  scene.meshes[0].colors.push_back(40);
  EXPECT_THROW(check_scene(scene), messages::CdrError);
}

TEST(CheckScene, RefusesTexturesOfNothing) {
  const std::string image = test::png_of(2, 2);
  messages::Scene textured = scene_of_two();
  textured.textures = {{{image.begin(), image.end()}}};
  textured.mesh_textures = {{0, {0, 0, 1, 0, 0, 1}, {0}}};
  textured.shape_textures = {{0, 0, 0, 0}};
  EXPECT_EQ(check_scene(textured), 4U);
  const auto refuses = [&](auto&& change) {
    messages::Scene scene = textured;
    change(scene);
    EXPECT_THROW(check_scene(scene), messages::CdrError);
  };
  refuses([](messages::Scene& scene) { scene.textures[0].image = {1, 2, 3}; });
  refuses([](messages::Scene& scene) { scene.textures.resize(65, scene.textures[0]); });
  refuses([](messages::Scene& scene) { scene.textures.clear(); });
  refuses([](messages::Scene& scene) { scene.mesh_textures[0].mesh = 1; });
  refuses([](messages::Scene& scene) { scene.mesh_textures[0].coordinates.pop_back(); });
  refuses([](messages::Scene& scene) { scene.mesh_textures[0].textures[0] = 1; });
  refuses([](messages::Scene& scene) { scene.mesh_textures[0].textures.push_back(0); });
  refuses([](messages::Scene& scene) { scene.shape_textures[0].model = 1; });
  refuses([](messages::Scene& scene) { scene.shape_textures[0].link = 2; });
  refuses([](messages::Scene& scene) { scene.shape_textures[0].shape = 1; });
  refuses([](messages::Scene& scene) { scene.shape_textures[0].texture = 1; });
}

}  // namespace
}  // namespace cohort::viewing
