// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "tests/support/process.hpp"

namespace cohort::test {

/// An experiment with the floating robots `r0` and `r1` in one team, in files that a test can change.
class SmallExperiment {
 public:
  static constexpr double for_ever = 1e6;

  explicit SmallExperiment(const std::string& controller = test_controller("misbehaving"), const std::string& more = "",
                           double duration = for_ever) {
    write_file(folder_ / "world.sdf", world());
    write_file(folder_ / "experiment.yaml",
               "world: world.sdf\nduration: " + std::to_string(duration) +
                   "\nteams:\n  - name: pair\n    robots: all\n    controller: " + controller + "\n" + more);
  }

  std::string file() const { return (folder_ / "experiment.yaml").string(); }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  std::vector<std::string> run(const std::vector<std::string>& arguments = {}) const {
    std::vector<std::string> command = {cohort_program(), "run", file()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return command;
  }

  static std::string world() {
    return R"(<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1">
  <world name="w">
    <gravity>0 0 0</gravity>
    <model name="r0">
      <link name="hull">
        <inertial>
          <mass>2</mass>
          <inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>
        </inertial>
        <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
      </link>
      <link name="top"><inertial><mass>1</mass><inertia/></inertial></link>
      <joint name="hinge" type="revolute">
        <parent>hull</parent><child>top</child><axis><xyz>0 0 1</xyz></axis>
      </joint>
      <cohort:joint_encoder name="angle">
        <cohort:joint>hinge</cohort:joint>
      </cohort:joint_encoder>
    </model>
    <model name="r1">
      <pose>1 0 0 0 0 0</pose>
      <link name="hull"><inertial><mass>1</mass><inertia/></inertial></link>
      <link name="top"><inertial><mass>1</mass><inertia/></inertial></link>
      <joint name="hinge" type="revolute">
        <parent>hull</parent><child>top</child><axis><xyz>0 0 1</xyz></axis>
      </joint>
      <cohort:joint_encoder name="angle"><cohort:joint>hinge</cohort:joint></cohort:joint_encoder>
    </model>
  </world>
</sdf>
)";
  }

 private:
  ScratchFolder folder_;
};

}  // namespace cohort::test
