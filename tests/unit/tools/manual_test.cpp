#include "tools/cohort/commands/manual.hpp"

#include <gtest/gtest.h>

#include "server/parsing/keys/experiment_keys.hpp"

namespace cohort::tool {
namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(Manual, HasEveryKeyOfEveryEntryUnderItsNameAndItsGroup) {
  const auto check = [](const parsing::Extension& entry) {
    for (const std::string& topic : {std::string(entry.name), std::string(entry.topic)}) {
      const auto text = manual_of(topic);
      ASSERT_TRUE(text) << topic;
      for (const parsing::ExtensionKey& key : entry.keys)
        EXPECT_TRUE(has(*text, "    " + std::string(key.name) + " ")) << topic << " lacks " << key.name;
    }
    EXPECT_TRUE(has(manual_contents(), std::string(entry.name))) << entry.name;
  };
  for (const auto& entry : parsing::extensions()) check(entry);
  for (const auto& entry : parsing::experiment_parts()) check(entry);
}

TEST(Manual, FindsAThingByAPartOfItsName) {
  const auto text = manual_of("proximity");
  ASSERT_TRUE(text);
  EXPECT_TRUE(has(*text, "<cohort:proximity_ring name=\"…\"> in <model>")) << *text;
  EXPECT_TRUE(has(*text, "standard deviation of the Gaussian noise")) << *text;
}

TEST(Manual, GroupsSensorsAndActuators) {
  EXPECT_TRUE(has(*manual_of("sensors"), "treel_encoder"));
  EXPECT_FALSE(has(*manual_of("sensors"), "velocity_motor name"));
  EXPECT_TRUE(has(*manual_of("actuators"), "velocity_motor name"));
}

TEST(Manual, HasNoMarkdownInIt) {
  for (const std::string& topic : manual_topics()) {
    EXPECT_FALSE(has(*manual_of(topic), "`")) << topic;
    EXPECT_FALSE(has(*manual_of(topic), "](")) << topic;
  }
}

TEST(Manual, KnowsWhatItDoesNotHave) { EXPECT_FALSE(manual_of("teleporter")); }

}  // namespace
}  // namespace cohort::tool
