// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <map>

#include "server/recording/run_messages.hpp"
#include "tests/support/every_ros_message.hpp"
#include "tests/support/files.hpp"

/// The package that users of ROS build is of the same messages as what we write.
namespace cohort::test {
namespace {

using recording::ActionTaken, recording::Boundary, recording::Commands, recording::RecordedChannel;
using recording::RecordedEvent, recording::RecordedKind, recording::RecordedMiss, recording::RecordedRobot;
using recording::RecordedSnapshot, recording::Roster, recording::WorldBegins;

using RecordedMessages = std::tuple<WorldBegins, RecordedChannel, RecordedKind, RecordedRobot, Roster, Boundary,
                                    Commands, ActionTaken, RecordedEvent, RecordedMiss, RecordedSnapshot>;

// By the names of their files.
template <class... Message>
std::map<std::string, std::string> texts_of(std::tuple<Message...>) {
  const std::string package = "cohort_msgs/";
  std::map<std::string, std::string> texts;
  for (const messages::RosDefinition& each : {messages::definition<Message>()...}) {
    EXPECT_TRUE(each.name.starts_with(package)) << each.name;
    texts[each.name.substr(package.size()) + ".msg"] = each.text;
  }
  return texts;
}

std::string without_comments(const std::string& text) {
  std::string result;
  for (std::string line : lines_of(text)) {
    line.resize(std::min(line.find('#'), line.size()));
    line.resize(line.find_last_not_of(' ') + 1);
    if (!line.empty()) result += line + "\n";
  }
  return result;
}

TEST(CohortMsgs, HasTheMessagesThatCohortWrites) {
  std::map<std::string, std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(COHORT_SOURCE_DIR "/idl/cohort_msgs/msg"))
    files[entry.path().filename()] = without_comments(read_file(entry.path()));
  EXPECT_EQ(files, texts_of(std::tuple_cat(CohortMessages(), RecordedMessages())));
}

}  // namespace
}  // namespace cohort::test
