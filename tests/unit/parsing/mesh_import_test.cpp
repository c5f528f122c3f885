// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/files/mesh_import.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "server/parsing/files/limited_child.hpp"
#include "server/parsing/files/mesh_file.hpp"
#include "tests/support/images.hpp"
#include "tests/support/worlds/written_worlds.hpp"

// Tests that this process survives any mesh file.
namespace cohort::description {
namespace {

using parsing::ChildStream;
using parsing::LimitedChild;

// AddressSanitizer and ThreadSanitizer allocate within memory that they have reserved, so memory limits have no effect.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool limits_memory = false;
#else
constexpr bool limits_memory = true;
#endif

// ---- Files that crash Assimp, or make it exhaust the memory ----

struct Collada {
  std::string library_nodes{};
  std::string scene = "<node><instance_geometry url=\"#g\"/></node>";
  std::string count = "9";

  std::string text() const {
    return R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/></asset><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="f" count=")" +
           count + R"(">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#f" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common>
</source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries><library_nodes>)" +
           library_nodes + R"(</library_nodes><library_visual_scenes><visual_scene id="s">)" + scene +
           R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
  }
};

std::string repeated(const std::string& text, std::size_t count) {
  std::string all;
  for (std::size_t i = 0; i < count; ++i) all += text;
  return all;
}
std::string instance_of(const std::string& node) { return "<instance_node url=\"#" + node + "\"/>"; }

std::string with_cycle() {
  return Collada{"<node id=\"a\">" + instance_of("b") + "</node><node id=\"b\">" + instance_of("a") + "</node>",
                 "<node>" + instance_of("a") + "</node>"}
      .text();
}
std::string with_deep_nodes() {
  return Collada{"", repeated("<node>", 100'000) + "<instance_geometry url=\"#g\"/>" + repeated("</node>", 100'000)}
      .text();
}
std::string with_negative_count() { return Collada{.count = "-1"}.text(); }

/// Each of `levels` nodes contains the previous one four times.
std::string with_shared_nodes(std::size_t levels) {
  std::string nodes = "<node id=\"n0\"><instance_geometry url=\"#g\"/></node>";
  for (std::size_t i = 1; i <= levels; ++i)
    nodes += "<node id=\"n" + std::to_string(i) + "\"><translate>" + std::to_string(i) + " 0 0</translate>" +
             repeated(instance_of("n" + std::to_string(i - 1)), 4) + "</node>";
  return Collada{nodes, "<node>" + instance_of("n" + std::to_string(levels)) + "</node>"}.text();
}

std::string mesh(const std::string& file) { return "<mesh>\n<uri>" + file + "</uri></mesh>"; }

class MeshImport : public Description {};

struct Bomb {
  const char* name;
  std::function<std::string()> text;
};
void PrintTo(const Bomb& bomb, std::ostream* out) { *out << bomb.name; }

class MeshThatBreaksItsImporter : public MeshImport, public testing::WithParamInterface<Bomb> {
 protected:
  MeshThatBreaksItsImporter() { write("bomb.dae", GetParam().text()); }
};

TEST_P(MeshThatBreaksItsImporter, IsAnErrorWithFileLineAndElement) {
  expect_only_flaw(
      {static_model_sdf(collision(mesh("bomb.dae"))), 3, "world/model[m]/link[l]/collision[c]/geometry/mesh/uri",
       (folder_ / "bomb.dae").string() + "' cannot be imported: the importer "},
      write_world(static_model_sdf(collision(mesh("bomb.dae")))));
}

TEST_P(MeshThatBreaksItsImporter, IsAnErrorInVisualsAndForeignFiles) {
  const std::string shape = "<geometry>" + mesh("bomb.dae") + "</geometry>";
  const std::string visual = "<link name=\"l\"><visual name=\"v\">" + shape + "</visual></link>";
  for (const std::string& link : {visual, collision(mesh("bomb.dae"))}) {
    const auto file = write("w.sdf", "<sdf version=\"1.9\"><world name=\"w\">" + static_model_sdf(link) +
                                         static_model_sdf(link, "n") + "</world></sdf>");
    const std::vector<Problem> problems = problems_of([&] { parsing::read_world(file, 1); });
    ASSERT_EQ(problems.size(), 1u) << "reading goes on after a mesh that took all it may";
    EXPECT_EQ(problems[0].line, 2);
  }
}

std::vector<Bomb> bombs() {
  std::vector<Bomb> bombs = {
      {"node_cycle", with_cycle}, {"deep_nodes", with_deep_nodes}, {"negative_count", with_negative_count}};
  if (limits_memory) bombs.push_back({"shared_nodes", [] { return with_shared_nodes(11); }});
  return bombs;
}
INSTANTIATE_TEST_SUITE_P(Meshes, MeshThatBreaksItsImporter, testing::ValuesIn(bombs()),
                         [](const auto& bomb) { return std::string(bomb.param.name); });

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST_F(MeshImport, LimitsTheMemoryOfTheImporter) {
  rusage before{}, after{};
  getrusage(RUSAGE_SELF, &before);
  write("bomb.dae", with_shared_nodes(11));
  EXPECT_EQ(problems_of([&] { read(static_model_sdf(collision(mesh("bomb.dae")))); }).size(), 1u);
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 200 << 10);  // [KiB]
}
#endif

TEST_F(MeshImport, ReadsSharedNodes) {
  write("shared.dae", with_shared_nodes(5));
  const World world = read(static_model_sdf(collision(mesh("shared.dae"))));
  EXPECT_EQ(std::get<Mesh>(world.models[0].links[0].collisions[0].shape).triangles->triangles.size(), 1024u);
}

// Reads from the disk in this process.
class SourcesOnDisk : public parsing::MeshSources {
 public:
  bool is_file(const std::string& file) override { return std::filesystem::is_regular_file(file); }
  const std::string* read(const std::string& file) override {
    return is_file(file) ? &files_.emplace(file, test::read_file(file)).first->second : nullptr;
  }

 private:
  std::map<std::string, std::string> files_;
};

template <class Item>
bool has_same_bits(const std::vector<Item>& a, const std::vector<Item>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Item)) == 0);
}

TEST_F(MeshImport, EqualsAnImportInThisProcess) {
  write("a.dae", with_shared_nodes(5));
  write("a.obj", "mtllib a.mtl\nv 0.1 0 -0\nv 1 0.3 0\nv 0 1 0\nv 0 0 1\nusemtl m\nf 1 3 2\nf 1 2 4\nf 2 3 4\n");
  write("a.mtl", "newmtl m\nKd 0.6 0 1\n");
  write("a.glb", test::glb_of(R"({"bufferView":3,"mimeType":"image/png"})", test::png_of(2, 2)));
  const std::filesystem::path files = source / "tests/data/files";
  const Eigen::Vector3d scale(0.1, -0.3, 7.0);
  parsing::MeshReader reader;
  for (const auto& file : {folder_ / "a.dae", folder_ / "a.obj", folder_ / "a.glb", files / "tetrahedron.obj",
                           files / "tetrahedron.stl", files / "triangle.dae"}) {
    parsing::InputFiles input;
    input.trust(file);
    SourcesOnDisk sources;
    const parsing::ImportedMesh there = reader.read(input, file, scale);
    const parsing::ImportedMesh here = parsing::import_mesh(sources, file, scale);
    EXPECT_TRUE(has_same_bits(there.vertices, here.vertices)) << file;
    EXPECT_TRUE(has_same_bits(there.triangles, here.triangles)) << file;
    EXPECT_TRUE(has_same_bits(there.colors, here.colors)) << file;
    EXPECT_TRUE(has_same_bits(there.textures.coordinates, here.textures.coordinates)) << file;
    EXPECT_EQ(there.textures.of_triangles, here.textures.of_triangles) << file;
    ASSERT_EQ(there.images.size(), here.images.size()) << file;
    EXPECT_EQ(there.images.size(), file.extension() == ".glb" ? 1u : 0u);
    for (std::size_t i = 0; i < here.images.size(); ++i) EXPECT_EQ(there.images[i].bytes, here.images[i].bytes);
    EXPECT_TRUE(file.filename() != "a.obj" || !there.colors.empty()) << "its colours are those of the .mtl";
  }
}

TEST_F(MeshImport, IsNotDisturbedByThreadsThatAllocate) {
  write("one.dae", Collada{}.text());
  std::atomic<bool> over = false;
  std::vector<std::thread> threads;
  threads.reserve(3);
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      while (!over) {
        std::vector<std::unique_ptr<std::string>> texts;
        for (std::size_t size = 1; size < 100; ++size) texts.push_back(std::make_unique<std::string>(size * 50, 'x'));
      }
    });
  for (int i = 0; i < 30; ++i) {
    parsing::InputFiles input;
    input.trust(folder_ / "world.sdf");
    EXPECT_EQ(parsing::MeshReader().read(input, folder_ / "one.dae", Eigen::Vector3d::Ones()).triangles.size(), 1u);
  }
  over = true;
  for (std::thread& thread : threads) thread.join();
}

TEST_F(MeshImport, SurvivesAnyFile) {
  const std::vector<std::pair<std::string, std::string>> files = {
      {"/a.dae", with_shared_nodes(3)},
      {"/a.dae", with_cycle()},
      {"/a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nusemtl m\nf 1//1 2//1 3//1\nf -3 -2 -1\n"},
      {"/a.stl",
       "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
       "endfacet\nendsolid s\n"},
      {"/a.glb", test::glb_of(R"({"bufferView":3,"mimeType":"image/png"})", test::png_of(2, 2))},
      {"/a.stl", std::string(80, ' ') + std::string("\1\0\0\0", 4) + std::string(50, '\0')}};
  std::mt19937_64 random(1);
  parsing::MeshReader reader;
  std::size_t refused = 0;
  constexpr std::size_t count = 480;
  for (std::size_t i = 0; i < count; ++i) {
    auto [name, text] = files[i % files.size()];
    for (std::size_t change = random() % 4; change < 4; ++change) {
      const std::size_t at = random() % text.size();
      if (change % 2 == 0) text[at] = static_cast<char>("0-9<>\"#\xff"[random() % 8]);
      if (change % 2 == 1) text.insert(at, text.substr(random() % text.size(), random() % 60));
    }
    parsing::InputFiles input(std::make_shared<const KeptFiles>());
    input.add(name, text);
    input.add("/a.mtl", "newmtl m\nKd 1 0 0\n");
    try {
      reader.read(input, name, Eigen::Vector3d::Ones());
    } catch (const std::runtime_error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0u);
  EXPECT_LT(refused, count);
}

// ---- Processes with limits ----

/// Returns why a child with this work ends.
std::string end_of(const parsing::ChildLimits& limits, const LimitedChild::Work& work) {
  LimitedChild child(limits, work);
  try {
    child.stream().receive<char>();
  } catch (const ChildStream::Lost&) {
    return child.end();
  }
  return "sent something";
}

TEST(LimitedProcess, EndsAtTheLimitOfProcessorTime) {
  const auto spin = [](ChildStream&) {
    const std::atomic<bool> is_over = false;
    while (!is_over) continue;
  };
  EXPECT_EQ(end_of({.processor_time = std::chrono::seconds(1)}, spin), "used more than 1 s of processor time");
}

TEST(LimitedProcess, EndsAtTheLimitOfWallTime) {
  const auto wait = [](ChildStream& stream) { stream.receive<char>(); };
  EXPECT_EQ(end_of({.wall_time = std::chrono::seconds(1)}, wait), "took longer than 1 s");
}

TEST(LimitedProcess, SaysHowItCrashed) {
  EXPECT_EQ(end_of({}, [](ChildStream&) { std::raise(SIGSEGV); }), "crashed (signal 11)");
  EXPECT_EQ(end_of({}, [](ChildStream&) { throw 1; }), "crashed (exit code 72)");
}

TEST(LimitedProcess, WorksManyTimesEachWithTheMemoryOfTheFirst) {
  int calls = 0;
  LimitedChild child(
      {}, [&](ChildStream& stream) { stream.send(++calls + stream.receive<int>()); }, LimitedChild::Times::many);
  for (int i = 0; i < 5; ++i) {
    child.begin();
    child.stream().send(10 * i);
    EXPECT_EQ(child.stream().receive<int>(), 10 * i + 1);
  }
  EXPECT_EQ(calls, 0);
}

TEST(LimitedProcess, EndsAsOneOfItsTimesHasEnded) {
  const auto end_after = [](const parsing::ChildLimits& limits, const LimitedChild::Work& work) {
    LimitedChild child(
        limits, [&](ChildStream& stream) { stream.receive<bool>() ? work(stream) : stream.send('x'); },
        LimitedChild::Times::many);
    child.begin();
    child.stream().send(false);
    EXPECT_EQ(child.stream().receive<char>(), 'x');
    child.begin();
    child.stream().send(true);
    EXPECT_THROW(child.stream().receive<char>(), ChildStream::Lost);
    return child.end();
  };
  EXPECT_EQ(end_after({}, [](ChildStream&) { std::raise(SIGSEGV); }), "crashed (signal 11)");
  EXPECT_EQ(end_after({}, [](ChildStream&) { throw 1; }), "crashed (exit code 72)");
  EXPECT_EQ(end_after({.wall_time = std::chrono::seconds(1)}, [](ChildStream& stream) { stream.receive<char>(); }),
            "took longer than 1 s");
}

TEST(LimitedProcess, HasNoOpenFilesOfThisProcess) {
  int ends[2];
  ASSERT_EQ(pipe(ends), 0);
  LimitedChild child({}, [&](ChildStream& stream) { stream.send(write(ends[1], "x", 1) == 1); });
  EXPECT_FALSE(child.stream().receive<bool>());
  close(ends[0]);
  close(ends[1]);
}

}  // namespace
}  // namespace cohort::description
