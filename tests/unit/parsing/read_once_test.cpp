#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sdf/parser.hh>
#include <string>
#include <string_view>
#include <vector>

#include "server/parsing/files/xml_outline.hpp"
#include "server/parsing/sdf/repair/older_sdf.hpp"
#include "server/parsing/sdf/schema/build_elements.hpp"
#include "server/parsing/sdf/schema/libsdformat_scope.hpp"

/// Tests that a file is read once, into a tree, and that the elements of the tree equal those that libsdformat makes of
/// the text.
namespace cohort::description {
namespace {

namespace fs = std::filesystem;

std::string place_of(const sdf::ElementPtr& element) {
  return element->GetParent() ? place_of(element->GetParent()) + "/" + element->GetName() : element->GetName();
}

std::string text_of(const sdf::ParamPtr& value) {
  if (!value) return "";
  std::string text = value->GetAsString();
  if (value->GetTypeName() == "bool" && text == "0") text = "false";
  return value->GetTypeName() + " " + text + (value->GetSet() ? "" : " by default");
}

void expect_same_definitions(const sdf::ElementPtr& expected, const sdf::ElementPtr& found) {
  ASSERT_EQ(found->GetElementDescriptionCount(), expected->GetElementDescriptionCount()) << place_of(expected);
  for (unsigned i = 0; i < expected->GetElementDescriptionCount(); ++i) {
    const sdf::ElementPtr one = expected->GetElementDescription(i);
    const sdf::ElementPtr other = found->GetElementDescription(i);
    EXPECT_EQ(other->GetName(), one->GetName()) << place_of(expected);
    EXPECT_EQ(other->GetRequired(), one->GetRequired()) << place_of(expected);
    EXPECT_EQ(text_of(other->GetValue()), text_of(one->GetValue())) << place_of(expected);
  }
}

void expect_same(const sdf::ElementPtr& expected, const sdf::ElementPtr& found) {
  ASSERT_TRUE(found) << place_of(expected);
  ASSERT_EQ(place_of(found), place_of(expected));
  EXPECT_EQ(found->GetExplicitlySetInFile(), expected->GetExplicitlySetInFile()) << place_of(expected);
  EXPECT_EQ(found->GetCopyChildren(), expected->GetCopyChildren()) << place_of(expected);
  EXPECT_EQ(found->OriginalVersion(), expected->OriginalVersion()) << place_of(expected);
  EXPECT_EQ(text_of(found->GetValue()), text_of(expected->GetValue())) << place_of(expected);
  ASSERT_EQ(found->GetAttributeCount(), expected->GetAttributeCount()) << place_of(expected);
  for (unsigned i = 0; i < expected->GetAttributeCount(); ++i) {
    EXPECT_EQ(found->GetAttribute(i)->GetKey(), expected->GetAttribute(i)->GetKey()) << place_of(expected);
    EXPECT_EQ(text_of(found->GetAttribute(i)), text_of(expected->GetAttribute(i))) << place_of(expected);
  }
  expect_same_definitions(expected, found);
  sdf::ElementPtr next = found->GetFirstElement();
  for (sdf::ElementPtr child = expected->GetFirstElement(); child; child = child->GetNextElement()) {
    expect_same(child, next);
    if (::testing::Test::HasFatalFailure()) return;
    next = next->GetNextElement();
  }
  EXPECT_FALSE(next) << place_of(expected) << " holds more";
}

void expect_same_errors(const sdf::Errors& expected, const sdf::Errors& found) {
  const auto text = [](const sdf::Error& error) {
    std::string message = error.Message();
    if (const std::size_t rest = message.find(" Copying["); rest != std::string::npos) message.resize(rest);
    return std::to_string(static_cast<int>(error.Code())) + " " + error.XmlPath().value_or("") + " " + message;
  };
  for (std::size_t i = 0; i < std::min(expected.size(), found.size()); ++i)
    EXPECT_EQ(text(found[i]), text(expected[i]));
  EXPECT_GE(found.size() + 1, expected.size());  // libsdformat's last one says that there are some
}

// Compares the elements that libsdformat reads from the text with those that are made from its tree.
void expect_that_both_read_the_same(const std::string& text) {
  parsing::LibsdformatScope libsdformat;
  sdf::Errors errors;
  const sdf::SDFPtr by_libsdformat = std::make_shared<sdf::SDF>();
  sdf::init(by_libsdformat);
  const bool is_read = sdf::readString(text, libsdformat.config(), by_libsdformat->Root(), errors);

  parsing::XmlNode tree = parsing::outline_xml(text).root;
  const std::string version = *tree.attribute("version");
  parsing::convert_older(tree);
  std::vector<const parsing::XmlNode*> nodes;
  sdf::Errors errors_of_tree;
  const sdf::SDFPtr made = parsing::ElementBuilder().build(tree, version, "", nodes, errors_of_tree);
  ASSERT_EQ(made != nullptr, is_read);
  expect_same_errors(errors, errors_of_tree);
  if (made) expect_same(by_libsdformat->Root(), made->Root());
}

class Document : public ::testing::TestWithParam<std::string> {};

TEST_P(Document, GivesTheSameElementsAsItsText) { expect_that_both_read_the_same(GetParam()); }

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
                      in_sdf("<model name='m'><link name='a::b'/></model>"),
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
// scoped names.
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
    constexpr std::string_view others[] = {"<include", "::", "ISO-8859"};
    if (std::ranges::none_of(others, [&](auto other) { return text.find(other) != std::string::npos; }))
      texts.push_back(std::move(text));
  }
  return texts;
}

INSTANTIATE_TEST_SUITE_P(OfTheCorpus, Document,
                         ::testing::ValuesIn(texts_in(COHORT_SOURCE_DIR "/tests/data/corpus/valid")));
INSTANTIATE_TEST_SUITE_P(OfOurs, Document, ::testing::ValuesIn(texts_in(COHORT_SOURCE_DIR "/worlds")));

// Only URDF text goes to libsdformat, since its converter does not accept a tree.
TEST(ReadOnce, PassesTextOnlyToTheUrdfConverter) {
  const std::vector<std::string> readers = {"readString", "readFile", "convertString", "convertFile", "xml_text_of("};
  std::vector<std::string> found;
  for (const auto& entry : fs::recursive_directory_iterator(COHORT_SOURCE_DIR "/server")) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
    std::ifstream stream(entry.path());
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (const std::string& reader : readers)
      for (std::size_t at = text.find(reader); at != std::string::npos; at = text.find(reader, at + 1))
        found.push_back(entry.path().filename().string() + " " + reader);
  }
  std::ranges::sort(found);
  EXPECT_EQ(found, (std::vector<std::string>{"urdf_file.cpp readString", "urdf_file.cpp xml_text_of(",
                                             "xml_outline.cpp xml_text_of(", "xml_outline.hpp xml_text_of("}));
}

}  // namespace
}  // namespace cohort::description
