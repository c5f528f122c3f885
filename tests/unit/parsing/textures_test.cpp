// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/images.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests of reading images that visuals and meshes have as textures.
namespace cohort::description {
namespace {

using test::glb_of;
using test::jpeg_of;
using test::png_of;

const std::string box = "<geometry><box><size>1 1 1</size></box></geometry>";

std::string albedo_map(const std::string& uri) {
  return "<material><diffuse>1 0 0 1</diffuse><pbr><metal>\n<albedo_map>" + uri +
         "</albedo_map></metal></pbr></material>";
}
std::string visual(const std::string& content, const std::string& name = "v") {
  return "<visual name=\"" + name + "\">" + content + "</visual>";
}
std::string link_of(const std::string& visuals) { return static_model_sdf("<link name=\"l\">" + visuals + "</link>"); }
std::string geometry_of_mesh(const std::string& uri) {
  return "<geometry><mesh>\n<uri>" + uri + "</uri></mesh></geometry>";
}

const Visual& visual_of(const World& world, std::size_t index = 0) { return world.models[0].links[0].visuals[index]; }
const MeshTextures& textures_of(const World& world) {
  return std::get<Mesh>(visual_of(world).shape).triangles->textures;
}

class Textures : public Description {
 protected:
  Textures() {
    write("wood.png", png_of(4, 2));
    write("stone.jpg", jpeg_of(3, 5));
    write("text.png", "text");
  }
  // A triangle with texture coordinates, whose material has these lines.
  void write_obj(const std::string& material) const {
    write("sign.mtl", "newmtl sign\n" + material);
    write("sign.obj",
          "mtllib sign.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 0.5\nusemtl sign\nf 1/1 2/2 3/3\n");
  }
  void expect_one_warning(const World& world, const std::string& element, const std::string& message) const {
    ASSERT_EQ(world.warnings.size(), 1u) << texts_of(world.warnings);
    EXPECT_EQ(world.warnings[0].element, "world/model[m]/link[l]/visual[v]/" + element);
    EXPECT_NE(world.warnings[0].message.find("the texture is not shown: "), std::string::npos);
    EXPECT_NE(world.warnings[0].message.find(message), std::string::npos) << world.warnings[0].message;
  }
};

TEST_F(Textures, AreTheImagesOfAlbedoMaps) {
  const World world = read(link_of(visual(box + albedo_map("wood.png"), "a") +
                                   visual(box + albedo_map("stone.jpg"), "b") + visual(box, "c")));
  ASSERT_NE(visual_of(world, 0).texture, nullptr);
  EXPECT_EQ(visual_of(world, 0).texture->bytes, png_of(4, 2));
  EXPECT_EQ(visual_of(world, 0).texture->size.width, 4u);
  EXPECT_EQ(visual_of(world, 0).texture->size.height, 2u);
  EXPECT_EQ(visual_of(world, 0).color, Eigen::Vector4d(1, 0, 0, 1)) << "until it is decoded";
  ASSERT_NE(visual_of(world, 1).texture, nullptr);
  EXPECT_EQ(visual_of(world, 1).texture->size.width, 3u);
  EXPECT_EQ(visual_of(world, 1).texture->size.height, 5u);
  EXPECT_EQ(visual_of(world, 2).texture, nullptr);
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(Textures, AreFoundInModelsFromOtherSources) {
  write("robots/crate/materials/textures/wood.png", png_of(4, 2));
  write("robots/crate/model.config", "<model><name>crate</name><sdf version=\"1.6\">model.sdf</sdf></model>");
  write(
      "robots/crate/model.sdf",
      "<sdf version=\"1.6\"><model name=\"crate\"><static>1</static><link name=\"l\">" +
          visual(box + "<material><script><uri>x</uri><name>y</name></script><pbr><metal><roughness>2</roughness>"
                       "<albedo_map>model://crate/materials/textures/wood.png</albedo_map></metal></pbr></material>") +
          "</link></model></sdf>");
  const World world = read("<include><uri>model://crate</uri></include>");
  ASSERT_NE(visual_of(world).texture, nullptr) << texts_of(world.warnings);
  EXPECT_EQ(visual_of(world).texture->size.width, 4u);
}

TEST_F(Textures, AreOneObjectIfTheirContentIsEqual) {
  write("again.png", png_of(4, 2));
  const World world =
      read(link_of(visual(box + albedo_map("wood.png"), "a") + visual(box + albedo_map("again.png"), "b")));
  EXPECT_NE(visual_of(world, 0).texture, nullptr);
  EXPECT_EQ(visual_of(world, 0).texture, visual_of(world, 1).texture);
}

TEST_F(Textures, OfMaterialsOfObjFilesHaveTheirCoordinates) {
  write_obj("Kd 1 0 0\nmap_Kd wood.png\n");
  const World world = read(link_of(visual(geometry_of_mesh("sign.obj"))));
  const MeshTextures& textures = textures_of(world);
  ASSERT_EQ(textures.images.size(), 1u) << texts_of(world.warnings);
  ASSERT_NE(textures.images[0], nullptr);
  EXPECT_EQ(textures.images[0]->bytes, png_of(4, 2));
  EXPECT_EQ(textures.of_triangles, (std::vector<std::uint32_t>{0}));
  using Corners = std::array<std::array<float, 2>, 3>;
  EXPECT_EQ(textures.coordinates, (std::vector<Corners>{Corners{{{0, 0}, {1, 0}, {0, 0.5f}}}}));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(Textures, OfMeshesMayBeInTheFolderOfMaterialsBesideThem) {
  write("meshes/sign.mtl", "newmtl sign\nmap_Kd ..\\art\\wall.png\n");
  write("meshes/sign.obj", "mtllib sign.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl sign\nf 1/1 2/1 3/1\n");
  write("materials/textures/wall.png", png_of(6, 6));
  const World world = read(link_of(visual(geometry_of_mesh("meshes/sign.obj"))));
  ASSERT_EQ(textures_of(world).images.size(), 1u);
  ASSERT_NE(textures_of(world).images[0], nullptr) << texts_of(world.warnings);
  EXPECT_EQ(textures_of(world).images[0]->size.width, 6u);
}

TEST_F(Textures, OfMaterialsOfColladaFilesAreRead) {
  write("sign.dae",
        R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/></asset>
<library_images><image id="i"><init_from>wood.png</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON><newparam sid="s"><surface type="2D"><init_from>i</init_from></surface>
</newparam><newparam sid="p"><sampler2D><source>s</source></sampler2D></newparam><technique sid="t"><lambert><diffuse>
<texture texture="p" texcoord="UV"/></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="paint" name="paint"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="f" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#f" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<source id="u"><float_array id="h" count="6">0 0 1 0 0 1</float_array><technique_common>
<accessor source="#h" count="3" stride="2"><param name="S" type="float"/><param name="T" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
<input semantic="TEXCOORD" source="#u" offset="1" set="0"/><p>0 0 1 1 2 2</p></triangles></mesh></geometry>
</library_geometries><library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"><bind_material>
<technique_common><instance_material symbol="m" target="#paint"><bind_vertex_input semantic="UV"
input_semantic="TEXCOORD" input_set="0"/></instance_material></technique_common></bind_material></instance_geometry>
</node></visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  const World world = read(link_of(visual(geometry_of_mesh("sign.dae"))));
  ASSERT_EQ(textures_of(world).images.size(), 1u);
  ASSERT_NE(textures_of(world).images[0], nullptr) << texts_of(world.warnings);
  EXPECT_EQ(textures_of(world).images[0]->bytes, png_of(4, 2));
  ASSERT_EQ(textures_of(world).coordinates.size(), 1u);
  EXPECT_EQ(textures_of(world).coordinates[0][2], (std::array<float, 2>{0, 1}));
}

TEST_F(Textures, OfGltfFilesAreEmbeddedOrBesideThem) {
  const std::string embedded = png_of(7, 7);
  write("in.glb", glb_of(R"({"bufferView":3,"mimeType":"image/png"})", embedded));
  write("beside.glb", glb_of(R"({"uri":"wood.png"})"));
  for (const auto& [file, image] : {std::pair{"in.glb", embedded}, std::pair{"beside.glb", png_of(4, 2)}}) {
    const World world = read(link_of(visual(geometry_of_mesh(file))));
    const TriangleMesh& triangles = *std::get<Mesh>(visual_of(world).shape).triangles;
    ASSERT_EQ(triangles.triangles.size(), 1u) << file;
    ASSERT_EQ(triangles.textures.images.size(), 1u) << file;
    ASSERT_NE(triangles.textures.images[0], nullptr) << texts_of(world.warnings);
    EXPECT_EQ(triangles.textures.images[0]->bytes, image) << file;
    EXPECT_EQ(triangles.textures.coordinates[0][0], (std::array<float, 2>{0, 1})) << "v points upwards";
    EXPECT_EQ(triangles.colors[0], (std::array<std::uint8_t, 3>{188, 0, 255})) << "0.5 is linear";
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
  }
}

TEST_F(Textures, ThatAreBadAreAWarningAndThePlainColourIsShown) {
  write("huge.png", png_of(8193, 1));
  write("none.png", png_of(0, 1));
  write("cut.jpg", jpeg_of(3, 5).substr(0, 12));
  write("heavy.png", png_of(1, 1, std::string(most_image_bytes, ' ')));
  const std::vector<std::pair<std::string, std::string>> bad = {
      {"missing.png", "there is no such file"},
      {"text.png", "expected a PNG or JPEG image"},
      {"huge.png", "8193 by 1 pixels; expected at most 8192 along an edge"},
      {"none.png", "the image has no pixels"},
      {"cut.jpg", "the image is truncated"},
      {"heavy.png", "the image is larger than 8 MiB"}};
  for (const auto& [file, message] : bad) {
    const World world = read(link_of(visual(box + albedo_map(file))));
    expect_one_warning(world, "material/pbr/metal/albedo_map", message);
    EXPECT_EQ(world.warnings[0].line, 3);
    EXPECT_EQ(visual_of(world).texture, nullptr);
    EXPECT_EQ(visual_of(world).color, Eigen::Vector4d(1, 0, 0, 1));
  }
  for (const auto& [file, message] : bad) {
    write_obj("Kd 1 0 0\nmap_Kd " + file + "\n");
    const World world = read(link_of(visual(geometry_of_mesh("sign.obj")) + visual(geometry_of_mesh("sign.obj"), "w")));
    expect_one_warning(world, "geometry/mesh/uri", message);
    EXPECT_EQ(textures_of(world).images[0], nullptr);
    EXPECT_EQ(std::get<Mesh>(visual_of(world).shape).triangles->colors[0], (std::array<std::uint8_t, 3>{255, 0, 0}));
  }
}

TEST_F(Textures, ThatAreEmbeddedAndBadAreAWarning) {
  for (const auto& [bytes, message] : {std::pair<std::string, std::string>{"text", "expected a PNG or JPEG image"},
                                       {png_of(1, 1, std::string(most_image_bytes, ' ')), "of at most 8 MiB"}}) {
    write("in.glb", glb_of(R"({"bufferView":3,"mimeType":"image/png"})", bytes));
    const World world = read(link_of(visual(geometry_of_mesh("in.glb"))));
    expect_one_warning(world, "geometry/mesh/uri", message);
    EXPECT_EQ(textures_of(world).images[0], nullptr);
  }
}

TEST_F(Textures, AreOnlyReadFromTrustedFolders) {
  const test::ScratchFolder elsewhere;
  test::write_file(elsewhere / "wood.png", png_of(4, 2));
  const std::string uri = (elsewhere / "wood.png").string();
  expect_one_warning(read(link_of(visual(box + albedo_map(uri)))), "material/pbr/metal/albedo_map",
                     "outside of all allowed folders");
  write_obj("map_Kd " + uri + "\n");
  expect_one_warning(read(link_of(visual(geometry_of_mesh("sign.obj")))), "geometry/mesh/uri",
                     "outside of all allowed folders");
}

TEST_F(Textures, OfAWorldAreLimited) {
  std::string visuals;
  for (std::size_t i = 0; i <= ImageBudget::most_images; ++i) {
    const std::string name = std::to_string(i);
    write(name + ".png", png_of(1, 1, name));
    visuals += visual(box + albedo_map(name + ".png"), name);
  }
  const World many = read(link_of(visuals));
  ASSERT_EQ(many.warnings.size(), 1u) << texts_of(many.warnings);
  EXPECT_NE(many.warnings[0].message.find("a world has at most 64 images"), std::string::npos);
  EXPECT_NE(visual_of(many, ImageBudget::most_images - 1).texture, nullptr);
  EXPECT_EQ(visual_of(many, ImageBudget::most_images).texture, nullptr);

  write("0.png", png_of(8192, 8192));
  const World large = read(link_of(visual(box + albedo_map("0.png"), "a") + visual(box + albedo_map("1.png"), "b")));
  ASSERT_EQ(large.warnings.size(), 1u);
  EXPECT_NE(large.warnings[0].message.find("at most 67108864 pixels"), std::string::npos) << large.warnings[0].message;

  ImageBudget budget;
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(budget.add(most_image_bytes, {1, 1}));
  EXPECT_EQ(budget.add(1, {1, 1}), "the images of a world have at most 32 MiB");
}

TEST_F(Textures, AreKeptWithTheOtherFilesOfAnExperiment) {
  write_obj("map_Kd stone.jpg\n");
  write_world(link_of(visual(geometry_of_mesh("sign.obj")) + visual(box + albedo_map("wood.png"), "b")));
  const auto file = write("experiment.yaml", "world: world.sdf\nduration: 1\nteams: []\n");
  const Experiment experiment = parsing::read_experiment(file);
  const auto kept = std::make_shared<const KeptFiles>(*experiment.inputs);
  for (const char* const name : {"wood.png", "stone.jpg", "sign.obj"}) std::filesystem::remove(folder_ / name);
  const Experiment again = parsing::read_experiment(kept, std::nullopt, std::nullopt);
  EXPECT_EQ(textures_of(again.world).images.at(0)->bytes, jpeg_of(3, 5));
  EXPECT_EQ(visual_of(again.world, 1).texture->bytes, png_of(4, 2));
  EXPECT_TRUE(again.world.warnings.empty()) << texts_of(again.world.warnings);
}

}  // namespace
}  // namespace cohort::description
