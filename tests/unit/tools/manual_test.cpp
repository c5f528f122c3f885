// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/manual/manual.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "server/parsing/keys/details.hpp"
#include "server/parsing/keys/experiment_keys.hpp"
#include "tests/support/files.hpp"
#include "tools/cli/commands/manual/entries.hpp"
#include "tools/cli/commands/manual/reference_pages.hpp"

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
    EXPECT_FALSE(has(*manual_of(topic), "**")) << topic;
  }
}

TEST(Manual, ExplainsElementsAndTopicsThatExist) {
  std::size_t explained = 0;
  for (const parsing::Extension* entry : manual_entries()) {
    const std::string_view details = parsing::details_of(*entry);
    if (details.empty()) continue;
    ++explained;
    EXPECT_TRUE(has(*manual_of(std::string(entry->name)), "\n  ")) << entry->name;
    EXPECT_TRUE(details.ends_with('\n') && !details.starts_with('\n')) << entry->name;
  }
  for (const Topic& topic : topics()) explained += parsing::details_of_topic(topic.name).empty() ? 0 : 1;
  std::size_t all = 0;
  for (const auto& part : {parsing::actuator_explanations(), parsing::sensor_explanations(),
                           parsing::world_explanations(), parsing::experiment_explanations()})
    all += part.size();
  EXPECT_EQ(explained, all) << "an explanation belongs to no element and no topic, or two to the same";
}

TEST(Reference, IsWhatTheTablesSay) {
  const std::filesystem::path folder = COHORT_SOURCE_DIR "/docs/reference";
  const std::string remedy = "; mend it with: cohort help --markdown " + folder.string();
  std::set<std::string> files;
  for (const ReferencePage& page : reference_pages()) {
    files.insert(page.file);
    ASSERT_TRUE(std::filesystem::exists(folder / page.file)) << page.file << " is missing" << remedy;
    EXPECT_EQ(test::read_file(folder / page.file), page.text) << page.file << " is not up to date" << remedy;
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    EXPECT_TRUE(files.contains(entry.path().filename())) << "no topic writes " << entry.path();
}

TEST(Reference, HasEveryKeyOfEveryElement) {
  std::string all;
  for (const ReferencePage& page : reference_pages()) all += page.text;
  for (const parsing::Extension* entry : manual_entries())
    for (const parsing::ExtensionKey& key : entry->keys)
      EXPECT_TRUE(has(all, "- **`" + std::string(key.name) + "`** · ")) << entry->name << " lacks " << key.name;
}

TEST(Reference, HasLinesThatFitAScreen) {
  for (const ReferencePage& page : reference_pages()) {
    std::size_t column = 0;
    for (const char c : page.text) {
      if ((static_cast<unsigned char>(c) & 0xC0) != 0x80) column = c == '\n' ? 0 : column + 1;
      EXPECT_LE(column, 120u) << page.file;
      if (column > 120) break;
    }
  }
}

TEST(Manual, KnowsWhatItDoesNotHave) { EXPECT_FALSE(manual_of("teleporter")); }

}  // namespace
}  // namespace cohort::tool
