// SPDX-License-Identifier: Apache-2.0
#include <png.h>

#include <cmath>
#include <numbers>
#include <set>

#include "server/core/random.hpp"
#include "server/geometry/shapes/convex_hull.hpp"
#include "server/geometry/shapes/footprint.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests of reading shapes and their files.
namespace cohort::description {
namespace {

using Eigen::Vector3d;

const std::string in_geometry = "world/model[m]/link[l]/collision[c]/geometry";

// A box from 0 to 1, 2 and 3, its faces as quads, counter-clockwise seen from outside.
const std::string box_obj =
    "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 3\nv 1 0 3\nv 1 2 3\nv 0 2 3\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";

std::string stl(const std::string& corner) {
  const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
    return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c + "\nendloop\nendfacet\n";
  };
  const std::string o = "0 0 0", x = "1 0 0", y = "0 1 0";
  return "solid s\n" + facet(o, y, x) + facet(o, x, corner) + facet(x, y, corner) + facet(y, o, corner) +
         "endsolid s\n";
}

// A triangle in a unit of centimetres, moved by its node, in a file whose z axis points upwards.
const std::string dae = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><created>2020-01-01T00:00:00</created><modified>2020-01-01T00:00:00</modified>
<unit name="centimeter" meter="0.01"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 100 0 0 0 200 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><translate>0 0 300</translate>
<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

// Materials that make its triangle orange.
const std::string dae_materials = R"(<library_effects><effect id="e"><profile_COMMON><technique sid="t"><lambert>
<diffuse><color>1 0.2 0 1</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="paint" name="paint"><instance_effect url="#e"/></material></library_materials>
)";
const std::string dae_instance =
    "<instance_geometry url=\"#g\"><bind_material><technique_common><instance_material symbol=\"m\" target=\"#paint\"/>"
    "</technique_common></bind_material></instance_geometry>";

std::string mesh(const std::string& uri, const std::string& rest = "") {
  return "<mesh>\n<uri>" + uri + "</uri>" + rest + "</mesh>";
}
std::string height_image(const std::string& uri, const std::string& rest = "<size>4 2 1</size>") {
  return "<heightmap>\n<uri>" + uri + "</uri>" + rest + "</heightmap>";
}
std::string moving(const std::string& geometry) {
  return "<model name=\"m\"><link name=\"l\"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz>"
         "<ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial><collision name=\"c\"><geometry>" +
         geometry + "</geometry></collision></link></model>";
}

const Collision& collision_of(const World& world, std::size_t model = 0) {
  return world.models[model].links[0].collisions[0];
}
const TriangleMesh& mesh_of(const World& world, std::size_t model = 0) {
  return *std::get<Mesh>(collision_of(world, model).shape).triangles;
}

double volume_of(const TriangleMesh& mesh) {
  double sixfold = 0.0;
  for (const auto& [a, b, c] : mesh.triangles)
    sixfold += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c]));
  return sixfold / 6.0;
}

class Shapes : public Description {
 protected:
  Shapes() {
    write("box.obj", box_obj);
    write("corner.stl", stl("0 0 1"));
    write("flat.obj", "v 0 0 0\nv 1 0 0\nv 1 2 0\nf 1 2 3\n");
    write("nan.stl", stl("0 nan 1"));
    write("no_triangle.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n");
    write("broken.dae", "<COLLADA>");
    write("box.step", "x");
    write("not.png", "x");
    write_png<png_byte>("ridge.png", PNG_FORMAT_GRAY, 3, 2, {0, 255, 51, 102, 0, 0});
    write_png<png_byte>("dot.png", PNG_FORMAT_GRAY, 1, 1, {0});
    write_png<png_byte>("colours.png", PNG_FORMAT_RGB, 2, 2, std::vector<png_byte>(12));
    write_png<png_byte>("glass.png", PNG_FORMAT_GA, 2, 2, std::vector<png_byte>(8));
  }

  template <class Value>
  void write_png(const std::string& name, unsigned format, unsigned width, unsigned height,
                 const std::vector<Value>& values) const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = width;
    image.height = height;
    image.format = format;
    EXPECT_TRUE(png_image_write_to_file(&image, (folder_ / name).c_str(), 0, values.data(), 0, nullptr))
        << image.message;
  }
};

TEST_F(Shapes, ReadCapsulesAndEllipsoids) {
  const World world =
      read(static_model_sdf(collision("<capsule><radius>0.1</radius><length>0.4</length></capsule>"), "a") +
           static_model_sdf(collision("<ellipsoid><radii>1 2 3</radii></ellipsoid>"), "b"));
  EXPECT_EQ(std::get<Capsule>(collision_of(world, 0).shape).radius, 0.1);
  EXPECT_EQ(std::get<Capsule>(collision_of(world, 0).shape).length, 0.4);
  EXPECT_EQ(std::get<Ellipsoid>(collision_of(world, 1).shape).radii, Vector3d(1, 2, 3));
}

TEST_F(Shapes, UseTheTrianglesOfStaticMeshesAndTheHullOfMovingOnes) {
  const World world = read(static_model_sdf(collision(mesh("box.obj")), "a") + moving(mesh("box.obj")));
  EXPECT_FALSE(std::get<Mesh>(collision_of(world, 0).shape).convex);
  EXPECT_EQ(mesh_of(world, 0).vertices.size(), 8u);
  EXPECT_EQ(mesh_of(world, 0).triangles.size(), 12u);
  EXPECT_NEAR(volume_of(mesh_of(world, 0)), 6.0, 1e-12);
  EXPECT_TRUE(std::get<Mesh>(collision_of(world, 1).shape).convex);
  EXPECT_EQ(mesh_of(world, 1).vertices.size(), 8u);
  EXPECT_NEAR(volume_of(mesh_of(world, 1)), 6.0, 1e-12);
}

TEST_F(Shapes, MergeRepeatedVertices) {
  const World world = read(static_model_sdf(collision(mesh("corner.stl"))));
  EXPECT_EQ(mesh_of(world).vertices.size(), 4u);
  EXPECT_NEAR(volume_of(mesh_of(world)), 1.0 / 6.0, 1e-12);
}

TEST_F(Shapes, KeepTheOrientationOfMirroredMeshes) {
  const World world = read(static_model_sdf(collision(mesh("box.obj", "<scale>2 1 -0.5</scale>"))));
  EXPECT_NEAR(volume_of(mesh_of(world)), 6.0, 1e-12);
  double lowest = 0.0;
  for (const Vector3d& vertex : mesh_of(world).vertices) lowest = std::min(lowest, vertex.z());
  EXPECT_EQ(lowest, -1.5);
}

TEST_F(Shapes, ReadUnitAndNodesOfColladaMeshesButNotTheUpAxis) {
  write("triangle.dae", dae);
  const World world = read(static_model_sdf(collision(mesh("triangle.dae"))));
  ASSERT_EQ(mesh_of(world).triangles.size(), 1u);
  const Vector3d& last = mesh_of(world).vertices[mesh_of(world).triangles[0][2]];
  EXPECT_TRUE(last.isApprox(Vector3d(0, 2, 3), 1e-6)) << last.transpose();
}

TEST_F(Shapes, ReadTheColoursOfMaterials) {
  write("triangle.dae", dae);
  const std::string plain_instance = "<instance_geometry url=\"#g\"/>";
  std::string painted = dae;
  painted.replace(painted.find("<library_geometries>"), 0, dae_materials);
  painted.replace(painted.find("<triangles count"), std::string("<triangles").size(), "<triangles material=\"m\"");
  painted.replace(painted.find(plain_instance), plain_instance.size(), dae_instance);
  write("painted.dae", painted);
  write("paint.mtl", "newmtl green\nKd 0 1 0.2\nnewmtl red\nKd 0.6 0 0\n");
  write("painted.obj",
        "mtllib paint.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl red\nf 1 2 3\nusemtl green\nf 1 2 4\n");
  const auto colors = [&](const std::string& file) {
    return mesh_of(read(static_model_sdf(collision(mesh(file))))).colors;
  };
  for (const char* file : {"box.obj", "corner.stl", "triangle.dae"}) EXPECT_TRUE(colors(file).empty()) << file;
  using Colors = std::vector<std::array<std::uint8_t, 3>>;
  EXPECT_EQ(colors("painted.dae"), (Colors{{255, 51, 0}}));
  EXPECT_EQ(colors("painted.obj"), (Colors{{153, 0, 0}, {0, 255, 51}}));
}

TEST_F(Shapes, ReadAColladaMeshWhoseTextureHasNoImageWithoutItsColours) {
  std::string textured = dae_materials;
  textured.replace(textured.find("<technique "), 0,
                   "<newparam sid=\"u\"><surface type=\"2D\"><init_from>i</init_from></surface></newparam><newparam "
                   "sid=\"w\"><sampler2D><source>u</source></sampler2D></newparam>");
  const std::string color = "<color>1 0.2 0 1</color>";
  textured.replace(textured.find(color), color.size(), "<texture texture=\"w\" texcoord=\"c\"/>");
  const std::string plain_instance = "<instance_geometry url=\"#g\"/>";
  std::string file = dae;
  file.replace(file.find("<library_geometries>"), 0, "<library_images><image id=\"i\"/></library_images>" + textured);
  file.replace(file.find("<triangles count"), std::string("<triangles").size(), "<triangles material=\"m\"");
  file.replace(file.find(plain_instance), plain_instance.size(), dae_instance);
  write("without_image.dae", file);
  const World world = read(static_model_sdf(collision(mesh("without_image.dae"))));
  EXPECT_EQ(mesh_of(world).triangles.size(), 1u);
  EXPECT_TRUE(mesh_of(world).colors.empty());
}

TEST_F(Shapes, ShareMeshesOfTheSameFileAndScale) {
  const World world =
      read(static_model_sdf(collision(mesh("box.obj")), "a") + static_model_sdf(collision(mesh("box.obj")), "b") +
           static_model_sdf(collision(mesh("box.obj", "<scale>2 2 2</scale>")), "c"));
  EXPECT_EQ(&mesh_of(world, 0), &mesh_of(world, 1));
  EXPECT_NE(&mesh_of(world, 0), &mesh_of(world, 2));
}

TEST_F(Shapes, FindMeshesInModelFoldersAndBesideTheFile) {
  write("robots/rock/meshes/rock.obj", box_obj);
  write_model("rock", "<static>true</static>" + collision(mesh("meshes/rock.obj")));
  write_model("boulder", "<include merge=\"true\"><uri>model://rock</uri></include>");
  const World world = read(
      "<include><uri>model://rock</uri></include><include><uri>model://boulder</uri><static>true</static></include>" +
      static_model_sdf(collision(mesh("model://rock/meshes/rock.obj"))));
  for (std::size_t model = 0; model < 3; ++model) EXPECT_EQ(&mesh_of(world, model), &mesh_of(world, 0));
}

TEST_F(Shapes, ReadOneSubmeshOfAFile) {
  write("parts.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 4 0 0\nv 6 0 0\nv 4 2 0\no first\nf 1 2 3\no second\nf 4 5 6\n");
  const auto vertices = [&](const std::string& submesh) {
    const World world = read(static_model_sdf(collision(mesh("parts.obj", submesh))));
    EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
    return std::get<Mesh>(collision_of(world).shape).triangles->vertices;
  };
  EXPECT_EQ(vertices("").size(), 6u);
  EXPECT_EQ(vertices("<submesh><name>second</name></submesh>"),
            (std::vector<Vector3d>{{4, 0, 0}, {6, 0, 0}, {4, 2, 0}}));
  EXPECT_EQ(vertices("<submesh><name>second</name><center>true</center></submesh>"),
            (std::vector<Vector3d>{{-1, -1, 0}, {1, -1, 0}, {-1, 1, 0}}));
  const std::string missing = static_model_sdf(collision(mesh("parts.obj", "<submesh><name>x</name></submesh>")));
  expect_only_flaw({missing, 3, in_geometry + "/mesh/uri", "has no submesh 'x'; expected one of 'first', 'second'"},
                   write_world(missing));
}

TEST_F(Shapes, ReadAHeightForEachPixelOfAHeightmap) {
  const World world =
      read(static_model_sdf(collision(height_image("ridge.png",
                                                   "<size>4 2 0.5</size><pos>1 2 3</pos><texture>"
                                                   "<size>1</size><diffuse>x</diffuse><normal>x</normal></texture>"))));
  const HeightGrid& grid = *std::get<Heightmap>(collision_of(world).shape).grid;
  EXPECT_EQ(grid.columns, 3u);
  EXPECT_EQ(grid.rows, 2u);
  EXPECT_EQ(grid.spacing, Eigen::Vector2d(2, 2));
  const std::vector<double> expected = {0.2, 0, 0, 0, 0.5, 0.1};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(grid.heights[i], expected[i]) << i;
  EXPECT_EQ(collision_of(world).X_LC.position, Vector3d(1, 2, 3));
  EXPECT_TRUE(world.warnings.empty()) << texts_of(world.warnings);
}

TEST_F(Shapes, ReadHeightmapsOfSixteenBits) {
  write_png<png_uint_16>("fine.png", PNG_FORMAT_LINEAR_Y, 2, 2, {0, 1, 256, 65535});
  const World world = read(static_model_sdf(collision(height_image("fine.png", "<size>1 1 65535</size>"))));
  const HeightGrid& grid = *std::get<Heightmap>(collision_of(world).shape).grid;
  EXPECT_EQ(grid.heights, (std::vector<double>{256, 65535, 0, 1}));
}

TEST_F(Shapes, PrintNothingAboutInvalidFiles) {
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  for (const char* const file : {"broken.dae", "nan.stl", "no_triangle.obj"})
    problems_of([&] { read(static_model_sdf(collision(mesh(file)))); });
  problems_of([&] { read(static_model_sdf(collision(height_image("not.png")))); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

class FlawOfAShape : public Shapes, public testing::WithParamInterface<Flaw> {};

TEST_P(FlawOfAShape, IsReportedAloneWithFileLineAndElement) {
  expect_only_flaw(GetParam(), write_world(GetParam().content));
}

const std::string in_mesh = in_geometry + "/mesh/uri";
const std::string in_heightmap = in_geometry + "/heightmap/uri";
std::string still(const std::string& geometry) { return static_model_sdf(collision(geometry)); }

INSTANTIATE_TEST_SUITE_P(
    Shapes, FlawOfAShape,
    testing::Values(
        Flaw{still("<image><uri>a.png</uri></image>"), 2, in_geometry,
             "<image> is not supported; expected box, sphere, cylinder, capsule, ellipsoid, mesh, polyline, plane "
             "or heightmap"},
        Flaw{still("<capsule>\n<radius>0</radius><length>1</length></capsule>"), 3, in_geometry + "/capsule/radius",
             "expected a size > 0"},
        Flaw{still("<capsule><radius>1</radius>\n<length>-1</length></capsule>"), 3, in_geometry + "/capsule/length",
             "expected a size > 0"},
        Flaw{still("<ellipsoid>\n<radii>1 0 1</radii></ellipsoid>"), 3, in_geometry + "/ellipsoid/radii",
             "expected a size > 0"},
        Flaw{still(mesh("none.obj")), 3, in_mesh, "there is no such file"},
        Flaw{still(mesh("robots")), 3, in_mesh, "this is a folder"},
        Flaw{still(mesh("model://bt/box.obj")), 3, in_mesh, "there is no 'bt/box.obj'"},
        Flaw{still(mesh("https://somewhere/box.obj")), 3, in_mesh, "Cohort does not download"},
        Flaw{still(mesh("box.step")), 3, in_mesh, "expected .stl, .obj, .dae, .glb or .gltf"},
        Flaw{still(mesh("broken.dae")), 3, in_mesh, "cannot be read: "},
        Flaw{still(mesh("nan.stl")), 3, in_mesh, "a vertex is not finite"},
        Flaw{still(mesh("no_triangle.obj")), 3, in_mesh, "has no triangles"},
        Flaw{moving(mesh("flat.obj")), 3, in_mesh, "is flat"},
        Flaw{still(mesh("box.obj", "\n<scale>1 0 1</scale>")), 4, in_geometry + "/mesh/scale", "not zero"},
        Flaw{still(mesh("box.obj", "\n<scale>1 1</scale>")), 4, in_geometry + "/mesh/scale",
             "cannot have the value '1 1'"},
        Flaw{moving(height_image("ridge.png")), 2, in_geometry + "/heightmap",
             "a heightmap requires <static>true</static>"},
        Flaw{still(height_image("ridge.png", "\n<size>1 1 0</size>")), 4, in_geometry + "/heightmap/size",
             "expected a size > 0"},
        Flaw{still(height_image("none.png")), 3, in_heightmap, "there is no such file"},
        Flaw{still(height_image("not.png")), 3, in_heightmap, "expected a PNG image"},
        Flaw{still(height_image("colours.png")), 3, in_heightmap, "expected a greyscale PNG image with 8 or 16 bits"},
        Flaw{still(height_image("glass.png")), 3, in_heightmap, "expected a greyscale PNG image with 8 or 16 bits"},
        Flaw{still(height_image("dot.png")), 3, in_heightmap, "at least 2 by 2 pixels"}));

// ---- Convex hulls ----

void expect_hull(const TriangleMesh& hull, const std::vector<Vector3d>& points) {
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& triangle : hull.triangles) {
    const Vector3d& a = hull.vertices[triangle[0]];
    const Vector3d normal = (hull.vertices[triangle[1]] - a).cross(hull.vertices[triangle[2]] - a).normalized();
    for (const Vector3d& point : points) ASSERT_LE(normal.dot(point - a), 1e-9);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(edges.emplace(triangle[i], triangle[(i + 1) % 3]).second);
  }
  for (const auto& [from, to] : edges) EXPECT_TRUE(edges.contains({to, from})) << "it is not closed";
  EXPECT_EQ(hull.vertices.size() + hull.triangles.size(), edges.size() / 2 + 2) << "Euler's formula";
}

TEST(ConvexHull, ContainsRandomPointsAndHasNoOthers) {
  const RandomStream random(3, "description_test", "hull");
  std::vector<Vector3d> points;
  for (std::uint64_t n = 0; n < 500; ++n)
    points.emplace_back(random.normal(n, 0), 2.0 * random.normal(n, 1), 3.0 * random.normal(n, 2));
  expect_hull(geometry::convex_hull(points), points);
}

TEST(ConvexHull, IsABoxForAGridOfPoints) {
  std::vector<Vector3d> points;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 6; ++y)
      for (int z = 0; z < 6; ++z) points.emplace_back(0.1 * x, 0.2 * y, 0.3 * z);
  const TriangleMesh hull = geometry::convex_hull(points);
  expect_hull(hull, points);
  EXPECT_NEAR(volume_of(hull), 0.5 * 1.0 * 1.5, 1e-12);
}

TEST(ConvexHull, HasAllPointsOfARoundBody) {
  std::vector<Vector3d> points;
  for (int ring = 0; ring < 40; ++ring)
    for (int i = 0; i < 50; ++i) {
      const double latitude = std::numbers::pi * (ring + 0.5) / 40, longitude = 2 * std::numbers::pi * i / 50;
      points.emplace_back(std::sin(latitude) * std::cos(longitude), std::sin(latitude) * std::sin(longitude),
                          std::cos(latitude));
    }
  const TriangleMesh hull = geometry::convex_hull(points);
  expect_hull(hull, points);
  EXPECT_EQ(hull.vertices.size(), points.size());
}

TEST(ConvexHull, RejectsPointsWithoutVolume) {
  EXPECT_THROW(geometry::convex_hull({}), std::invalid_argument);
  EXPECT_THROW(geometry::convex_hull({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}, {1, 2, 3}}), std::invalid_argument);
  EXPECT_THROW(geometry::convex_hull({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}), std::invalid_argument);
  EXPECT_THROW(geometry::convex_hull({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 5, 0}}), std::invalid_argument);
}

// ---- Footprints ----

Pose turned(double angle, const Vector3d& axis) {
  return {{1, 2, 3}, Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis))};
}

TEST(Footprints, AreExactForTiltedCapsules) {
  const auto upright = geometry::footprint_of(Capsule{0.5, 4.0}, turned(0.0, Vector3d::UnitX()));
  EXPECT_NEAR(upright->distance({3.0, 2.0}), 1.5, 1e-12);
  EXPECT_NEAR(upright->highest, 5.5, 1e-12);
  const auto leaning = geometry::footprint_of(Capsule{0.5, 4.0}, turned(std::numbers::pi / 6, Vector3d::UnitY()));
  EXPECT_NEAR(leaning->distance({1.0 + 2.0 * 0.5 + 1.5, 2.0}), 1.0, 1e-12);
  EXPECT_NEAR(leaning->distance({1.0, 3.0}), 0.5, 1e-12);
  EXPECT_NEAR(leaning->lowest, 3.0 - 2.0 * std::sqrt(0.75) - 0.5, 1e-12);
}

TEST(Footprints, ContainAndTouchEllipsoids) {
  const auto round = geometry::footprint_of(Ellipsoid{{2, 2, 1}}, turned(0.3, Vector3d::UnitZ()));
  EXPECT_NEAR(round->distance({4.0, 2.0}), 1.0, 1e-12);
  const auto lying = geometry::footprint_of(Ellipsoid{{3, 1, 2}}, turned(std::numbers::pi / 2, Vector3d::UnitZ()));
  EXPECT_NEAR(lying->distance({1.0, 6.0}), 1.0, 1e-12);
  EXPECT_NEAR(lying->distance({3.0, 2.0}), 1.0, 1e-12);
  const Pose tilted = turned(0.8, Vector3d(1, 2, 3).normalized());
  const auto any = geometry::footprint_of(Ellipsoid{{3, 1, 2}}, tilted);
  const RandomStream random(5, "description_test", "ellipsoid");
  double highest = 0.0;
  for (std::uint64_t n = 0; n < 2000; ++n) {
    const Vector3d on = Vector3d(random.normal(n, 0), random.normal(n, 1), random.normal(n, 2)).normalized();
    const Vector3d on_W = tilted * on.cwiseProduct(Vector3d(3, 1, 2)).eval();
    EXPECT_EQ(any->distance(on_W.head<2>() * (1.0 - 1e-12)), 0.0);
    highest = std::max(highest, on_W.z());
  }
  EXPECT_NEAR(any->highest, highest, 1e-2);
}

TEST(Footprints, AreTheSmallestRectangleOfAMesh) {
  const std::vector<Vector3d> corners = {{-1, -2, 0}, {1, -2, 0}, {1, 2, 0}, {-1, 2, 0}, {0, 0, 5}};
  const Mesh pyramid{std::make_shared<const TriangleMesh>(geometry::convex_hull(corners))};
  const auto footprint = geometry::footprint_of(pyramid, turned(0.5, Vector3d::UnitZ()));
  EXPECT_NEAR(footprint->half.prod(), 2.0, 1e-12);
  EXPECT_TRUE(footprint->centre.isApprox(Eigen::Vector2d(1, 2), 1e-12));
  EXPECT_NEAR(footprint->distance(Eigen::Vector2d(1, 2) + 3.0 * Eigen::Vector2d(std::cos(0.5), std::sin(0.5))), 2.0,
              1e-12);
  EXPECT_EQ(footprint->lowest, 3.0);
  EXPECT_EQ(footprint->highest, 8.0);
}

TEST(Footprints, DoNotExistForHeightmaps) {
  EXPECT_FALSE(geometry::footprint_of(
      Heightmap{std::make_shared<const HeightGrid>(HeightGrid{2, 2, {1, 1}, {0, 0, 0, 0}})}, Pose{}));
}

}  // namespace
}  // namespace cohort::description
