// SPDX-License-Identifier: Apache-2.0
#include <csignal>
#include <utility>

#include "tests/view/viewing.hpp"

// A page that drives robots, and adds, drags and removes objects.
namespace cohort::view {
namespace {

using namespace test;

// Robots for people, one that a controller drives, and things.
class Hands : public InABrowser {
 protected:
  void SetUp() override {
    InABrowser::SetUp();
    write_file(scratch / "world.yaml", R"(world:
  name: playground
  gravity: [0, 0, -9.81]
  model:
    - {name: ground, static: true, link: {name: body, collision: {name: floor, geometry: {plane: {normal: [0, 0, 1], size: [9, 9]}}}}}
    - name: lamp_post
      static: true
      pose: [-0.5, 0.6, 0, 0, 0, 0]
      link:
        name: body
        collision: {name: post, pose: [0, 0, 0.15, 0, 0, 0], geometry: {cylinder: {radius: 0.03, length: 0.3}}}
        light: {name: lamp, type: point, pose: [0, 0, 0.3, 0, 0, 0], diffuse: [1, 1, 1, 1], intensity: 1}
  include:
    - {uri: model://sbot, name: people/keys, pose: [-0.6, 0, 0, 0, 0, 0.5]}
    - {uri: model://sbot, name: people/pad, pose: [0.6, 0.8, 0, 0, 0, -1]}
    - {uri: model://sbot, name: others/driven, pose: [-0.6, -0.8, 0, 0, 0, 0]}
    - {uri: model://bar, name: bar, pose: [1, -0.8, 0.05, 0, 0, 0]}
)");
    write_file(scratch / "experiment.yaml", R"(world: world.yaml
duration: 600
teams:
  - {name: people, robots: people/*, controller: keyboard, mode: free}
  - {name: others, robots: others/*, controller: obstacle_avoidance}
)");
  }

  std::vector<std::string> playground() const {
    return {cohort_program(), "run", scratch / "experiment.yaml", "--domain", domain.text()};
  }
  std::vector<std::string> ctl(const std::string& command) const {
    return {cohort_program(), "ctl", "--domain", domain.text(), "--timeout", patience_in_seconds, command};
  }
  nlohmann::json status() const {
    auto command = ctl("status");
    command.emplace_back("--json");
    return nlohmann::json::parse(run_to_end(std::move(command)).out, nullptr, false);
  }
  static bool has_view(const nlohmann::json& now) {
    return std::ranges::any_of(now["controllers"], [](const nlohmann::json& each) {
      return each["label"].get<std::string>().starts_with("view ") && each["alive"].get<bool>();
    });
  }
  // The view has left its robot, and the run went on since it was as `before`.
  void expect_released(const nlohmann::json& before) const {
    nlohmann::json now;
    EXPECT_TRUE(eventually([&] { return !has_view(now = status()); })) << now;
    EXPECT_GT(now["tick"].get<std::uint64_t>(), before["tick"].get<std::uint64_t>());
  }
  void drives(const std::string& scenario) {
    Process run(playground());
    const View view({"--domain", domain.text(), "--control"});
    run_script("hands.mjs", {scenario, view.address()});
    EXPECT_TRUE(run.running()) << run.output();
  }

  ScratchFolder scratch;
  ReservedDomain domain;
};

TEST_F(Hands, DriveARobotByKeysAndSliders) { drives("drives_by_keys"); }
TEST_F(Hands, DriveARobotByAGamePad) { drives("drives_by_pad"); }
TEST_F(Hands, ReleaseTheRobotOfASilentPageToAnotherPage) { drives("drives_alone"); }
TEST_F(Hands, AddDragSwitchAndRemoveObjects) { drives("handles_objects"); }

// A link with the inertia of a solid box.
std::string box_link(const std::string& name, const std::string& pose, const std::string& mass, const std::string& size,
                     const std::string& inertia) {
  return "<link name='" + name + "'><pose>" + pose + "</pose><inertial><mass>" + mass + "</mass><inertia><ixx>" +
         inertia + "</ixx><iyy>" + inertia + "</iyy><izz>" + inertia +
         "</izz></inertia></inertial><collision name='c'><geometry><box><size>" + size +
         "</size></box></geometry></collision></link>";
}

// A chassis on four wheels whose names say nothing, and whose axes point to the left and to the right.
std::string skid_steer() {
  std::string text = box_link("chassis", "0 0 0.15 0 0 0", "4", "0.3 0.2 0.1", "0.05");
  int number = 0;
  for (const char* place : {"0.12 0.15", "0.12 -0.15", "-0.12 0.15", "-0.12 -0.15"}) {
    const std::string name = "w" + std::to_string(number);
    const std::string axis = ++number % 2 == 0 ? "0 -1 0" : "0 1 0";
    text += "<link name='" + name + "'><pose>" + place +
            " 0.08 0 0 0</pose><inertial><mass>0.4</mass><inertia><ixx>0.001</ixx><iyy>0.0013</iyy><izz>0.001</izz>"
            "</inertia></inertial><collision name='c'><pose>0 0 0 1.5707963267948966 0 0</pose><geometry><cylinder>"
            "<radius>0.08</radius><length>0.04</length></cylinder></geometry></collision></link><joint name='" +
            name + "_axle' type='continuous'><parent>chassis</parent><child>" + name + "</child><axis><xyz>" + axis +
            "</xyz></axis></joint><cohort:velocity_motor name='" + name + "'><cohort:joint>" + name +
            "_axle</cohort:joint><cohort:max_velocity>5</cohort:max_velocity><cohort:max_effort>5</cohort:max_effort>"
            "</cohort:velocity_motor>";
  }
  return text;
}

// A chassis on two belts.
std::string on_belts() {
  std::string text = box_link("chassis", "0 0 0.15 0 0 0", "4", "0.3 0.2 0.1", "0.05");
  for (const auto& [name, y] : {std::pair<std::string, std::string>{"p", "-0.15"}, {"q", "0.15"}})
    text += box_link(name, "0 " + y + " 0.05 0 0 0", "1", "0.3 0.06 0.1", "0.01") + "<joint name='" + name +
            "_mount' type='fixed'><parent>chassis</parent><child>" + name + "</child></joint><cohort:belt name='" +
            name + "'><cohort:link>" + name +
            "</cohort:link><cohort:max_velocity>0.4</cohort:max_velocity></cohort:belt>";
  return text;
}

TEST_F(Hands, DriveRobotsWithATwistWheelsOrTracksByArrows) {
  const auto included = [](const std::string& model, int y) {
    return "<include><uri>model://" + model + "</uri><name>people/" + model + "</name><pose>0 " + std::to_string(y) +
           " 0 0 0 0</pose></include>";
  };
  const auto written = [](const std::string& name, const std::string& content, int y) {
    return "<model name='people/" + name + "'><pose>0 " + std::to_string(y) + " 0.001 0 0 0</pose>" + content +
           "</model>";
  };
  write_file(scratch / "world.sdf",
             "<sdf version='1.9' xmlns:cohort='https://cohort-sim.org/sdf/1'><world name='driven'>"
             "<gravity>0 0 -9.81</gravity><model name='ground'><static>true</static><link name='body'>"
             "<collision name='c'><geometry><plane><normal>0 0 1</normal><size>20 20</size></plane></geometry>"
             "</collision></link></model>" +
                 included("turtlebot3", 0) + included("two_wheeler", 2) + written("skid_steer", skid_steer(), 4) +
                 written("on_belts", on_belts(), 6) + "</world></sdf>");
  write_file(scratch / "experiment.yaml",
             "world: world.sdf\nduration: 600\nteams:\n"
             "  - {name: people, robots: people/*, controller: keyboard, mode: free}\n");
  drives("drives_by_arrows");
}

TEST_F(Hands, AreIdleWhereThereIsARecording) {
  run_demo({"--duration", "0.5", "--record", scratch / "run.mcap"});
  const View view({scratch / "run.mcap"});
  run_script("hands.mjs", {"offers_no_hands", view.address()});
}

TEST_F(Hands, ReleaseTheRobotOfAKilledViewAndTheRunContinues) {
  Process run(playground());
  View view({"--domain", domain.text(), "--control"});
  Process script = start_script("hands.mjs", {"drives_on", view.address()});
  ASSERT_TRUE(script.wait_for_output("driving")) << script.output();
  const auto before = status();
  ASSERT_TRUE(has_view(before)) << before;
  view.process().signal(SIGKILL);
  expect_released(before);
  const View another({"--domain", domain.text(), "--control"});
  run_script("hands.mjs", {"drives_by_pad", another.address()});
}

TEST_F(Hands, ReleaseTheRobotOfAKilledBrowser) {
  Process run(playground());
  const View view({"--domain", domain.text(), "--control"});
  Process script = start_script("hands.mjs", {"drives_on", view.address()});
  ASSERT_TRUE(script.wait_for_output("driving")) << script.output();
  const auto before = status();
  ASSERT_TRUE(has_view(before)) << before;
  script.signal(SIGKILL);
  expect_released(before);
}

TEST_F(Hands, AreToldWhenTheServerQuitsAndTheViewStays) {
  Process run(playground());
  View view({"--domain", domain.text(), "--control"});
  Process script = start_script("hands.mjs", {"drives_on", view.address()});
  ASSERT_TRUE(script.wait_for_output("driving")) << script.output();
  EXPECT_EQ(run_to_end(ctl("shutdown")).exit_code, 0);
  EXPECT_EQ(script.wait_for_exit(), 0) << script.output();
  // Either may come first: the robot's run has ended, or no server responds.
  const auto is_told = [&](const char* text) { return script.output().find(text) != std::string::npos; };
  EXPECT_TRUE(is_told("ended: the run is over") || is_told("ended: no server responds to control requests"))
      << script.output();
  EXPECT_TRUE(view.process().running());
  EXPECT_TRUE(run.wait_for_exit().has_value());
}

// The output of `cohort run teleop.yaml --view --control` is enough to drive.
TEST_F(Hands, DriveTheRobotThatARunWaitsFor) {
  Process run({cohort_program(), "run", COHORT_SOURCE_DIR "/worlds/experiments/teleop.yaml", "--view", "--control",
               "--domain", domain.text()});
  ASSERT_TRUE(run.wait_for_output("http://127.0.0.1:")) << run.output();
  ASSERT_TRUE(run.wait_for_output("choose one of its robots in the browser")) << run.output();
  const std::string output = run.output();
  const std::size_t begin = output.find("http://");
  run_script("hands.mjs", {"drives_first", output.substr(begin, output.find('\n', begin) - begin)});
  run.signal(SIGINT);
  EXPECT_EQ(run.wait_for_exit(), 130) << run.output();
}

// `cohort run robot.urdf --view` is enough to move the joints of a model that has no motors.
TEST_F(Hands, MoveTheJointsOfAModelThatIsRunByItself) {
  const test::ScratchFolder folder;
  const std::string file = folder / "bare.urdf";
  const auto link = [](const std::string& name) {
    return "<link name=\"" + name +
           "\"><inertial><mass value=\"1\"/><inertia ixx=\"0.05\" iyy=\"0.05\" izz=\"0.05\" ixy=\"0\" ixz=\"0\" "
           "iyz=\"0\"/></inertial><collision><geometry><box size=\"0.4 0.3 0.1\"/></geometry></collision></link>";
  };
  const auto joint = [](const std::string& name, const std::string& more) {
    return "<joint name=\"" + name + "\" " + more + "<origin xyz=\"0 0 0.3\"/><axis xyz=\"0 0 1\"/></joint>";
  };
  test::write_file(file, "<robot name=\"bare\">" + link("base") + link("upper") + link("tip") +
                             joint("shoulder",
                                   "type=\"revolute\"><parent link=\"base\"/><child link=\"upper\"/><limit "
                                   "lower=\"-1\" upper=\"1\" effort=\"50\" velocity=\"2\"/>") +
                             joint("spin", "type=\"continuous\"><parent link=\"upper\"/><child link=\"tip\"/>") +
                             "</robot>");
  Process run({cohort_program(), "run", file, "--view", "--domain", domain.text()});
  ASSERT_TRUE(run.wait_for_output("http://127.0.0.1:")) << run.output();
  const std::string output = run.output();
  const std::size_t begin = output.find("http://");
  run_script("hands.mjs", {"moves_joints", output.substr(begin, output.find('\n', begin) - begin)});
  EXPECT_EQ(run.wait_for_exit(), 0) << run.output();
}

}  // namespace
}  // namespace cohort::view
