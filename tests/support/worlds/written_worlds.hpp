// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "server/description/input_error.hpp"
#include "server/description/world.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tests/support/files.hpp"

/// Helpers for tests of descriptions: worlds written by the tests, and the errors that must be reported for them.
namespace cohort::description {

inline const std::filesystem::path source = COHORT_SOURCE_DIR;

/// A fixture with a scratch folder that contains the s-bot, so that model://sbot is found.
class Description : public ::testing::Test {
 protected:
  Description() {
    std::filesystem::create_directories(folder_ / "robots");
    std::filesystem::copy(source / "worlds/robots/sbot", folder_ / "robots/sbot");
  }

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    test::write_file(folder_ / name, text);
    return folder_ / name;
  }
  /// The content of <world> starts on line 2.
  std::filesystem::path write_world(const std::string& content) const {
    return write("world.sdf", R"(<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1"><world name="w">)"
                              "\n" +
                                  content + "\n</world></sdf>\n");
  }
  /// The content of <model> starts on line 2.
  void write_model(const std::string& name, const std::string& content) const {
    write("robots/" + name + "/model.config",
          "<model><name>" + name + "</name><sdf version=\"1.9\">model.sdf</sdf></model>");
    write("robots/" + name + "/model.sdf",
          R"(<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1"><model name=")" + name + "\">\n" + content +
              "\n</model></sdf>\n");
  }
  World read(const std::string& content) const { return parsing::read_world(write_world(content), 1); }

  test::ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_.path();
};

/// Returns the problems that `read` reports.
template <class Read>
std::vector<Problem> problems_of(Read&& read) {
  try {
    read();
  } catch (const InputError& error) {
    return error.problems();
  }
  return {};
}

/// Returns links with these one-letter names, with mass and inertia.
inline std::string links(const std::string& names) {
  std::string text;
  for (const char name : names)
    text += "<link name=\"" + std::string(1, name) + "\"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy>" +
            "<izz>1</izz><ixy>0</ixy><ixz>0</ixz><iyz>0</iyz></inertia></inertial></link>";
  return text;
}
inline std::string joint(const std::string& name, const std::string& parent, const std::string& child,
                         const std::string& axis = "<xyz>0 0 1</xyz>", const std::string& type = "revolute") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent>" + parent + "</parent><child>" + child +
         "</child><axis>" + axis + "</axis></joint>";
}
inline std::string collision(const std::string& geometry, const std::string& surface = "") {
  return "<link name=\"l\"><collision name=\"c\"><geometry>" + geometry + "</geometry>" + surface +
         "</collision></link>";
}
inline std::string static_model_sdf(const std::string& content, const std::string& name = "m") {
  return "<model name=\"" + name + "\"><static>true</static>" + content + "</model>";
}

/// Invalid content, and the problem that must be reported.
struct Flaw {
  std::string content;
  int line;
  std::string element;
  std::string message;  // part of it
};
inline void PrintTo(const Flaw& flaw, std::ostream* out) { *out << flaw.element << ": " << flaw.message; }

inline void expect_problem(const std::vector<Problem>& problems, const std::filesystem::path& file, const Flaw& flaw) {
  std::string all;
  for (const Problem& problem : problems) all += problem.text() + "\n";
  const bool found = std::any_of(problems.begin(), problems.end(), [&](const Problem& problem) {
    return problem.file == file && problem.line == flaw.line && problem.element == flaw.element &&
           problem.message.find(flaw.message) != std::string::npos;
  });
  EXPECT_TRUE(found) << "expected " << flaw.line << ": " << flaw.element << ": " << flaw.message << "\ngot\n" << all;
}

/// Checks that reading this world file reports this problem and no other.
inline void expect_only_flaw(const Flaw& flaw, const std::filesystem::path& world) {
  const std::vector<Problem> problems = problems_of([&] { parsing::read_world(world, 1); });
  expect_problem(problems, world, flaw);
  EXPECT_EQ(problems.size(), 1u);
}

inline std::string texts_of(const std::vector<Problem>& problems) {
  std::string texts;
  for (const Problem& problem : problems) texts += problem.text() + "\n";
  return texts;
}

}  // namespace cohort::description
