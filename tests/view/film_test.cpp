// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include "tests/support/process.hpp"

// Tests of `cohort film`: each format as ffmpeg decodes it, repeatability, errors.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;

class Films : public ::testing::Test {
 protected:
  static constexpr int width = 160;
  static constexpr int height = 90;

  void SetUp() override {
    for (const char* program : {"chromium", "ffmpeg"})
      if (!is_installed(program))
        GTEST_SKIP() << "there is no " << program << ": tools/dev/install-packages tools/dev/packages-browser.txt";
    if (!fs::exists(COHORT_BUILD_DIR "/share/cohort/view/page.js"))
      GTEST_SKIP() << "the page was not built: tools/dev/install-packages tools/dev/packages-node.txt";
    run_demo({"--duration", "2", "--record", scratch / "run.mcap", "--record-snapshots", "1"});
    fs::create_directory(scratch / "tmp");
  }

  std::vector<std::string> command(const std::string& output, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> command = {cohort_program(), "film", scratch / "run.mcap", "-o", scratch / output};
    if (std::ranges::find(more, "--size") == more.end())
      command.insert(command.end(), {"--size", std::to_string(width) + "x" + std::to_string(height)});
    command.insert(command.end(), more.begin(), more.end());
    return command;
  }
  Process::Environment environment() const { return {{"TMPDIR", scratch / "tmp"}}; }
  Ended film(const std::string& output, const std::vector<std::string>& more = {}) const {
    return run_to_end(command(output, more), environment());
  }
  void make(const std::string& output, const std::vector<std::string>& more = {}) const {
    const Ended ended = film(output, more);
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    EXPECT_EQ(ended.out, "");
  }
  void expect_error(const std::string& output, const std::vector<std::string>& more, const std::string& message) const {
    const Ended ended = film(output, more);
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_NE(ended.err.find(message), std::string::npos) << ended.err;
    expect_nothing_left();
  }
  void expect_nothing_left() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(scratch.path())) names.push_back(entry.path().filename());
    std::ranges::sort(names);
    EXPECT_EQ(names, (std::vector<std::string>{"run.mcap", "tmp"}));
    EXPECT_TRUE(fs::is_empty(scratch / "tmp")) << run_to_end({"/usr/bin/find", scratch / "tmp"}).out;
  }

  // A camera that moves. Returns its file.
  std::string camera() const {
    write_file(scratch / "camera.yaml", R"(path:
  - {time: 0, position: [2, -2, 2], target: [0, 0, 0]}
  - {time: 2, position: [2, 2, 3], target: [0, 0, 0]}
)");
    return scratch / "camera.yaml";
  }

  // Returns the description of the first stream by ffprobe, which counts its pictures.
  nlohmann::json stream_of(const std::string& output) const {
    const Ended ended = run_to_end({"/usr/bin/env", "ffprobe", "-v", "error", "-count_frames", "-show_streams",
                                    "-show_format", "-of", "json", scratch / output});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    const auto found = nlohmann::json::parse(ended.out, nullptr, false);
    nlohmann::json stream = found["streams"][0];
    stream["duration"] = found["format"]["duration"];
    return stream;
  }
  // Returns the checksums of all pictures, in order.
  std::vector<std::string> pictures_of(const std::string& output) const {
    const Ended ended =
        run_to_end({"/usr/bin/env", "ffmpeg", "-v", "error", "-i", scratch / output, "-f", "framemd5", "-"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    std::vector<std::string> sums;
    std::istringstream lines(ended.out);
    for (std::string line; std::getline(lines, line);)
      if (!line.starts_with('#')) sums.push_back(line.substr(line.rfind(' ') + 1));
    return sums;
  }
  // Returns red, green and blue of the pixel in the middle of a picture.
  std::array<int, 3> middle_of(const std::string& output) const {
    const Ended ended = run_to_end(
        {"/usr/bin/env", "ffmpeg", "-v", "error", "-i", scratch / output, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"});
    EXPECT_EQ(ended.out.size(), 3U * width * height) << ended.err;
    std::array<int, 3> pixel{};
    const std::size_t at = 3 * (height / 2 * width + width / 2);
    if (ended.out.size() > at + 2)
      for (std::size_t i = 0; i < 3; ++i) pixel[i] = static_cast<unsigned char>(ended.out[at + i]);
    return pixel;
  }

  ScratchFolder scratch;
};

class EachFormat : public Films, public ::testing::WithParamInterface<const char*> {};

TEST_P(EachFormat, HasThePicturesTheSizeAndTheDurationOfThePart) {
  const std::string output = std::string("run.") + GetParam();
  make(output, {"--from", "0.5", "--to", "1.5", "--fps", "10", "--trails", "--labels", "--contacts", "--clock",
                "--caption", "Obstacle avoidance", "--theme", "dark"});
  const nlohmann::json stream = stream_of(output);
  EXPECT_EQ(stream["width"], width);
  EXPECT_EQ(stream["height"], height);
  EXPECT_EQ(stream["nb_read_frames"], "10");
  EXPECT_NEAR(std::stod(stream["duration"].get<std::string>()), 1.0, 0.011);
  const std::vector<std::string> pictures = pictures_of(output);
  EXPECT_EQ(std::set<std::string>(pictures.begin(), pictures.end()).size(), 10U) << "robots move in each picture";
  fs::remove(scratch / output);
  expect_nothing_left();
}
INSTANTIATE_TEST_SUITE_P(OfFilms, EachFormat, ::testing::Values("mp4", "webm", "gif"),
                         [](const auto& format) { return std::string(format.param); });

// Debian 12's ffmpeg does not read animated WebP, whose chunks are simple:
// https://developers.google.com/speed/webp/docs/riff_container
TEST_F(Films, AreAnimatedWebPToo) {
  make("run.webp", {"--to", "0.5", "--fps", "10"});
  const std::string file = read_file(scratch / "run.webp");
  const auto number = [&](std::size_t at, int bytes) {
    std::size_t value = 0;
    for (int i = bytes - 1; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(file.at(at + i));
    return value;
  };
  ASSERT_EQ(file.substr(0, 4) + file.substr(8, 4), "RIFFWEBP");
  std::size_t duration = 0;
  std::set<std::string> pictures;
  for (std::size_t at = 12; at + 8 <= file.size();) {
    const std::string name = file.substr(at, 4);
    const std::size_t size = number(at + 4, 4);
    if (name == "VP8X") {
      EXPECT_EQ(number(at + 12, 3) + 1, static_cast<std::size_t>(width));
      EXPECT_EQ(number(at + 15, 3) + 1, static_cast<std::size_t>(height));
    } else if (name == "ANMF") {
      duration += number(at + 20, 3);
      pictures.insert(file.substr(at + 24, size - 16));
    }
    at += 8 + size + size % 2;
  }
  EXPECT_EQ(pictures.size(), 5U);
  EXPECT_EQ(duration, 500U);
}

TEST_F(Films, AreTheSameEveryTime) {
  const std::vector<std::string> options = {"--to", "0.4", "--follow", "sbot_3", "--trails", "--labels"};
  make("first.mp4", options);
  const std::string first = read_file(scratch / "first.mp4");
  EXPECT_EQ(pictures_of("first.mp4").size(), 12U);
  make("first.mp4", options);  // replaces the first one
  EXPECT_TRUE(read_file(scratch / "first.mp4") == first);
}

// A part begins from a snapshot, and draws what the whole film draws at that time.
TEST_F(Films, AreNumberedPicturesToo) {
  make("whole_%02d.png", {"--to", "1.5", "--fps", "4", "--camera", camera()});
  EXPECT_TRUE(fs::exists(scratch / "whole_05.png"));
  EXPECT_FALSE(fs::exists(scratch / "whole_06.png"));
  make("part%d.png", {"--from", "1.25", "--to", "1.5", "--fps", "4", "--camera", camera()});
  EXPECT_TRUE(read_file(scratch / "whole_05.png") == read_file(scratch / "part0.png"));
  EXPECT_FALSE(read_file(scratch / "whole_04.png") == read_file(scratch / "part0.png"));
  make("one.png", {"--from", "1.25", "--camera", camera()});
  EXPECT_TRUE(read_file(scratch / "whole_05.png") == read_file(scratch / "one.png"));
}

TEST_F(Films, RunFasterOrSlower) {
  make("slow.mp4", {"--to", "0.1", "--speed", "0.5"});
  const std::vector<std::string> pictures = pictures_of("slow.mp4");
  EXPECT_EQ(pictures.size(), 6U);
  EXPECT_EQ(std::set<std::string>(pictures.begin(), pictures.end()).size(), 6U) << "there are pictures between ticks";
  make("fast.mp4", {"--speed", "10", "--fps", "30"});
  EXPECT_EQ(pictures_of("fast.mp4").size(), 6U);
}

// The robots are orange, and nothing else is.
TEST_F(Films, KeepWhatIsFollowedInTheMiddle) {
  const auto is_orange = [](const std::array<int, 3>& pixel) { return pixel[0] > 2 * pixel[2] && pixel[0] > pixel[1]; };
  for (const char* time : {"0", "1.9"}) {
    make("follow.png", {"--from", time, "--follow", "explorers/sbot_3", "--top", "--distance", "0.5"});
    EXPECT_TRUE(is_orange(middle_of("follow.png"))) << time;
  }
  write_file(scratch / "away.yaml", "follow: sbot_3\npath: [{time: 0, position: [0, 0.01, 9], target: [0, 0, 9.5]}]\n");
  make("away.png", {"--camera", scratch / "away.yaml"});
  EXPECT_FALSE(is_orange(middle_of("away.png")));
}

// It takes a while to decode an image of this size.
TEST_F(Films, ShowTexturesFromTheFirstPictureOn) {
  fs::remove(scratch / "run.mcap");
  const Ended image = run_to_end({"/usr/bin/env", "ffmpeg", "-v", "error", "-f", "lavfi", "-i",
                                  "color=yellow:size=6000x6000", "-frames:v", "1", scratch / "yellow.png"});
  ASSERT_EQ(image.exit_code, 0) << image.err;
  write_file(scratch / "world.yaml", R"(world:
  name: w
  model:
    name: crate
    static: true
    link:
      name: body
      visual:
        name: box
        geometry: {box: {size: [1, 1, 1]}}
        material: {diffuse: [0, 0, 1, 1], pbr: {metal: {albedo_map: yellow.png}}}
)");
  run_experiment(scratch / "world.yaml",
                 {"--controllers", "inprocess", "--duration", "0.1", "--record", scratch / "run.mcap"});
  write_file(scratch / "camera.yaml", "path: [{time: 0, position: [0, -3, 0.1], target: [0, -0.5, 0]}]\n");
  make("run.png", {"--camera", scratch / "camera.yaml"});
  const auto [red, green, blue] = middle_of("run.png");
  EXPECT_GT(red, 2 * blue) << green;
  EXPECT_GT(green, 2 * blue);
}

TEST_F(Films, EndOnRequestAndLeaveNothing) {
  for (const char* output : {"run.mp4", "run.gif"}) {
    Process film(command(output, {"--speed", "0.01"}), environment());
    const auto has_both = [&] { return children_of(film.pid()).size() >= 2 && !fs::is_empty(scratch / "tmp"); };
    ASSERT_TRUE(eventually(has_both)) << film.output();
    const std::vector<pid_t> children = children_of(film.pid());
    film.signal(SIGINT);
    EXPECT_EQ(film.wait_for_exit(), 130) << film.output();
    for (const pid_t child : children) EXPECT_TRUE(wait_until_gone(child));
    expect_nothing_left();
  }
}

TEST_F(Films, LeaveNoProcessIfTheyAreKilled) {
  Process film(command("run.mp4", {"--speed", "0.01"}), environment());
  std::vector<pid_t> processes;
  const auto has_browser = [&] {  // with processes of its own
    processes = children_of(film.pid());
    if (processes.size() < 2) return false;
    for (const pid_t child : children_of(film.pid()))
      for (const pid_t grandchild : children_of(child)) processes.push_back(grandchild);
    return processes.size() >= 4;
  };
  ASSERT_TRUE(eventually(has_browser)) << film.output();
  film.signal(SIGKILL);
  film.wait_for_exit();
  for (const pid_t process : processes) EXPECT_TRUE(wait_until_gone(process));
}

TEST_F(Films, ReportMistakesBeforeTheyBegin) {
  expect_error("run.avi", {}, "expected a file name that ends in .mp4, .webm, .gif, .webp or .png");
  expect_error("run.mp4", {"--size", "161x90"}, ".mp4 films have an even width and height");
  expect_error("run_%d_%d.png", {}, "expected one place for a number");
  expect_error("nowhere/run.mp4", {}, "the film cannot be written to");
  expect_error("run.mp4", {"--from", "3"}, "the recording contains no data between '--from' and '--to'");
  expect_error("run.mp4", {"--speed", "1e-6"}, "pictures, more than 200000: choose a shorter part");
  expect_error("run.mp4", {"--follow", "sbit_3"}, "there is no robot 'sbit_3'");
  expect_error("run.mp4", {"--camera", "/nowhere.yaml"}, "/nowhere.yaml cannot be read: No such file or directory");
}

TEST_F(Films, NameThePackagesThatAreMissing) {
  fs::create_directory(scratch / "tmp/bin");
  const Process::Environment without = {{"TMPDIR", scratch / "tmp"}, {"PATH", scratch / "tmp/bin"}};
  const Ended no_ffmpeg = run_to_end(command("run.mp4"), without);
  EXPECT_EQ(no_ffmpeg.exit_code, 2);
  EXPECT_NE(no_ffmpeg.err.find("install the Debian package ffmpeg"), std::string::npos) << no_ffmpeg.err;
  const Ended no_browser = run_to_end(command("run.png"), without);
  EXPECT_EQ(no_browser.exit_code, 2);
  EXPECT_NE(no_browser.err.find("install the Debian package chromium"), std::string::npos) << no_browser.err;
  // A browser that does not start: its last words are in the message.
  write_file(scratch / "tmp/bin/chromium", "#!/bin/sh\necho no libraries >&2\nexit 3\n");
  fs::permissions(scratch / "tmp/bin/chromium", fs::perms::owner_all);
  const Ended no_start = run_to_end(command("run.png"), without);
  EXPECT_EQ(no_start.exit_code, 2);
  EXPECT_NE(no_start.err.find("chromium ended early: no libraries"), std::string::npos) << no_start.err;
  EXPECT_FALSE(fs::exists(scratch / "run.png"));
}

}  // namespace
}  // namespace cohort::test
