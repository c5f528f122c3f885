// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "idl/messages/ros_type_hash.hpp"
#include "tests/support/any_message.hpp"
#include "tests/support/every_ros_message.hpp"
#include "tests/support/process.hpp"

/// Our messages as a reader has them that is not ours: rosbags, by the definitions of the distributions of ROS 2.
namespace cohort::test {
namespace {

#ifdef COHORT_ROSBAGS_PYTHON

using messages::RosDefinition;
using nlohmann::json;

// Each message several times, with any values.
template <class... Message>
json written(std::tuple<Message...>) {
  AnyMessage any;
  json all = json::array();
  const auto write = [&]<class One>(One message) {
    const RosDefinition definition = messages::definition<One>();
    json samples = json::array();
    for (int i = 0; i < 5; ++i) {
      any.fill(message);
      std::string hex;
      for (const std::byte byte : messages::encode(message)) {
        constexpr const char* digits = "0123456789abcdef";
        hex += digits[std::to_integer<unsigned>(byte) >> 4];
        hex += digits[std::to_integer<unsigned>(byte) & 15];
      }
      samples.push_back(hex);
    }
    all.push_back({{"type", One::type},
                   {"schema", messages::schema_text(definition)},
                   {"hash", messages::type_hash(definition)},
                   {"samples", samples}});
  };
  (write(Message()), ...);
  return all;
}

// With the definitions of a distribution, or with our schemas if it is `ours`.
void expect_read(const json& messages, const std::string& distribution) {
  const ScratchFolder scratch;
  write_file(scratch / "messages.json", messages.dump());
  const Ended reader = run_to_end({COHORT_ROSBAGS_PYTHON, COHORT_SOURCE_DIR "/tests/ros2/read_messages.py",
                                   distribution, scratch / "messages.json"});
  EXPECT_EQ(reader.exit_code, 0) << reader.err;
  EXPECT_EQ(reader.out, std::to_string(messages.size()) + " types\n") << reader.err;
}

class RosDistribution : public testing::TestWithParam<std::string> {};

TEST_P(RosDistribution, ReadsOurMessagesByItsOwnDefinitionsAndHasTheirHashes) {
  json messages = written(StandardMessages());
  const bool is_humble = GetParam() == "humble";
  // There a Range ends before its variance, which readers leave where it is.
  if (is_humble)
    std::erase_if(messages.get_ref<json::array_t&>(),
                  [](const json& each) { return each["type"] == ros::Range::type; });
  messages.push_back(is_humble ? written(std::tuple<ros::HumbleParticipantEntitiesInfo>())[0]
                               : written(std::tuple<ros::ParticipantEntitiesInfo>())[0]);
  // ROS hashes its `char` as uint8, which this reader does not know: RosTypeHash has the hash of ROS.
  messages.back()["hash"] = nullptr;
  expect_read(messages, GetParam());
}

INSTANTIATE_TEST_SUITE_P(Each, RosDistribution, testing::Values("humble", "jazzy", "kilted", "lyrical"),
                         [](const auto& each) { return each.param; });

TEST(RosMessages, OfCohortAndOfSimulatorsAreReadByOurSchemas) {
  expect_read(written(std::tuple_cat(CohortMessages(), SimulationMessages())), "ours");
}

// That the reader is no rubber stamp: a byte more, a type whose fields have another order, another hash.
TEST(RosMessages, ThatDifferAreFound) {
  const json good = written(std::tuple<ros::Range>());
  const auto error_of = [](const json& messages) {
    const ScratchFolder scratch;
    write_file(scratch / "messages.json", messages.dump());
    const Ended reader = run_to_end(
        {COHORT_ROSBAGS_PYTHON, COHORT_SOURCE_DIR "/tests/ros2/read_messages.py", "jazzy", scratch / "messages.json"});
    return reader.exit_code == 0 ? "" : reader.err;
  };
  EXPECT_EQ(error_of(good), "");
  json longer = good;
  longer[0]["samples"][2] = longer[0]["samples"][2].get<std::string>() + "00";
  EXPECT_NE(error_of(longer), "");
  json other_type = good;
  other_type[0]["type"] = "sensor_msgs/msg/Temperature";
  EXPECT_NE(error_of(other_type), "");
  json other_hash = good;
  other_hash[0]["hash"] = messages::type_hash<ros::Imu>();
  EXPECT_NE(error_of(other_hash), "");
}

#else

TEST(RosMessages, AreReadByTheDefinitionsOfDistributions) {
  GTEST_SKIP() << "no environment of tools/dev/python-environment --rosbags (COHORT_ROSBAGS_PYTHON)";
}

#endif

}  // namespace
}  // namespace cohort::test
