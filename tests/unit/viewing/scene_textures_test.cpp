// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/viewing/check_scene.hpp"
#include "server/viewing/scene_maker.hpp"
#include "tests/support/files.hpp"
#include "tests/support/images.hpp"

namespace cohort::viewing {
namespace {

// The Scene of Cohort 0.1.
struct OldScene {
  std::uint32_t revision = 0;
  std::string world;
  std::int64_t step_ns = 0;
  std::vector<messages::SceneMesh> meshes;
  std::vector<messages::SceneModel> models;
  std::vector<messages::SceneEntity> entities;
  std::vector<messages::SceneEmitter> lamps, tones, leds;
  std::string end;
  std::string end_text;
  static constexpr const char* type = "cohort_msgs/msg/Scene";
  static constexpr auto fields =
      std::tuple(messages::field("revision", &OldScene::revision), messages::field("world", &OldScene::world),
                 messages::field("step_ns", &OldScene::step_ns), messages::field("meshes", &OldScene::meshes),
                 messages::field("models", &OldScene::models), messages::field("entities", &OldScene::entities),
                 messages::field("lamps", &OldScene::lamps), messages::field("tones", &OldScene::tones),
                 messages::field("leds", &OldScene::leds), messages::field("end", &OldScene::end),
                 messages::field("end_text", &OldScene::end_text));
};

class TexturesOfAScene : public ::testing::Test {
 protected:
  TexturesOfAScene() {
    test::write_file(scratch / "wood.png", wood);
    test::write_file(scratch / "same.png", wood);
    test::write_file(scratch / "sign.jpg", sign);
    test::write_file(scratch / "sign.mtl", "newmtl sign\nmap_Kd sign.jpg\nnewmtl plain\nKd 1 0 0\n");
    test::write_file(scratch / "sign.obj",
                     "mtllib sign.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\n"
                     "usemtl sign\nf 1/1 2/2 3/3\nusemtl plain\nf 1/1 2/2 4/3\n");
    test::write_file(scratch / "world.yaml", R"(world:
  name: w
  model:
    name: m
    static: true
    link:
      name: l
      visual:
        - {name: a, geometry: {box: {size: [1, 1, 1]}}, material: {pbr: {metal: {albedo_map: wood.png}}}}
        - {name: b, geometry: {box: {size: [1, 1, 1]}}, material: {pbr: {metal: {albedo_map: same.png}}}}
        - {name: c, geometry: {mesh: {uri: sign.obj}}}
        - {name: d, geometry: {mesh: {uri: sign.obj}}, material: {diffuse: [1, 1, 1, 1]}}
        - {name: e, geometry: {box: {size: [1, 1, 1]}}}
)");
    test::write_file(scratch / "experiment.yaml", "world: world.yaml\nduration: 1\nteams: []\n");
  }
  messages::Scene scene() const {
    const description::Experiment experiment = parsing::read_experiment(scratch / "experiment.yaml");
    const Simulation simulation(experiment, 1);
    return SceneMaker(simulation, 7).scene();
  }
  static std::vector<std::uint8_t> bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

  const std::string wood = test::png_of(4, 2);
  const std::string sign = test::jpeg_of(3, 5);
  test::ScratchFolder scratch;
};

TEST_F(TexturesOfAScene, AreThereOnceWithTheirShapesAndMeshes) {
  const messages::Scene scene = this->scene();
  ASSERT_EQ(scene.textures.size(), 2U);
  EXPECT_EQ(scene.textures[0].image, bytes_of(wood));
  EXPECT_EQ(scene.textures[1].image, bytes_of(sign));
  ASSERT_EQ(scene.shape_textures.size(), 2U);
  EXPECT_EQ(scene.shape_textures[1].shape, 1U);
  EXPECT_EQ(scene.shape_textures[1].texture, 0U);
  ASSERT_EQ(scene.mesh_textures.size(), 1U);
  EXPECT_EQ(scene.mesh_textures[0].textures, (std::vector<std::uint32_t>{1, messages::none}));
  EXPECT_EQ(scene.mesh_textures[0].coordinates, (std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}));
  const auto& shapes = scene.models.at(0).links.at(0).shapes;
  EXPECT_TRUE(shapes[2].has_mesh_colors);
  EXPECT_FALSE(shapes[3].has_mesh_colors) << "its own colour applies";
}

TEST_F(TexturesOfAScene, StayWhenItIsSent) {
  const messages::Scene before = scene();
  const auto after = messages::decode<messages::Scene>(messages::encode(before));
  EXPECT_EQ(check_scene(after), 1U);
  ASSERT_EQ(after.textures.size(), 2U);
  EXPECT_EQ(after.textures[1].image, bytes_of(sign));
  EXPECT_EQ(after.mesh_textures.at(0).coordinates, before.mesh_textures.at(0).coordinates);
  EXPECT_EQ(after.shape_textures.at(1).shape, 1U);
}

TEST_F(TexturesOfAScene, AreUnknownToTheScenesOfVersion01) {
  messages::Scene now = scene();
  const OldScene old{now.revision, now.world, now.step_ns, now.meshes, now.models,  now.entities,
                     now.lamps,    now.tones, now.leds,    "finished", "it is over"};
  const auto read = messages::decode<messages::Scene>(messages::encode(old));
  EXPECT_EQ(read.entities.size(), now.entities.size());
  EXPECT_EQ(read.end_text, "it is over");
  EXPECT_TRUE(read.textures.empty());
  EXPECT_TRUE(read.mesh_textures.empty());
  EXPECT_TRUE(read.shape_textures.empty());
  EXPECT_EQ(check_scene(read), 1U);
  now.end_text = "it is over";
  EXPECT_EQ(messages::decode<OldScene>(messages::encode(now)).end_text, "it is over") << "0.1 reads newer scenes";
}

}  // namespace
}  // namespace cohort::viewing
