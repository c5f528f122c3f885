// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "server/parsing/experiment/read_experiment.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort {
namespace {

namespace fs = std::filesystem;
using description::Description;
using description::Experiment;
using description::KeptFile;
using description::Problem;
using description::problems_of;

// With this declaration, a file is checked strictly.
constexpr const char* ours = " xmlns:cohort='https://cohort-sim.org/sdf/1'";
constexpr const char* tetrahedron =
    "mtllib {}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl grey\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

/// A world in a separate folder, beside a file that it must not read.
class TrustedFolders : public Description {
 protected:
  TrustedFolders() {
    write("secret/id_rsa", "newmtl grey\nKd 0.5 0.5 0.5\n");
    write_rock("secret/rock.obj", "id_rsa");
    write("world/run.yaml", "world: arena.sdf\nduration: 1\nteams: []\n");
  }
  void write_rock(const std::string& name, const std::string& material) const {
    std::string text = tetrahedron;
    write(name, text.replace(text.find("{}"), 2, material));
  }
  void write_arena(const std::string& mesh, const std::string& prefix = ours) const {
    write("world/arena.sdf",
          "<sdf version='1.9'" + prefix +
              "><world name='w'>\n<model name='rock'><static>true</static><link name='l'>\n<collision "
              "name='c'><geometry><mesh><uri>" +
              mesh + "</uri></mesh></geometry></collision></link></model></world></sdf>");
  }
  Experiment read() const { return parsing::read_experiment(folder_ / "world/run.yaml"); }
  std::string message() const {
    const std::vector<Problem> problems = problems_of([&] { return read(); });
    return problems.empty() ? "" : problems.front().message;
  }
  void expect_outside(const std::string& folder) const {
    const std::string found = message();
    EXPECT_NE(found.find("outside of all allowed folders; use --allow-files " + (folder_ / folder).string() + " "),
              std::string::npos)
        << found;
  }
};

TEST_F(TrustedFolders, CannotBeLeftByAPath) {
  write_arena("../secret/rock.obj");
  expect_outside("secret");
  write_arena((folder_ / "secret/rock.obj").string());
  expect_outside("secret");
  write_arena("file://" + (folder_ / "secret/rock.obj").string());
  expect_outside("secret");
  setenv("COHORT_ALLOW_FILES", ("/nowhere:" + (folder_ / "secret").string()).c_str(), 1);
  EXPECT_EQ(message(), "");
  unsetenv("COHORT_ALLOW_FILES");
}

TEST_F(TrustedFolders, CannotBeLeftByAForeignFile) {
  write_arena("../secret/rock.obj", "");
  const Experiment experiment = read();
  ASSERT_EQ(experiment.world.warnings.size(), 1u);
  EXPECT_NE(experiment.world.warnings[0].message.find("--allow-files"), std::string::npos)
      << experiment.world.warnings[0].text();
  EXPECT_TRUE(std::ranges::none_of(experiment.inputs->files,
                                   [](const KeptFile& file) { return file.path.find("secret") != std::string::npos; }));
}

TEST_F(TrustedFolders, CannotBeLeftByASymbolicLink) {
  fs::create_directory_symlink(folder_ / "secret", folder_ / "world/meshes");
  write_arena("meshes/rock.obj");
  expect_outside("world/meshes");
}

TEST_F(TrustedFolders, CannotBeLeftByTheMaterialsOfAMesh) {
  write_rock("world/rock.obj", "../secret/id_rsa");
  write_arena("rock.obj");
  const Experiment experiment = read();
  EXPECT_TRUE(std::ranges::none_of(experiment.inputs->files, [](const KeptFile& file) {
    return file.path.find("id_rsa") != std::string::npos || file.bytes.find("newmtl") != std::string::npos;
  }));
}

TEST_F(TrustedFolders, CannotBeLeftByAnExperiment) {
  write("secret/arena.sdf", "<sdf version='1.9'><world name='w'></world></sdf>");
  write("world/run.yaml", "world: ../secret/arena.sdf\nduration: 1\nteams: []\n");
  expect_outside("secret");
}

TEST_F(TrustedFolders, IncludeUsualNamesBesideAndAbove) {
  write_rock("meshes/rock.obj", "none.mtl");
  write_arena("../meshes/rock.obj");
  EXPECT_EQ(message(), "");
}

TEST_F(TrustedFolders, IncludeThePackageOfTheFile) {
  write_rock("parts/rock.obj", "none.mtl");
  write_arena("../parts/rock.obj");
  expect_outside("parts");
  write("package.xml", "<package><name>rocks</name></package>");
  EXPECT_EQ(message(), "");
}

TEST_F(TrustedFolders, ExcludePackagesThatContainTheHomeFolder) {
  write_rock("parts/rock.obj", "none.mtl");
  write_arena("../parts/rock.obj");
  write("package.xml", "<package><name>rocks</name></package>");
  const char* const home = std::getenv("HOME");
  const std::string before = home != nullptr ? home : "";
  setenv("HOME", folder_.c_str(), 1);
  expect_outside("parts");
  home != nullptr ? setenv("HOME", before.c_str(), 1) : unsetenv("HOME");
}

}  // namespace
}  // namespace cohort
