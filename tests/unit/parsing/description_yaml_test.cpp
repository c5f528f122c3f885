// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "server/core/text.hpp"
#include "server/description/experiment.hpp"
#include "server/description/world.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/parsing/sdf/file_kind.hpp"
#include "server/parsing/sdf/schema/yaml_sdf.hpp"
#include "server/parsing/world/read_world.hpp"
#include "tests/support/worlds/written_worlds.hpp"

namespace cohort::description {
namespace {

// Returns the parts of an element that a round trip preserves: without lines, with sorted attributes and white space as
// single blanks.
std::string canonical(const parsing::XmlNode& node) {
  std::vector<std::pair<std::string, std::string>> attributes = node.attributes;
  std::sort(attributes.begin(), attributes.end());
  std::string text = "<" + node.name;
  for (const auto& [name, value] : attributes) text += " " + name + "='" + value + "'";
  text += ">";
  for (const std::string_view word : words(node.text)) text += std::string(word) + " ";
  for (const parsing::XmlNode& child : node.children) text += canonical(child);
  return text + "</>";
}

parsing::XmlNode from_yaml(const std::string& text) {
  const parsing::YamlDocument document = parsing::parse_yaml(text);
  std::vector<Problem> problems;
  if (!document.root) throw std::runtime_error(document.error->message);
  parsing::XmlNode sdf = parsing::sdf_of_yaml(*document.root, "t.yaml", problems);
  EXPECT_EQ(texts_of(problems), "");
  return sdf;
}

std::string as_xml(const std::string& yaml) { return canonical(from_yaml(yaml)); }

// Returns XML with the prefix of extensions declared.
std::string xml(const std::string& content) {
  return canonical(
      parsing::outline_xml(R"(<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1">)" + content + "</sdf>")
          .root);
}

// ---- From YAML to SDF ----

TEST(YamlWorlds, DistinguishAttributesAndElementsByTheSchema) {
  EXPECT_EQ(as_xml("world:\n"
                   "  name: w\n"
                   "  gravity: [0, 0, -9.81]\n"
                   "  model:\n"
                   "    name: m\n"
                   "    static: true\n"
                   "    joint: {name: j, type: ball, parent: a, child: b}\n"),
            xml("<world name='w'><gravity>0 0 -9.81</gravity><model name='m'><static>true</static>"
                "<joint name='j' type='ball'><parent>a</parent><child>b</child></joint></model></world>"));
}

TEST(YamlWorlds, ReadListsAsRepeatedElementsOrVectors) {
  EXPECT_EQ(as_xml("model: {name: m, link: [{name: a, pose: [1, 2, 3, 0, 0, 0]}, {name: b}]}"),
            xml("<model name='m'><link name='a'><pose>1 2 3 0 0 0</pose></link><link name='b'/></model>"));
  EXPECT_EQ(as_xml("model: {name: m, link: {name: l, collision: {name: c, geometry: {polyline: {height: 1, point: [[0, "
                   "0], [1, 0], [0, 1]]}}}}}"),
            xml("<model name='m'><link name='l'><collision name='c'><geometry><polyline><height>1</height>"
                "<point>0 0</point><point>1 0</point><point>0 1</point></polyline></geometry></collision></link>"
                "</model>"));
}

TEST(YamlWorlds, ReadTheValueOfElementsWithAttributesFromValue) {
  EXPECT_EQ(as_xml("model: {name: m, pose: {relative_to: f, value: [0, 0, 1, 0, 0, 0]}}"),
            xml("<model name='m'><pose relative_to='f'>0 0 1 0 0 0</pose></model>"));
}

TEST(YamlWorlds, ImplyThePrefixInExtensions) {
  const std::string expected =
      xml("<world name='w'><cohort:population name='p'><cohort:uri>model://sbot</cohort:uri><cohort:placement>"
          "<cohort:uniform><cohort:min>0 1</cohort:min></cohort:uniform></cohort:placement></cohort:population>"
          "</world>");
  EXPECT_EQ(as_xml("world:\n  name: w\n  cohort:population: {name: p, uri: 'model://sbot', placement: {uniform: {min: "
                   "[0, 1]}}}\n"),
            expected);
  EXPECT_EQ(as_xml("world:\n  name: w\n  cohort:population: {name: p, cohort:uri: 'model://sbot', cohort:placement: "
                   "{uniform: {cohort:min: 0 1}}}\n"),
            expected);
}

TEST(YamlWorlds, AcceptMissingNamesOfLinksAndCollisions) {
  EXPECT_EQ(as_xml("model: {name: m, link: [{collision: {}}, {visual: [{}, {}]}]}"),
            xml("<model name='m'><link name='link'><collision name='collision'/></link><link name='link_1'>"
                "<visual name='visual'/><visual name='visual_1'/></link></model>"));
}

TEST(YamlWorlds, ResolveAliasesAndMergedMaps) {
  EXPECT_EQ(as_xml("world:\n"
                   "  name: w\n"
                   "  model:\n"
                   "    - &wall {name: a, static: true, pose: [0, 0, 1, 0, 0, 0]}\n"
                   "    - {<<: *wall, name: b}\n"),
            xml("<world name='w'><model name='a'><static>true</static><pose>0 0 1 0 0 0</pose></model><model name='b'>"
                "<static>true</static><pose>0 0 1 0 0 0</pose></model></world>"));
}

TEST(YamlWorlds, AcceptElementsInAnyOrder) {
  EXPECT_EQ(as_xml("world: {name: w, elements: [{model: {name: a}}, {include: {uri: x}}, {model: {name: b}}]}"),
            xml("<world name='w'><model name='a'/><include><uri>x</uri></include><model name='b'/></world>"));
}

TEST(YamlWorlds, ReadInfinityOfYaml) {
  EXPECT_EQ(as_xml("model: {name: m, joint: {name: j, type: revolute, axis: {limit: {lower: -.inf, upper: .inf}}}}"),
            xml("<model name='m'><joint name='j' type='revolute'><axis><limit><lower>-inf</lower><upper>inf</upper>"
                "</limit></axis></joint></model>"));
}

// ---- And back ----

class WrittenAsYaml : public ::testing::TestWithParam<std::string> {};

TEST_P(WrittenAsYaml, IsTheSameAgain) {
  const parsing::XmlOutline outline = parsing::outline_xml(GetParam());
  ASSERT_FALSE(outline.error) << outline.error->message;
  const std::string yaml = parsing::yaml_of_sdf(outline.root);
  EXPECT_EQ(canonical(from_yaml(yaml)), canonical(outline.root)) << yaml;
  EXPECT_EQ(parsing::yaml_of_sdf(from_yaml(yaml)), yaml);
}

std::string sdf(const std::string& content) {
  return R"(<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1">)" + content + "</sdf>";
}

INSTANTIATE_TEST_SUITE_P(
    Sdf, WrittenAsYaml,
    ::testing::Values(
        test::read_file(source / "worlds/arenas/obstacles.sdf"),
        test::read_file(source / "worlds/robots/sbot/model.sdf"), sdf("<world name='w'/>"),
        sdf("<world name='null'><gravity> 0  0\n-1 </gravity></world>"),
        sdf("<world name='it: &quot;is&quot; #1 \\ &#10;[a]'><model name='-'/><model name='a:'/><model "
            "name='größer'/></world>"),
        sdf("<world name='w'><model name='a'/><include><uri>model://x</uri></include><model name='b'/></world>"),
        sdf("<model name='m'><pose relative_to='__model__' degrees='true'>1 0 0 0 0 1e-3</pose></model>"),
        sdf("<model name='m'><plugin name='p' filename='f.so'><a b='1'>x<c/><c d='2'/></a><name>n</name><a/></plugin>"
            "</model>"),
        sdf("<model name='m'><frame name='f' drake:kind='x' xmlns:drake='http://d'/><drake:y "
            "z='1'>t</drake:y></model>"),
        sdf("<model name='m'><cohort:treel_drive name='t'><cohort:left_wheel>a</cohort:left_wheel><cohort:left_wheel>b"
            "</cohort:left_wheel><cohort:link>true</cohort:link></cohort:treel_drive></model>")));

// ---- Worlds ----

class YamlDescription : public Description {
 protected:
  World read_yaml(const std::string& content) const { return parsing::read_world(write("world.yaml", content), 1); }
};

TEST_F(YamlDescription, ReadsTheSameWorldFromXmlAndYaml) {
  const std::string text = test::read_file(source / "worlds/arenas/obstacles.sdf");
  const World from_sdf = parsing::read_world(write("world.sdf", text), 7);
  const World from_yaml =
      parsing::read_world(write("same.yaml", parsing::yaml_of_sdf(parsing::outline_xml(text).root)), 7);
  ASSERT_EQ(from_yaml.instances.size(), from_sdf.instances.size());
  EXPECT_EQ(from_yaml.name, from_sdf.name);
  EXPECT_EQ(from_yaml.gravity, from_sdf.gravity);
  EXPECT_EQ(from_yaml.robots, from_sdf.robots);
  for (std::size_t i = 0; i < from_sdf.instances.size(); ++i) {
    EXPECT_EQ(from_yaml.instances[i].name, from_sdf.instances[i].name);
    EXPECT_EQ(from_yaml.instances[i].X_WM.position, from_sdf.instances[i].X_WM.position);
    EXPECT_EQ(from_yaml.instances[i].X_WM.orientation.coeffs(), from_sdf.instances[i].X_WM.orientation.coeffs());
  }
}

TEST_F(YamlDescription, ReadsTheExamplesOfTheManual) {
  const auto block = [](const std::string& text, const std::string& language) {
    const std::string fence = "```" + language + "\n";
    const std::size_t begin = text.find(fence) + fence.size();
    return text.substr(begin, text.find("```", begin) - begin);
  };
  const std::string readme = test::read_file(source / "worlds/README.md");
  EXPECT_EQ(as_xml(block(readme, "yaml")), canonical(parsing::outline_xml(block(readme, "xml")).root));
  EXPECT_EQ(read_yaml(block(readme, "yaml")).robots.size(), 8u);
  EXPECT_EQ(read_yaml(block(test::read_file(source / "docs/worlds-in-yaml.md"), "yaml")).robots.size(), 8u);
}

TEST_F(YamlDescription, ReadsAnArenaOfTenLines) {
  const World world = read_yaml(
      "world:\n"
      "  name: arena\n"
      "  model:\n"
      "    - {name: ground, static: true, link: {collision: {geometry: {plane: {}}}}}\n"
      "    - {name: wall, static: true, pose: [1, 0, 0, 0, 0, 0], link: {collision: {geometry: {box: {size: [0.1, 2, "
      "1]}}}}}\n"
      "  cohort:population:\n"
      "    name: explorers\n"
      "    uri: model://sbot\n"
      "    count: 5\n"
      "    placement: {uniform: {min: [-1, -1], max: [0.8, 1]}}\n");
  EXPECT_EQ(world.robots.size(), 5u);
  EXPECT_EQ(world.instances.size(), 7u);
}

TEST_F(YamlDescription, DistinguishesExperimentsAndWorldsByContent) {
  EXPECT_EQ(parsing::kind_of_file(write("a.yaml", "world:\n  name: w\n")), parsing::FileKind::sdf);
  EXPECT_EQ(parsing::kind_of_file(write("b.yml", "sdf: {version: 1.9}\n")), parsing::FileKind::sdf);
  EXPECT_EQ(parsing::kind_of_file(write("c.yaml", "model:\n  name: w\n")), parsing::FileKind::sdf);
  EXPECT_EQ(parsing::kind_of_file(write("d.yaml", "world: w.sdf\nduration: 1\n")), parsing::FileKind::experiment);
  EXPECT_EQ(parsing::kind_of_file(write("e.yaml", "[1, 2\n")), parsing::FileKind::experiment);
  EXPECT_EQ(parsing::kind_of_file("w.urdf"), parsing::FileKind::sdf);
}

TEST_F(YamlDescription, AcceptsAWorldInYamlForAnExperiment) {
  write("w.yaml", "world: {name: w, include: {uri: 'model://sbot'}}\n");
  const Experiment experiment = parsing::read_experiment(
      write("e.yaml", "world: w.yaml\nduration: 1\nteams: [{name: t, robots: all, controller: c}]\n"));
  EXPECT_EQ(experiment.world.robots.size(), 1u);
  EXPECT_EQ(parsing::read_experiment(folder_ / "w.yaml").world.robots.size(), experiment.world.robots.size());
}

TEST_F(YamlDescription, ReadsASingleModel) {
  const World world = parsing::read_world_or_model(
      write("m.yaml", "model: {name: m, link: {inertial: {mass: 1, inertia: {ixx: 1}}}}\n"), 1);
  ASSERT_EQ(world.instances.size(), 1u);
  EXPECT_EQ(world.instances[0].name, "m");
}

TEST_F(YamlDescription, ReportsAllProblemsTogether) {
  const auto file = write("world.yaml",
                          "world:\n"
                          "  gravty: [0, 0, -9]\n"
                          "  model:\n"
                          "    - {name: a, static: true, link: {collision: {geometri: {plane: {}}}}}\n"
                          "    - {name: b, name: c}\n"
                          "  cohort:population: {name: p, uri: 'model://sbt'}\n");
  const auto problems = problems_of([&] { parsing::read_world(file, 1); });
  expect_problem(problems, file, {"", 2, "world/gravty", "did you mean 'gravity'?"});
  expect_problem(problems, file, {"", 4, "world/model[a]/link/collision/geometri", "did you mean 'geometry'?"});
  expect_problem(problems, file, {"", 5, "world/model[b]/name", "given twice"});
  expect_problem(problems, file, {"", 6, "world/cohort:population[p]/cohort:count", "missing"});
}

std::string bomb() {
  std::string text = "a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < 10; ++i) {
    const std::string alias = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [";
    for (int j = 0; j < 10; ++j) text += (j == 0 ? "" : ", ") + alias;
    text += "]\n";
  }
  return text;
}

class FlawInYaml : public YamlDescription, public ::testing::WithParamInterface<Flaw> {};

TEST_P(FlawInYaml, IsReportedWithItsLine) { expect_only_flaw(GetParam(), write("world.yaml", GetParam().content)); }

INSTANTIATE_TEST_SUITE_P(
    Worlds, FlawInYaml,
    ::testing::Values(
        Flaw{"", 0, "", "this file is empty"}, Flaw{"hello\n", 1, "", "expected 'world:' or 'model:'"},
        Flaw{"world:\n  name: [a\n", 3, "", "not YAML"}, Flaw{"world:\n  a: b\n c: d\n", 3, "", "not YAML"},
        Flaw{"world:\n  name: w\n---\nworld:\n", 3, "", "unexpected second document"},
        Flaw{"world: {name: w}\nduration: 3\n", 2, "duration", "unknown key; known: version, world"},
        Flaw{"world:\n  physics:\n    type: ode\n    max_step_size: 0.01 s\n", 4, "world/physics/max_step_size",
             "'s' is not a number"},
        Flaw{"world:\n  include: {uri: model://sbot, pose: [0, 0, 0, 1e100, 0, 0]}\n", 2, "world/include[sbot]/pose",
             "expected angles from -1e6 to 1e6 rad"},
        Flaw{"world:\n  gravity: [0, 0]\n", 2, "world/gravity", "cannot have the value '0 0'"},
        Flaw{"world:\n  model: {static: true, link: {}}\n", 2, "world/model", "missing: the attribute 'name'"},
        Flaw{"world:\n  model:\n    name: m\n    static: true\n    link:\n      collision:\n        geometry:\n"
             "          box:\n            size: [1, 1, 0]\n",
             9, "world/model[m]/link[link]/collision[collision]/geometry/box/size", "expected a size > 0 m"},
        Flaw{"world:\n  name: w\n  static: true\n", 3, "world/static", "unknown key"},
        Flaw{"world:\n  model: {name: m, static: true, link: box}\n", 2, "world/model[m]/link",
             "expected 'KEY: VALUE' lines, not 'box'"},
        Flaw{"world:\n  gravity: [[0, 0], [0, 0, 1]]\n", 2, "world/gravity", "cannot have the value '0 0'"},
        Flaw{"world:\n  model:\n    - [1, 2]\n", 3, "world/model", "unexpected nested list"},
        Flaw{"world:\n  ? [a, b]\n  : c\n", 2, "world", "expected the name of an element as a key, not a list"},
        Flaw{"world:\n  a b: 1\n", 2, "world", "'a b' cannot be the name of an element"},
        Flaw{"world:\n  name: {a: 1}\n", 2, "world", "expected a value for 'name', not a map"},
        Flaw{"world:\n  name: \"a\\0b\"\n", 2, "", "a control character"},
        Flaw{"world:\n  gravity: &g [0, *g]\n", 2, "", "refers to a value that contains it"},
        Flaw{"sdf: {version: 1.6, world: {}}\n", 1, "sdf", "expected version 1.9"},
        Flaw{bomb(), 4, "", "expand to more than"}, Flaw{std::string(2000, '['), 1, "", "levels deep"},
        Flaw{"world:\n  include:\n    uri: model://sbt\n", 3, "world/include/uri", "there is no model 'sbt'"},
        Flaw{"world:\n  model: {name: m, static: true, link: {}, cohort:population: {name: p}}\n", 2,
             "world/model[m]/cohort:population", "must be in <world>"},
        Flaw{"world:\n  cohort:physics:\n    fidelity: treel\n    solvr: direct\n", 4,
             "world/cohort:physics/cohort:solvr", "did you mean 'cohort:solver'?"}));

}  // namespace
}  // namespace cohort::description
