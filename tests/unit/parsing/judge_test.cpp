// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <sdf/Frame.hh>
#include <sdf/Joint.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/ParserConfig.hh>
#include <sdf/Root.hh>
#include <sdf/World.hh>
#include <string>
#include <string_view>
#include <vector>

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/check_tree.hpp"
#include "server/parsing/sdf/element.hpp"
#include "server/parsing/sdf/frames.hpp"
#include "server/parsing/sdf/repair/older_sdf.hpp"

/// Compares what Cohort reads in SDF with what libsdformat reads, where that is installed.
namespace cohort::description {
namespace {

namespace fs = std::filesystem;

Eigen::Vector3d eigen(const ignition::math::Vector3d& v) { return {v.X(), v.Y(), v.Z()}; }

std::string place_of(const sdf::ElementPtr& element) {
  return element->GetParent() ? place_of(element->GetParent()) + "/" + element->GetName() : element->GetName();
}

// Every element that is written, with its value and attributes. Libsdformat puts those that it does not know last.
void expect_same(const sdf::ElementPtr& expected, const parsing::Element& found) {
  EXPECT_EQ(found.name(), expected->GetName()) << place_of(expected);
  const sdf::ParamPtr value = expected->GetValue();
  const std::string type = value ? value->GetTypeName() : "";
  // Limits of joints have other standard values in newer versions, with the same meaning.
  const bool is_alike = expected->GetParent() == nullptr || expected->GetParent()->GetName() != "limit";
  if (type == "bool") {
    EXPECT_EQ(found.flag(), expected->Get<bool>()) << place_of(expected);
  } else if (type == "double" && is_alike) {
    EXPECT_EQ(found.real(), expected->Get<double>()) << place_of(expected);
  } else if (type == "vector3") {
    EXPECT_EQ(found.vector(), eigen(expected->Get<ignition::math::Vector3d>())) << place_of(expected);
  } else if (value && value->GetSet()) {
    EXPECT_EQ(found.text(), value->GetAsString()) << place_of(expected);
  }
  for (const sdf::ParamPtr& attribute : expected->GetAttributes()) {
    if (!attribute->GetSet() || attribute->GetKey() == "version") continue;
    EXPECT_EQ(found.attribute(attribute->GetKey()), attribute->GetAsString()) << place_of(expected);
  }
  std::map<std::string, std::vector<sdf::ElementPtr>> of_name;
  for (sdf::ElementPtr child = expected->GetFirstElement(); child; child = child->GetNextElement())
    if (child->GetExplicitlySetInFile()) of_name[child->GetName()].push_back(child);
  std::size_t count = 0;
  for (const auto& [name, children] : of_name) {
    const std::vector<const parsing::Element*> own = parsing::children_of(found, name);
    if (own.empty() && !children.front()->LineNumber()) continue;  // added by libsdformat
    ASSERT_EQ(own.size(), children.size()) << place_of(expected) << "/" << name;
    for (std::size_t i = 0; i < children.size(); ++i) expect_same(children[i], *own[i]);
    count += own.size();
  }
  EXPECT_EQ(found.children().size(), count) << place_of(expected);
}

void expect_same_pose(const sdf::SemanticPose& expected, const std::optional<Pose>& found, const std::string& in) {
  constexpr double rounding = 1e-14;
  ignition::math::Pose3d X;
  ASSERT_TRUE(expected.Resolve(X, in).empty());
  ASSERT_TRUE(found);
  const Eigen::Quaterniond turn(X.Rot().W(), X.Rot().X(), X.Rot().Y(), X.Rot().Z());
  EXPECT_LT((found->position - eigen(X.Pos())).norm(), rounding * (1.0 + found->position.norm()));
  EXPECT_LT(found->orientation.angularDistance(turn.normalized()), 1e-7);  // its square is a rounding error
}

// The frames of a model and the links of its joints.
void expect_same_frames(const sdf::Model& expected, const parsing::Frames& found) {
  const auto compare = [&](const auto& part) {
    SCOPED_TRACE(part.Name());
    expect_same_pose(part.SemanticPose(), found.pose_of(part.Name()), "__model__");
  };
  for (std::uint64_t i = 0; i < expected.LinkCount(); ++i) compare(*expected.LinkByIndex(i));
  for (std::uint64_t i = 0; i < expected.FrameCount(); ++i) compare(*expected.FrameByIndex(i));
  for (std::uint64_t i = 0; i < expected.JointCount(); ++i) {
    const sdf::Joint& joint = *expected.JointByIndex(i);
    compare(joint);
    std::string link;
    ASSERT_TRUE(joint.ResolveChildLink(link).empty());
    EXPECT_EQ(found.link_of(joint.ChildLinkName()), link);
  }
  for (std::uint64_t i = 0; i < expected.ModelCount(); ++i) {
    const sdf::Model& inner = *expected.ModelByIndex(i);
    compare(inner);
    expect_same_frames(inner, *found.of(*parsing::children_of(found.owner(), "model").at(i)));
  }
}

sdf::ParserConfig strict() {
  sdf::ParserConfig config;
  config.SetWarningsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetUnrecognizedElementsPolicy(sdf::EnforcementPolicy::ERR);
  config.SetDeprecatedElementsPolicy(sdf::EnforcementPolicy::LOG);
  return config;
}

// Compares what libsdformat and Cohort make of a text: whether it is right, and if so, elements and frames.
void expect_that_both_read_the_same(const std::string& text) {
  sdf::Root root;
  const sdf::Errors errors = root.LoadSdfString(text, strict());

  const parsing::SourceFile file{"/file.sdf", "file.sdf"};
  parsing::XmlNode tree = parsing::outline_xml(text).root;
  const auto set_file = [&](parsing::XmlNode& node, const auto& self) -> void {
    node.file = &file;
    for (parsing::XmlNode& child : node.children) self(child, self);
  };
  set_file(tree, set_file);
  parsing::convert_older(tree);
  std::vector<Problem> problems = parsing::check_tree(tree);
  const parsing::ElementTree elements(tree);
  std::vector<parsing::Frames::Flaw> flaws;
  for (const char* const kind : {"world", "model"})
    if (const parsing::Element* const owner = elements.root().child(kind))
      std::ranges::move(parsing::Frames(*owner).flaws(), std::back_inserter(flaws));
  EXPECT_EQ(problems.empty() && flaws.empty(), errors.empty())
      << (errors.empty() ? "" : errors.front().Message()) << (problems.empty() ? "" : problems.front().text())
      << (flaws.empty() ? "" : flaws.front().second);
  if (!errors.empty() || ::testing::Test::HasFailure()) return;
  expect_same(root.Element(), elements.root());
  if (const sdf::Model* const model = root.Model())
    expect_same_frames(*model, parsing::Frames(*elements.root().child("model")));
  if (root.WorldCount() == 0) return;
  const parsing::Frames world(*elements.root().child("world"));
  const sdf::World& expected = *root.WorldByIndex(0);
  for (std::uint64_t i = 0; i < expected.ModelCount(); ++i) {
    const sdf::Model& model = *expected.ModelByIndex(i);
    expect_same_pose(model.SemanticPose(), world.pose_of(model.Name()), "");
    expect_same_frames(model, *world.of(*parsing::children_of(world.owner(), "model").at(i)));
  }
}

class Document : public ::testing::TestWithParam<std::string> {};

TEST_P(Document, MeansTheSameAsInLibsdformat) { expect_that_both_read_the_same(GetParam()); }

std::string in_sdf(const std::string& content) { return "<sdf version='1.9'>" + content + "</sdf>"; }

INSTANTIATE_TEST_SUITE_P(
    OfTheNewestVersion, Document,
    ::testing::Values(
        in_sdf("<world name='empty'/>"), in_sdf("<model name='m'><link name='l'/></model>"),
        in_sdf("<model name='m'><link name='l'><collision name='c'><geometry><box/></geometry></collision>"
               "<visual name='v'><geometry><sphere><radius> 2 </radius></sphere></geometry><material/></visual></link>"
               "<pose relative_to=''>1  2\n3 0 0 0</pose></model>"),
        in_sdf("<model name='m'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent>a</parent>"
               "<child>b</child><axis/></joint><joint name='k' type='ball'><parent>a</parent></joint></model>"),
        in_sdf("<model name='m'><link name='l'><sensor name='s' type='lidar'/><sensor name='t' type='imu'>"
               "<imu/></sensor></link></model>"),
        in_sdf("<world name='w'><light name='l' type='spot'/><model name='m'><model name='n'><link name='l'>"
               "<inertial/></link><model name='o'><static>1</static></model></model></model></world>"),
        in_sdf("<model name='m' xmlns:x='y' x:z='1'><x:a b='c'>d  e<f>g</f></x:a><link name='l'><x:h/></link>"
               "<plugin name='p' filename='q'><pose>r</pose><s t='u'/></plugin></model>")));

INSTANTIATE_TEST_SUITE_P(
    WithMistakes, Document,
    ::testing::Values(in_sdf("<model name='m'><link name='l'><mass>1</mass></link></model>"),
                      in_sdf("<model name='m' nmae='n'><link/></model>"),
                      in_sdf("<model name='m'><link name='l'><gravity>perhaps</gravity></link></model>"),
                      in_sdf("<model name='m'><static/><pose>1 2</pose></model>"),
                      in_sdf("<model name='m'><pose relative_to='n'/></model>"),
                      in_sdf("<model name='m'><frame name='f' attached_to='__root__'/></model>"),
                      in_sdf("<model name='m'><joint name='j' type='fixed'><parent>p</parent></joint></model>"),
                      in_sdf("<world name='w'><gravity>1 x 3</gravity></world>")));

INSTANTIATE_TEST_SUITE_P(
    OfAnOlderVersion, Document,
    ::testing::Values(
        "<sdf version='1.8'><model name='m'><link name='l'/></model></sdf>",
        "<sdf version='1.7'><model name='m'><link name='l'><inertial><pose relative_to=''>1 0 0 0 0 0</pose></inertial>"
        "</link></model></sdf>",
        "<sdf version='1.6'><world name='w'><model name='m'><link name='a'><pose frame=''>1 0 0 0 0 0</pose></link>"
        "<link name='b'/><joint name='j' type='revolute'><pose frame='a'/><parent>a</parent><child>b</child><axis><xyz>"
        "0 0 1</xyz><use_parent_model_frame>true</use_parent_model_frame></axis></joint><plugin name='p' filename='f'>"
        "<pose frame='kept'/></plugin></model></world></sdf>",
        "<sdf version='1.5'><world name='w'><physics type='ode'><gravity>0 0 -1</gravity><max_step_size>0.1"
        "</max_step_size></physics><model name='m'><link name='l'><sensor name='s' type='imu'><imu><noise><type>"
        "gaussian</type><rate><mean>1</mean><stddev>2</stddev><bias_mean>3</bias_mean></rate><accel><mean>4</mean>"
        "<bias_stddev>5</bias_stddev></accel></noise></imu></sensor></link></model></world></sdf>",
        "<sdf version='1.4'><model name='m'><link name='a'/><link name='b'/><joint name='j' type='revolute2'><parent>a"
        "</parent><child>b</child><axis><xyz>1 0 0</xyz></axis><axis2><xyz>0 1 0</xyz></axis2></joint></model></sdf>",
        "<sdf version='1.3'><world name='w'><physics type='ode'><update_rate>50</update_rate><ode><solver><dt>0.02</dt>"
        "</solver></ode></physics></world></sdf>",
        "<sdf version='1.2'><model name='m'><link name='l'/></model></sdf>",
        "<sdf version='1.0'><model name='m' static='true'><origin pose='1 2 3 0 0 0'/><link name='a'><origin pose='0 0 "
        "1 0 0 0'/><inertial mass='2'><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial><collision "
        "name='c'><geometry><box size='1 2 3'/></geometry></collision></link><link name='b'/><joint name='j' "
        "type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 1'><limit lower='-1' upper='1'/></axis>"
        "</joint></model></sdf>"));

// Returns the texts that libsdformat can read alone: valid XML in UTF-8, of a known version, without includes and
// scoped names. Cameras are left out, since their field of view has other bounds in newer versions. Also left out are
// elements that this version of the library does not know, and a time of one number, which it refuses.
std::vector<std::string> texts_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".sdf") files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    std::ifstream stream(file);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    const parsing::XmlOutline outline = parsing::outline_xml(text);
    const std::string* const version = outline.root.attribute("version");
    if (outline.error || outline.root.name != "sdf" || version == nullptr || version->starts_with("1.1") ||
        text.find("<!--") < text.find("<sdf"))
      continue;
    constexpr std::string_view others[] = {
        "<include", "::", "ISO-8859", "<camera>", "auto=\"true\"", "<sim_time>0</sim_time>"};
    if (std::ranges::none_of(others, [&](auto other) { return text.find(other) != std::string::npos; }))
      texts.push_back(std::move(text));
  }
  return texts;
}

INSTANTIATE_TEST_SUITE_P(OfTheCorpus, Document,
                         ::testing::ValuesIn(texts_in(COHORT_SOURCE_DIR "/tests/data/corpus/valid")));
INSTANTIATE_TEST_SUITE_P(OfOurs, Document, ::testing::ValuesIn(texts_in(COHORT_SOURCE_DIR "/worlds")));

}  // namespace
}  // namespace cohort::description
