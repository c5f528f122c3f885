// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>
#include <regex>

#include "server/recording/replay.hpp"
#include "tests/support/controlled_run.hpp"
#include "tests/view/robots_at.hpp"
#include "tests/view/viewing.hpp"
#include "tools/view/html/html_file.hpp"

// Tests of `cohort page`: HTML files that contain a recording.
namespace cohort::view {
namespace {

using namespace test;
using nlohmann::json;

constexpr std::array moments = {0.5, 2.55, 1.0};

Ended write_page(const std::filesystem::path& recording, const std::filesystem::path& output,
                 const std::vector<std::string>& more = {}) {
  std::vector<std::string> command = {cohort_program(), "page", recording, "-o", output};
  command.insert(command.end(), more.begin(), more.end());
  return run_to_end(command);
}

void write_page_or_fail(const std::filesystem::path& recording, const std::filesystem::path& output,
                        const std::vector<std::string>& more = {}) {
  const Ended ended = write_page(recording, output, more);
  ASSERT_EQ(ended.exit_code, 0) << ended.err;
}

json robots_at_moments(const std::filesystem::path& recording) {
  json all = json::array();
  for (const double moment : moments) all.push_back(robots_at(recording, moment));
  return all;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

class AnHtmlFile : public InABrowser {
 protected:
  static std::string address_of(const std::filesystem::path& file) { return "file://" + file.string(); }
  ScratchFolder scratch;
};

TEST_F(AnHtmlFile, PlaysARecordingWithoutANetwork) {
  run_demo({"--duration", "4", "--record", scratch / "run.mcap"});
  write_page_or_fail(scratch / "run.mcap", scratch / "run.html");
  write_file(scratch / "expected.json",
             json{{"moments", robots_at_moments(scratch / "run.mcap")}, {"last", 400}}.dump());
  std::filesystem::remove(scratch / "run.mcap");
  run_script("html.mjs", {"plays", address_of(scratch / "run.html"), scratch / "expected.json"});
}

// Chunks have 64 frames, so there are several. Something is gripped.
TEST_F(AnHtmlFile, ShowsToTheBitWhatTheViewShows) {
  run_experiment(COHORT_SOURCE_DIR "/tests/view/exhibits/experiment.yaml",
                 {"--controllers", "inprocess", "--record", scratch / "run.mcap", "--record-snapshots", "1"});
  write_page_or_fail(scratch / "run.mcap", scratch / "run.html", {"--contacts", "--fps", "100"});
  const View view({scratch / "run.mcap"});
  write_file(scratch / "expected.json",
             json{{"moments", robots_at_moments(scratch / "run.mcap")}, {"view", view.address()}}.dump());
  run_script("html.mjs", {"equals_view", address_of(scratch / "run.html"), scratch / "expected.json"});
}

TEST_F(AnHtmlFile, RunsNoCodeThatIsInTheTextsOfARecording) {
  const std::string world = "</script><script>window.broken = 1</script><!-- <img src=x onerror=alert(1)>";
  write_file(scratch / "world.yaml", R"(world:
  name: ")" + world + R"("
  model: {name: ground, static: true, link: {name: body, collision: {name: floor, geometry: {plane: {normal: [0, 0, 1], size: [3, 3]}}}}}
  cohort:population: {name: swarm, uri: "model://sbot", count: 2, placement: {uniform: {min: [-1, -1], max: [1, 1]}}}
)");
  write_file(scratch / "run.yaml",
             "world: world.yaml\nduration: 0.1\nteams:\n  - {name: swarm, robots: swarm/*, controller: constant}\n");
  const std::string name = "run<img src=x onerror=alert(1)>.mcap";
  run_experiment(scratch / "run.yaml", {"--controllers", "inprocess", "--record", scratch / name});
  write_page_or_fail(scratch / name, scratch / "run.html");
  const std::string html = read_file(scratch / "run.html");
  EXPECT_EQ(html.find("onerror=alert"), html.rfind("onerror=alert")) << "only in the title, escaped";
  EXPECT_NE(html.find("<title>run&lt;img"), std::string::npos);
  write_file(scratch / "expected.json", json{{"world", world}, {"name", name}}.dump());
  run_script("html.mjs", {"is_harmless", address_of(scratch / "run.html"), scratch / "expected.json"});
}

TEST_F(AnHtmlFile, ShowsObjectsThatWereAddedDuringTheRun) {
  const FieldOfRobots field(2, 1e4);
  {
    ControlledRun run(field, {"--paused", "--record", scratch / "run.mcap"});
    run.done({"step", "20"});
    run.done({"spawn", "post", "--name", "late", "--pose", "2 0 0"});
    run.done({"step", "20"});
    run.done({"shutdown"});
    run.finish();
  }
  write_page_or_fail(scratch / "run.mcap", scratch / "run.html");
  run_script("html.mjs", {"changes_scene", address_of(scratch / "run.html")});
}

TEST_F(AnHtmlFile, ContainsTheTextures) {
  run_experiment(COHORT_SOURCE_DIR "/tests/view/exhibits/textures.yaml",
                 {"--controllers", "inprocess", "--duration", "0.1", "--record", scratch / "run.mcap"});
  write_page_or_fail(scratch / "run.mcap", scratch / "run.html");
  std::filesystem::remove(scratch / "run.mcap");
  run_script("html.mjs", {"contains_textures", address_of(scratch / "run.html")});
}

class PageCommand : public ::testing::Test {
 protected:
  void SetUp() override {
    run_demo({"--duration", "0.5", "--record", recording});
    if (write_page(recording, output).err.find("the browser page was not built") != std::string::npos)
      GTEST_SKIP() << "the page of the view was not built";
    write_file(output, "old");
  }
  void expect_refused(const Ended& ended, const std::string& message) const {
    EXPECT_EQ(ended.exit_code, 2) << ended.err;
    EXPECT_NE(ended.err.find(message), std::string::npos) << ended.err;
    EXPECT_EQ(read_file(output), "old");
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scratch.path())) files += entry.path().empty() ? 0 : 1;
    EXPECT_EQ(files, 2u) << "nothing else is left behind";
  }

  ScratchFolder scratch;
  const std::filesystem::path recording = scratch / "run.mcap";
  const std::filesystem::path output = scratch / "run.html";
};

TEST_F(PageCommand, ReportsItsSize) {
  const Ended ended = write_page(recording, output);
  EXPECT_EQ(ended.exit_code, 0);
  EXPECT_TRUE(std::regex_search(ended.err, std::regex(R"(11 frames in 0\.50 s, \d\.\d\d MB, of which the data is )"
                                                      R"(\d\.\d\d MB, \d+ bytes per robot and second)")))
      << ended.err;
  const std::size_t usual = std::filesystem::file_size(output);
  ASSERT_EQ(write_page(recording, output, {"--robots", "none"}).exit_code, 0);
  EXPECT_LT(std::filesystem::file_size(output), usual);
  ASSERT_EQ(write_page(recording, output, {"--fps", "100"}).exit_code, 0);
  EXPECT_GT(std::filesystem::file_size(output), usual);
}

TEST_F(PageCommand, WritesThePartThatIsAskedFor) {
  const Ended ended = write_page(recording, output, {"--from", "0.12", "--to", "0.31"});
  EXPECT_NE(ended.err.find("5 frames in 0.19 s"), std::string::npos) << ended.err << "the last one is always there";
}

TEST_F(PageCommand, RefusesAPageThatIsTooLargeAndKeepsTheOldFile) {
  const Ended ended = write_page(recording, output, {"--max-size", "0.5"});
  expect_refused(ended, "the page is larger than '--max-size' 0.5 MB");
  for (const char* way : {"'--from'", "'--fps'", "'--robots'"}) EXPECT_NE(ended.err.find(way), std::string::npos);
}

TEST_F(PageCommand, RefusesWhatIsNoRecording) {
  expect_refused(write_page(scratch / "none.mcap", output), "none.mcap");
  expect_refused(write_page(output, output), "run.html");
  expect_refused(write_page(demo_experiment(), output), "is an experiment, not a recording");
  expect_refused(write_page(recording, output, {"--from", "9"}), "no data between");
  expect_refused(write_page(recording, output, {"--robots", "nobody"}), "nobody");
}

TEST_F(PageCommand, RefusesAFileThatCannotBeWritten) {
  expect_refused(write_page(recording, scratch / "missing" / "run.html"), "the page cannot be written to ");
  expect_refused(write_page(recording, scratch.path()), "the page cannot be written to ");
}

TEST(HtmlFile, EscapesWhatWouldEndAScriptOrATitle) {
  EXPECT_EQ(script_for_html("a='</SCRIPT>'+\"<!--\"+'</div>'"), "a='\\x3C/SCRIPT>'+\"\\x3C!--\"+'</div>'");
  EXPECT_EQ(escaped_html("</title>&\""), "&lt;/title&gt;&amp;&quot;");
}

TEST(HtmlFile, ContainsThePageAndItsBlocksAndNoOtherFile) {
  const ScratchFolder scratch;
  const BuiltPage page{
      "<html><head><title>Cohort</title><link rel=\"stylesheet\" href=\"page.css\">"
      "<script type=\"module\" src=\"page.js\"></script></head><body>here</body></html>",
      "alert('</script>')", "b{}"};
  HtmlFile file(scratch / "run.html", page, "a < b");
  EXPECT_EQ(file.add("AAAA"), 0u);
  EXPECT_EQ(file.add("BBBB"), 1u);
  EXPECT_FALSE(std::filesystem::exists(scratch / "run.html"));
  file.commit();
  const std::string html = read_file(scratch / "run.html");
  EXPECT_EQ(html.size(), file.size());
  EXPECT_EQ(count_of(html, "</script"), 3u);
  EXPECT_EQ(count_of(html, " src="), 0u);
  EXPECT_EQ(count_of(html, "href="), 0u);
  for (const char* part : {"<title>a &lt; b</title>", "<style>b{}</style>", "alert('\\x3C/script>')", "here<script"})
    EXPECT_EQ(count_of(html, part), 1u) << part << html;
  EXPECT_THROW(HtmlFile(scratch / "run.html", {"<html></html>", "", ""}, ""), std::runtime_error);
}

}  // namespace
}  // namespace cohort::view
