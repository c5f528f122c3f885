#include "server/parsing/sdf/sdf_schema.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <sdf/parser.hh>

namespace cohort::description {
namespace {

void add_names(const sdf::ElementPtr& element, std::set<std::string>& names) {
  names.insert(element->GetName());
  for (sdf::ElementPtr child = element->GetFirstElement(); child; child = child->GetNextElement())
    add_names(child, names);
}

std::size_t size_of_definition(const sdf::ElementPtr& element) {
  std::size_t size = 1;
  for (unsigned i = 0; i < element->GetElementDescriptionCount(); ++i)
    size += size_of_definition(element->GetElementDescription(i));
  return size;
}

std::string text_of(const sdf::Param& value) {
  const std::string text = value.GetAsString();
  if (value.GetTypeName() == "bool") return text == "1" ? "true" : text == "0" ? "false" : text;
  return value.GetTypeName() + " " + text;
}

std::string value_of(const sdf::ElementPtr& element) {
  return element->GetValue() ? text_of(*element->GetValue()) : "";
}

// What is read of an element with all definitions is read with those for its document too: what it holds, and by which
// values what it does not hold is replaced.
void expect_same(const sdf::ElementPtr& whole, const sdf::ElementPtr& lean) {
  ASSERT_TRUE(lean) << whole->GetName();
  ASSERT_EQ(lean->GetName(), whole->GetName());
  EXPECT_EQ(value_of(lean), value_of(whole)) << whole->GetName();
  ASSERT_EQ(lean->GetAttributeCount(), whole->GetAttributeCount());
  for (unsigned i = 0; i < whole->GetAttributeCount(); ++i)
    EXPECT_EQ(text_of(*lean->GetAttribute(i)), text_of(*whole->GetAttribute(i))) << whole->GetName();
  ASSERT_EQ(lean->GetElementDescriptionCount(), whole->GetElementDescriptionCount()) << whole->GetName();
  for (unsigned i = 0; i < whole->GetElementDescriptionCount(); ++i) {
    const sdf::ElementPtr expected = whole->GetElementDescription(i);
    const sdf::ElementPtr found = lean->GetElementDescription(i);
    EXPECT_EQ(found->GetName(), expected->GetName());
    EXPECT_EQ(found->GetRequired(), expected->GetRequired());
    EXPECT_EQ(found->GetCopyChildren(), expected->GetCopyChildren());
    EXPECT_EQ(found->ReferenceSDF(), expected->ReferenceSDF());
    EXPECT_EQ(value_of(found), value_of(expected)) << whole->GetName() << "/" << expected->GetName();
  }
  sdf::ElementPtr found = lean->GetFirstElement();
  for (sdf::ElementPtr child = whole->GetFirstElement(); child; child = child->GetNextElement()) {
    expect_same(child, found);
    if (::testing::Test::HasFatalFailure()) return;
    found = found->GetNextElement();
  }
  EXPECT_FALSE(found) << whole->GetName() << " holds more";
}

class DefinitionsForADocument : public ::testing::TestWithParam<const char*> {};

TEST_P(DefinitionsForADocument, AreFewerAndLetItReadTheSame) {
  const std::string text = std::string("<sdf version='1.9'>") + GetParam() + "</sdf>";
  const sdf::SDFPtr whole = parsing::empty_sdf();
  sdf::Errors errors;
  ASSERT_TRUE(sdf::readString(text, sdf::ParserConfig::GlobalConfig(), whole->Root(), errors));
  std::set<std::string> names;
  add_names(whole->Root(), names);
  // As the file has them: what is required and absent is added by libsdformat.
  std::erase_if(names, [&](const std::string& name) { return text.find("<" + name) == std::string::npos; });
  const sdf::SDFPtr lean = parsing::empty_sdf(parsing::sdf_definition_for(names));
  EXPECT_LT(2 * size_of_definition(lean->Root()), size_of_definition(whole->Root()));
  sdf::Errors errors_of_lean;
  ASSERT_TRUE(sdf::readString(text, sdf::ParserConfig::GlobalConfig(), lean->Root(), errors_of_lean));
  EXPECT_EQ(errors_of_lean.size(), errors.size());
  expect_same(whole->Root(), lean->Root());
}

INSTANTIATE_TEST_SUITE_P(
    Sdf, DefinitionsForADocument,
    ::testing::Values(
        "<world name='empty'/>", "<model name='m'><link name='l'/></model>",
        "<model name='m'><link name='l'><collision name='c'><geometry><box/></geometry></collision>"
        "<visual name='v'><geometry><sphere/></geometry><material/></visual></link></model>",
        "<model name='m'><link name='a'/><link name='b'/><joint name='j' type='revolute'><parent>a</parent>"
        "<child>b</child><axis/></joint></model>",
        "<model name='m'><link name='l'><sensor name='s' type='lidar'/><sensor name='t' type='imu'>"
        "<imu/></sensor></link></model>",
        "<world name='w'><light name='l' type='spot'/><model name='m'><model name='n'><link name='l'>"
        "<inertial/></link></model></model></world>"));

}  // namespace
}  // namespace cohort::description
