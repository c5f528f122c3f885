// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <png.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "server/description/experiment.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/simulation/simulation.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort {
namespace {

namespace fs = std::filesystem;
using description::Description;
using description::Experiment;
using description::KeptFile;
using description::KeptFiles;
using parsing::read_experiment;

std::array<std::uint64_t, 2> hashes_at_0_and_100(const Experiment& experiment) {
  Simulation simulation(experiment, 2);
  std::array<std::uint64_t, 2> hashes{simulation.state_hash(), 0};
  while (simulation.tick() < 100) simulation.step();
  hashes[1] = simulation.state_hash();
  return hashes;
}

std::vector<std::string> shipped_experiments() {
  std::vector<std::string> names;
  for (const fs::directory_entry& entry : fs::directory_iterator(description::source / "worlds/experiments"))
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  std::ranges::sort(names);
  return names;
}

class KeptExperiment : public ::testing::TestWithParam<std::string> {};

TEST_P(KeptExperiment, IsReadAgainWithoutItsFiles) {
  const fs::path folder = fs::temp_directory_path() / ("cohort_kept_" + GetParam() + std::to_string(getpid()));
  fs::create_directories(folder);
  fs::copy(description::source / "worlds", folder / "worlds", fs::copy_options::recursive);
  const Experiment first = read_experiment(folder / "worlds/experiments" / (GetParam() + ".yaml"), 7);
  const auto hashes = hashes_at_0_and_100(first);
  fs::remove_all(folder);
  const Experiment again = read_experiment(first.inputs, first.seed, first.duration);
  EXPECT_EQ(again.file, first.file);
  EXPECT_EQ(again.duration, first.duration);
  EXPECT_EQ(hashes_at_0_and_100(again), hashes);
  EXPECT_EQ(again.inputs, first.inputs);
}

/// A temporary copy of the shipped worlds, which is removed with this. Files are named from its folder of experiments.
class CopyOfWorlds {
 public:
  explicit CopyOfWorlds(const std::string& name)
      : folder_(fs::temp_directory_path() / ("cohort_named_" + name + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    fs::copy(description::source / "worlds", folder_ / "worlds", fs::copy_options::recursive);
    fs::create_directory(folder_ / "links");
    fs::create_directory_symlink(folder_ / "worlds", folder_ / "links/worlds");
    fs::create_directory_symlink(folder_ / "worlds/experiments", folder_ / "links/experiments");
    fs::current_path(folder_ / "worlds/experiments");
  }
  CopyOfWorlds(const CopyOfWorlds&) = delete;
  CopyOfWorlds& operator=(const CopyOfWorlds&) = delete;
  ~CopyOfWorlds() {
    fs::current_path(before_);
    fs::remove_all(folder_);
  }

  /// Returns all notations of the path of one of its experiments.
  std::vector<fs::path> ways_to_name(const std::string& file) const {
    fs::create_symlink(file, folder_ / "worlds/experiments" / ("link_to_" + file));
    return {file,
            "./" + file,
            "../experiments/" + file,
            "..//experiments/./" + file,
            folder_ / "worlds/experiments" / file,
            folder_ / "worlds/arenas/../experiments" / file,
            folder_ / "links/worlds/experiments" / file,
            folder_ / "links/experiments" / file,
            "../../links/experiments/" + file,
            folder_ / "links/experiments/../experiments" / file,
            "link_to_" + file};
  }

 private:
  fs::path before_ = fs::current_path();
  fs::path folder_;
};

TEST_P(KeptExperiment, DoesNotDependOnTheNotationOfItsPath) {
  std::vector<Experiment> experiments;
  {
    const CopyOfWorlds copy(GetParam());
    for (const fs::path& named : copy.ways_to_name(GetParam() + ".yaml")) {
      SCOPED_TRACE(named);
      ASSERT_NO_THROW(experiments.push_back(read_experiment(named, 7)));
    }
  }
  const std::uint64_t hash = Simulation(experiments.front(), 2).state_hash();
  for (const Experiment& first : experiments) {
    SCOPED_TRACE(first.file);
    for (const KeptFile& file : first.inputs->files)
      EXPECT_EQ(file.path, fs::path(file.path).lexically_normal()) << "a file has several names";
    EXPECT_EQ(first.inputs->files.size(), experiments.front().inputs->files.size());
    ASSERT_NO_THROW({
      const Experiment again = read_experiment(first.inputs, first.seed, first.duration);
      EXPECT_EQ(Simulation(again, 2).state_hash(), hash);
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, KeptExperiment, ::testing::ValuesIn(shipped_experiments()),
                         [](const auto& each) { return each.param; });

/// An experiment with a file of every kind.
class KeptFilesOfAllKinds : public Description {
 protected:
  KeptFilesOfAllKinds() {
    fs::create_directories(folder_ / "elsewhere/rock");
    fs::create_directories(folder_ / "installed");
    write("elsewhere/rock/model.config", "<model><name>rock</name><sdf version='1.9'>rock.sdf</sdf></model>");
    write("elsewhere/rock/rock.sdf",
          "<sdf version='1.9'><model name='rock'>" + description::links("a") +
              "<link name='l'><inertial><mass>1</mass></inertial><collision name='c'><geometry><mesh><uri>rock.obj"
              "</uri></mesh></geometry></collision></link><joint name='j' type='fixed'><parent>a</parent><child>l"
              "</child></joint></model></sdf>");
    write("elsewhere/rock/rock.obj",
          "mtllib rock.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl grey\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
    write("elsewhere/rock/rock.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
    write("installed/post/model.config", "<model><name>post</name><sdf version='1.9'>post.urdf</sdf></model>");
    write("installed/post/post.urdf",
          "<robot name='post'><link name='l'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' "
          "ixz='0' iyz='0'/></inertial></link></robot>");
    write("readings.csv",
          "distance [m],angle [rad],reading_0 [1],reading_1 [1]\n0.01,-1,1,2\n0.01,1,3,4\n0.1,-1,5,6\n0.1,1,7,8\n");
    write("robots/seer/model.config", "<model><name>seer</name><sdf version='1.9'>model.sdf</sdf></model>");
    write("robots/seer/model.sdf",
          "<sdf version='1.9' xmlns:cohort='https://cohort-sim.org/sdf/1'><model name='seer'>" +
              description::links("l") +
              "<cohort:proximity_ring name='near'><cohort:link>l</cohort:link><cohort:count>2</cohort:count>"
              "<cohort:first_bearing>-0.5</cohort:first_bearing><cohort:spacing>1</cohort:spacing>"
              "<cohort:ring_radius>0.1</cohort:ring_radius><cohort:range>0.2</cohort:range>"
              "<cohort:technique>samples</cohort:technique><cohort:samples>../../readings.csv</cohort:samples>"
              "</cohort:proximity_ring></model></sdf>");
    write_image();
    write("arena.yaml", R"(world:
  name: w
  include:
    - {uri: model://rock, pose: 0 0 2 0 0 0}
    - {uri: model://post, pose: 3 0 2 0 0 0}
    - {uri: model://seer, pose: 6 0 2 0 0 0}
  model:
    - name: ground
      static: true
      link:
        name: l
        collision:
          name: c
          geometry: {heightmap: {uri: ridge.png, size: 20 20 1}}
)");
    write("run.yaml",
          "world: arena.yaml\nduration: 1\nteams: [{name: all, robots: all, controller: none}]\nevents:\n"
          "  - {at: 0.5, add: {model: 'model://rock', name: late, pose: 0 3 2 0 0 0}}\n");
    setenv("COHORT_MODEL_PATH", (folder_ / "elsewhere").c_str(), 1);
  }
  ~KeptFilesOfAllKinds() override { unsetenv("COHORT_MODEL_PATH"); }

  void write_image() const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = 3;
    image.height = 3;
    image.format = PNG_FORMAT_GRAY;
    const std::array<png_byte, 9> pixels{0, 9, 0, 50, 99, 20, 0, 9, 0};
    ASSERT_NE(png_image_write_to_file(&image, (folder_ / "ridge.png").c_str(), 0, pixels.data(), 0, nullptr), 0);
  }
  Experiment read() const { return read_experiment(folder_ / "run.yaml", 3, {}, {folder_ / "installed"}); }
  std::vector<std::string> names_of(const std::vector<KeptFile>& files) const {
    std::vector<std::string> names;
    names.reserve(files.size());
    for (const KeptFile& file : files) names.push_back(fs::path(file.path).lexically_relative(folder_).string());
    return names;
  }
};

TEST_F(KeptFilesOfAllKinds, HaveEachFileOnce) {
  const Experiment experiment = read();
  EXPECT_EQ(names_of(experiment.inputs->files),
            (std::vector<std::string>{"arena.yaml", "elsewhere/rock/model.config", "elsewhere/rock/rock.mtl",
                                      "elsewhere/rock/rock.obj", "elsewhere/rock/rock.sdf",
                                      "installed/post/model.config", "installed/post/post.urdf", "readings.csv",
                                      "ridge.png", "robots/seer/model.config", "robots/seer/model.sdf", "run.yaml"}));
  EXPECT_EQ(experiment.inputs->files[2].bytes, "newmtl grey\nKd 0.5 0.5 0.5\n");
}

TEST_F(KeptFilesOfAllKinds, SufficeToReadTheExperimentAgain) {
  const Experiment first = read();
  const auto hashes = hashes_at_0_and_100(first);
  fs::remove_all(folder_);
  setenv("COHORT_MODEL_PATH", "/nowhere", 1);
  const Experiment again = read_experiment(first.inputs, first.seed, first.duration);
  EXPECT_EQ(again.world.instances.size(), 5u);
  EXPECT_EQ(hashes_at_0_and_100(again), hashes);
}

TEST_F(KeptFilesOfAllKinds, ContainTheFileThatNamesAPackageInADeepFolder) {
  write("ros/src/stack/robot_v2/package.xml", "<package><name>robot</name></package>");
  write("ros/src/stack/robot_v2/stone.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  write("ros/src/stack/other/package.xml", "<package><name>other</name></package>");
  write("ros/src/broken/package.xml", "<package><name>robot");
  write("robot.urdf",
        "<robot name='r'><link name='l'><inertial><mass value='1'/></inertial><collision><geometry>"
        "<mesh filename='package://robot/stone.obj'/></geometry></collision></link></robot>");
  write("arena.yaml", "world: {name: w, include: [{uri: robot.urdf}]}\n");
  write("run.yaml", "world: arena.yaml\nduration: 1\nteams: []\n");
  setenv("ROS_PACKAGE_PATH", (folder_ / "ros").c_str(), 1);
  const Experiment first = read();
  unsetenv("ROS_PACKAGE_PATH");
  EXPECT_EQ(names_of(first.inputs->files),
            (std::vector<std::string>{"arena.yaml", "robot.urdf", "ros/src/stack/robot_v2/package.xml",
                                      "ros/src/stack/robot_v2/stone.obj", "run.yaml"}));
  const auto hashes = hashes_at_0_and_100(first);
  fs::remove_all(folder_);
  EXPECT_EQ(hashes_at_0_and_100(read_experiment(first.inputs, first.seed, first.duration)), hashes);
}

TEST_F(KeptFilesOfAllKinds, HavePriorityOverFilesOnTheDisk) {
  const Experiment first = read();
  const auto hashes = hashes_at_0_and_100(first);
  write("arena.yaml", "world: {name: other}\n");
  write("elsewhere/rock/rock.obj", "changed");
  const Experiment again = read_experiment(first.inputs, first.seed, first.duration);
  EXPECT_EQ(hashes_at_0_and_100(again), hashes);
}

TEST_F(KeptFilesOfAllKinds, ResolveRelativeNamesInTheOriginalFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  const Experiment first = read_experiment("run.yaml", 3, {}, {"installed"});
  fs::current_path(before);
  const auto hashes = hashes_at_0_and_100(first);
  fs::remove_all(folder_);
  const Experiment again = read_experiment(first.inputs, first.seed, first.duration);
  EXPECT_EQ(again.file, "run.yaml");
  EXPECT_EQ(hashes_at_0_and_100(again), hashes);
}

TEST_F(KeptFilesOfAllKinds, AcceptAnyNotationOfPathsOfWorldsAndModels) {
  fs::create_directory_symlink(folder_ / "elsewhere", folder_ / "link");
  const fs::path before = fs::current_path();
  fs::current_path(folder_ / "installed");
  std::vector<Experiment> experiments;
  for (const char* const named : {"./post/post.urdf", "../installed/post/post.urdf", "../arena.yaml", ".././arena.yaml",
                                  "../link/rock/rock.sdf", "../link/../arena.yaml"})
    experiments.push_back(read_experiment(named, 3, {}, {folder_ / "installed"}));
  fs::current_path(before);
  fs::remove_all(folder_);
  for (const Experiment& first : experiments) {
    SCOPED_TRACE(first.file);
    const Experiment again = read_experiment(first.inputs, first.seed, first.duration);
    EXPECT_EQ(Simulation(again, 2).state_hash(), Simulation(first, 2).state_hash());
  }
}

// As in recordings from before the paths of kept files were normalised.
TEST_F(KeptFilesOfAllKinds, AreFoundByUnnormalisedPaths) {
  const Experiment first = read();
  KeptFiles other = *first.inputs;
  other.experiment = "./elsewhere/../run.yaml";
  for (KeptFile& file : other.files)
    file.path = (fs::path(file.path).parent_path() / "./a/.." / fs::path(file.path).filename()).string();
  for (std::string& folder : other.folders) folder += "/.";
  other.working_folder = folder_ / "nowhere/..";
  const auto kept = std::make_shared<const KeptFiles>(other);
  fs::remove_all(folder_);
  const Experiment again = read_experiment(kept, first.seed, first.duration);
  EXPECT_EQ(hashes_at_0_and_100(again), hashes_at_0_and_100(first));
}

TEST_F(KeptFilesOfAllKinds, IgnoreOtherFilesOnTheDisk) {
  const Experiment first = read();
  KeptFiles without = *first.inputs;
  std::erase_if(without.files, [](const KeptFile& file) { return file.path.ends_with("ridge.png"); });
  const auto problems = description::problems_of(
      [&] { read_experiment(std::make_shared<const KeptFiles>(without), first.seed, first.duration); });
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_NE(problems[0].message.find("not among those from which the experiment was read"), std::string::npos)
      << problems[0].text();
}

}  // namespace
}  // namespace cohort
