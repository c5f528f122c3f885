// SPDX-License-Identifier: Apache-2.0
#include "idl/messages/parse_schema.hpp"

#include <gtest/gtest.h>

#include "idl/messages/ros_type_hash.hpp"
#include "tests/support/every_ros_message.hpp"

namespace cohort::messages {
namespace {

template <class... Message>
void expect_same_hashes(std::tuple<Message...>) {
  const auto expect_same = []<class One>(One) {
    EXPECT_EQ(type_hash(parse_schema(One::type, schema_text(definition<One>()))), type_hash<One>()) << One::type;
  };
  (expect_same(Message()), ...);
}

TEST(ParseSchema, ReturnsTheHashOfEachMessageThatWeWrite) {
  expect_same_hashes(test::StandardMessages());
  expect_same_hashes(test::CohortMessages());
}

TEST(ParseSchema, LeavesOutCommentsConstantsAndDefaultValues) {
  const std::string text =
      "# What it is.\n\nint8 LEFT=1 # a constant\nint8 RIGHT = 2\nint8 side 1  # a default\n"
      "string<=10[<=3] names\nOther[2] others\nstd_msgs/Bool flag\n" +
      std::string(80, '=') + "\nMSG: made_up/Other\nfloat64 x 0.5\n" + std::string(80, '=') +
      "\nMSG: std_msgs/Bool\r\nbool data\r\n";
  const RosDefinition found = parse_schema("made_up/msg/Message", text);
  ASSERT_EQ(found.fields.size(), 4U);
  EXPECT_EQ(found.name, "made_up/Message");
  EXPECT_EQ(found.fields[0].name, "side");
  EXPECT_EQ(found.fields[1].type.id, RosFieldType::bounded_string + RosFieldType::bounded_sequence);
  EXPECT_EQ(found.fields[1].type.string_capacity, 10U);
  EXPECT_EQ(found.fields[1].type.capacity, 3U);
  EXPECT_EQ(found.fields[2].type.nested_type, "made_up/msg/Other");
  EXPECT_EQ(found.fields[2].type.id, RosFieldType::nested + RosFieldType::array);
  EXPECT_EQ(found.fields[3].type.nested_type, "std_msgs/msg/Bool");
  ASSERT_EQ(found.parts.size(), 2U);
  EXPECT_EQ(found.parts[1].fields.at(0).name, "data");
}

std::string error_of(const std::string& text, const std::string& type = "made_up/msg/Message") {
  try {
    parse_schema(type, text);
  } catch (const SchemaError& error) {
    return error.what();
  }
  return "";
}

TEST(ParseSchema, SaysWhatIsWrong) {
  EXPECT_EQ(error_of("float64\n"), "'float64' has no field name");
  EXPECT_EQ(error_of("float64[x] a\n"), "'x' is not a length");
  EXPECT_EQ(error_of("float64[3 a\n"), "'float64[3' has no closing ']'");
  EXPECT_EQ(error_of("Other a\n"), "the schema of made_up/msg/Message does not define made_up/msg/Other");
  EXPECT_EQ(error_of("wstring a\n"), "fields of the type wstring are not supported");
  EXPECT_EQ(error_of("float64 a-b\n"), "'a-b' is not a field name");
  EXPECT_EQ(error_of("", "Message"), "'Message' is not a type name");
}

}  // namespace
}  // namespace cohort::messages
