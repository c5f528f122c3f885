// SPDX-License-Identifier: Apache-2.0
#include "tools/view/sources/recording_source.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <memory>
#include <random>
#include <span>

#include "server/parsing/experiment/read_experiment.hpp"
#include "server/recording/mcap/format/mcap_error.hpp"
#include "server/recording/recorder.hpp"
#include "tests/support/files.hpp"
#include "tests/support/recordings.hpp"
#include "tools/view/messages/view_messages.hpp"

namespace cohort::view {
namespace {

using recording::Bytes;
using recording::McapReader;
using Random = std::mt19937_64;  // the same everywhere, as its distributions are not

constexpr int ticks_of_a_world = 20;

// Steps the world and records it.
void record_world(recording::Recorder& recorder, Simulation& simulation, recording::Beginning reason) {
  const description::Experiment& experiment = simulation.experiment();
  recorder.begin(experiment, simulation, reason);
  const std::vector<std::uint32_t> robots{0};
  for (int tick = 0; tick < ticks_of_a_world; ++tick) {
    recorder.boundary();
    simulation.set_command(0, std::vector<double>{0.05 * tick});
    recorder.commands(robots);
    simulation.step();
  }
  recorder.boundary();
}

/// Two worlds with a robot that turns a wheel, and snapshots.
Bytes small_run(const std::string& also_recorded = "") {
  const test::ScratchFolder folder;
  test::write_file(folder / "world.sdf", R"(<sdf version="1.9" xmlns:cohort="https://cohort-sim.org/sdf/1">
  <world name="w">
    <gravity>0 0 0</gravity>
    <model name="robot">
      <link name="hull">
        <inertial><mass>2</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia></inertial>
        <collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
      </link>
      <link name="wheel"><inertial><mass>1</mass><inertia/></inertial></link>
      <joint name="hinge" type="revolute">
        <parent>hull</parent><child>wheel</child><axis><xyz>0 0 1</xyz></axis>
      </joint>
      <cohort:joint_encoder name="encoder"><cohort:joint>hinge</cohort:joint></cohort:joint_encoder>
      <cohort:velocity_motor name="motor">
        <cohort:joint>hinge</cohort:joint><cohort:max_velocity>5</cohort:max_velocity><cohort:max_effort>1</cohort:max_effort>
      </cohort:velocity_motor>
    </model>
  </world>
</sdf>
)");
  test::write_file(folder / "run.yaml", "world: world.sdf\nduration: 9\nrecord: {poses: 100, snapshots: 0.05" +
                                            also_recorded +
                                            "}\n"
                                            "teams: [{name: all, robots: all, controller: none}]\n");
  const description::Experiment experiment = parsing::read_experiment(folder / "run.yaml");
  recording::Recorder recorder(folder / "run.mcap", experiment);
  Simulation first(experiment, 1), second(experiment, 1);
  record_world(recorder, first, recording::Beginning::first);
  record_world(recorder, second, recording::Beginning::reset);
  recorder.finish("finished", "");
  return test::read_bytes(folder / "run.mcap");
}

/// Looks at a recording as a browser does, one request after the other.
class Viewing {
 public:
  explicit Viewing(const recording::Recording& recording) : source_(recording, topics_, 1) {
    for (const Topic topic : {Topic::scene, Topic::frame, Topic::contacts, Topic::robots}) topics_.add_reader(topic);
    source_.watch({0, 7});
    request("pause");
  }

  /// Returns the status after it was done.
  ViewStatus request(const std::string& operation, double number = 0.0) {
    ask(operation, number);
    ask("speed", 1.0);  // ends what the source waits for, so that the one before is done
    return messages::decode<ViewStatus>(topics_.newest(Topic::status)->data);
  }

 private:
  void ask(const std::string& operation, double number) {
    const std::uint64_t before = statuses();
    source_.ask({.operation = operation, .number = number},
                [&](const Answer& answer) { EXPECT_TRUE(answer.is_done) << answer.text; });
    for (std::uint64_t seen = published_; statuses() <= before; seen = published_) published_.wait(seen);
  }
  std::uint64_t statuses() const {
    const auto status = topics_.newest(Topic::status);
    return status == nullptr ? 0 : status->version;
  }

  std::atomic<std::uint64_t> published_{0};
  Topics topics_{[this] {
    ++published_;
    published_.notify_all();
  }};
  RecordingSource source_;
};

std::size_t below(std::size_t count, Random& random) { return count == 0 ? 0 : random() % count; }

template <class Byte>
void spoil(std::vector<Byte>& bytes, Random& random) {
  if (bytes.empty()) return;
  const std::size_t at = below(bytes.size(), random);
  switch (below(4, random)) {
    case 0: bytes[at] = static_cast<Byte>(random()); break;
    case 1: std::fill_n(bytes.begin() + at, std::min<std::size_t>(8, bytes.size() - at), Byte{0xff}); break;
    case 2: bytes.resize(at); break;
    default:
      bytes.erase(bytes.begin() + at, bytes.begin() + at + below(std::min<std::size_t>(40, bytes.size() - at), random));
  }
}

/// The same file with some of what it holds spoilt or left out, and all checksums right.
Bytes with_spoilt_contents(const McapReader& reader, Random& random) {
  Bytes file;
  recording::McapWriter writer([&](recording::ByteView bytes) { file.insert(file.end(), bytes.begin(), bytes.end()); });
  const auto is_chosen = [&] { return below(40, random) == 0; };
  for (const auto& [id, schema] : reader.schemas()) writer.add(schema);
  for (const auto& [id, channel] : reader.channels()) writer.add(channel);
  for (const auto& index : reader.attachments()) {
    recording::Attachment attachment = reader.attachment(index);
    if (is_chosen()) spoil(attachment.data, random);
    if (is_chosen()) attachment.name += "x";
    writer.add_attachment(std::move(attachment));
  }
  for (const auto& index : reader.metadata()) writer.add_metadata(reader.metadata(index));
  recording::MessageStream messages = reader.messages({.order = recording::Order::file});
  while (auto message = messages.next()) {
    if (is_chosen()) continue;
    Bytes data(message->data.begin(), message->data.end());
    if (is_chosen()) spoil(data, random);
    writer.write_message(message->channel, message->sequence, message->log_time, message->publish_time, data);
  }
  writer.close();
  return file;
}

/// Plays it, goes on and back, and to every part of it. False if it is refused.
bool look_at(const Bytes& bytes) {
  const test::TemporaryFile file(bytes);
  try {
    const recording::Recording recording(file.path());
    Viewing viewing(recording);
    viewing.request("step", -1);
    viewing.request("step", 3);
    viewing.request("seek", 0.13);
    viewing.request("step", -5);
    viewing.request("step", 1e6);
    viewing.request("step", -1e6);
    viewing.request("seek", 1e9);
    viewing.request("step", -1);
    viewing.request("play");
    viewing.request("step", -2);
    RecordedValues values(recording);
    for (const char* name : {"encoder/0/position", "→ motor/0/velocity"})
      values.read(history_request_of({.operation = "history", .numbers = {0}, .names = {name}}), [] { return false; });
    return true;
  } catch (const recording::McapError&) {
    return false;
  }
}

TEST(RecordingSource, StepsAndSeeksInBothDirections) {
  const test::TemporaryFile file(small_run());
  const recording::Recording recording(file.path());
  Viewing viewing(recording);
  EXPECT_EQ(viewing.request("seek", 0.1).time_ns, 100'000'000);
  EXPECT_EQ(viewing.request("step", -3).time_ns, 70'000'000);
  EXPECT_EQ(viewing.request("step", 5).time_ns, 120'000'000);
  EXPECT_EQ(viewing.request("step", -1e6).time_ns, 0);
  EXPECT_EQ(viewing.request("seek", 0.33).note, "");
}

// Returns the robot's observation and then its command at each boundary, by a replay.
std::map<double, std::vector<double>> values_by_replay(const recording::Recording& recording) {
  std::map<double, std::vector<double>> values;
  recording::Replay replay(recording, 1);
  while (replay.advance()) {
    const auto command = replay.simulation().command(0);
    const auto observation = replay.simulation().observation(0);
    std::vector<double>& here = values[static_cast<double>(replay.recorded().log_time.count()) / 1e9];
    here.assign(observation.begin(), observation.end());
    here.insert(here.end(), command.begin(), command.end());
  }
  return values;
}

// The whole history of a value, by as many requests as it takes.
ValueSeries whole_history(RecordedValues& values, ViewRequest asked) {
  ValueSeries whole;
  while (true) {
    const Answer answer = values.read(history_request_of(asked), [] { return false; });
    EXPECT_TRUE(answer.is_done) << answer.text;
    if (!answer.is_done) return whole;
    for (const ValueSeries& part : answer.history->series) {
      whole.unit = part.unit;
      whole.times.insert(whole.times.end(), part.times.begin(), part.times.end());
      whole.values.insert(whole.values.end(), part.values.begin(), part.values.end());
    }
    if (!answer.history->next) return whole;
    asked.from = answer.history->next;
  }
}

void expect_history_of_replay(const recording::Recording& recording) {
  const auto expected = values_by_replay(recording);
  ASSERT_EQ(expected.size(), 2U * (ticks_of_a_world + 1));
  RecordedValues values(recording);
  const ValueSeries position =
      whole_history(values, {.operation = "history", .numbers = {0}, .names = {"encoder/0/position"}});
  const ValueSeries command =
      whole_history(values, {.operation = "history", .numbers = {0}, .names = {"→ motor/0/velocity"}});
  EXPECT_EQ(position.unit, "rad");
  EXPECT_EQ(command.unit, "rad/s");
  for (const ValueSeries* series : {&position, &command}) ASSERT_EQ(series->times.size(), expected.size());
  std::size_t i = 0;
  for (const auto& [time, all] : expected) {
    EXPECT_EQ(position.times[i], time);
    EXPECT_EQ(command.times[i], time);
    EXPECT_EQ(position.values[i], all.front()) << time;
    EXPECT_EQ(command.values[i], all.back()) << time;
    ++i;
  }
  EXPECT_NE(position.values[10], position.values[20]);
}

TEST(RecordedValues, AreThoseOfAReplayIfTheFileHasNone) {
  const test::TemporaryFile file(small_run());
  expect_history_of_replay(recording::Recording(file.path()));
}

TEST(RecordedValues, AreThoseOfTheFileIfItHasThem) {
  const test::TemporaryFile file(small_run(", observations: 100"));
  expect_history_of_replay(recording::Recording(file.path()));
}

TEST(RecordedValues, OfAnIntervalAreThoseOfTheWhole) {
  const test::TemporaryFile file(small_run());
  const recording::Recording recording(file.path());
  RecordedValues values(recording);
  for (const char* name : {"encoder/0/position", "→ motor/0/velocity"}) {
    ViewRequest asked{.operation = "history", .numbers = {0}, .names = {name}};
    const ValueSeries whole = whole_history(values, asked);
    asked.from = 0.08;
    asked.to = 0.31;
    const ValueSeries part = whole_history(values, asked);
    EXPECT_EQ(part.times.front(), 0.08);
    EXPECT_EQ(part.times.back(), 0.31);
    const auto begin = std::ranges::find(whole.times, 0.08) - whole.times.begin();
    ASSERT_EQ(part.values.size(), 24U);
    EXPECT_TRUE(std::ranges::equal(part.values, std::span(whole.values).subspan(begin, 24)));
  }
}

TEST(RecordingSource, AnswersHistoriesWhileItPlays) {
  const test::TemporaryFile file(small_run());
  const recording::Recording recording(file.path());
  Topics topics;
  RecordingSource source(recording, topics, 1);
  std::atomic<bool> is_answered = false;
  source.ask({.operation = "history", .numbers = {0}, .names = {"encoder/0/position"}}, [&](const Answer& answer) {
    EXPECT_TRUE(answer.is_done) << answer.text;
    EXPECT_EQ(answer.history->series.size(), 1U);
    is_answered = true;
    is_answered.notify_all();
  });
  is_answered.wait(false);
  source.ask({.operation = "history", .numbers = {7}, .names = {"encoder/0/position"}},
             [](const Answer& answer) { EXPECT_FALSE(answer.is_done); });
}

TEST(RecordingSource, ShowsNothingOfAWorldThatCannotBeBuiltHoweverOneStepsThere) {
  const test::TemporaryFile whole(small_run());
  const McapReader reader(whole.path());
  Bytes bytes;
  recording::McapWriter writer([&](recording::ByteView part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
  for (const auto& [id, schema] : reader.schemas()) writer.add(schema);
  for (const auto& [id, channel] : reader.channels()) writer.add(channel);
  for (const auto& index : reader.attachments()) {
    recording::Attachment attachment = reader.attachment(index);
    attachment.data.resize(attachment.data.size() / 2);
    writer.add_attachment(std::move(attachment));
  }
  for (const auto& index : reader.metadata()) writer.add_metadata(reader.metadata(index));
  recording::MessageStream messages = reader.messages({.order = recording::Order::file});
  while (const auto message = messages.next())
    writer.write_message(message->channel, message->sequence, message->log_time, message->publish_time, message->data);
  writer.close();

  const test::TemporaryFile file(bytes);
  const recording::Recording recording(file.path());
  Viewing viewing(recording);
  for (const double steps : {-1.0, 1.0, -1e6, 1e6}) EXPECT_NE(viewing.request("step", steps).note, "");
  EXPECT_NE(viewing.request("seek", 0.1).note, "");
  EXPECT_NE(viewing.request("step", -1.0).note, "");
}

TEST(RecordingSource, SurvivesAnyDamageToItsFile) {
  const Bytes whole = small_run();
  Random random(1);
  int shown = 0;
  constexpr int cases = 60;
  for (int i = 0; i < cases; ++i) {
    Bytes bytes = whole;
    for (std::size_t changes = 1 + below(4, random); changes > 0; --changes) spoil(bytes, random);
    shown += look_at(bytes) ? 1 : 0;
  }
  EXPECT_GT(shown, 0);
}

TEST(RecordingSource, SurvivesContentsThatNoRecorderWrites) {
  const test::TemporaryFile file(small_run());
  const McapReader reader(file.path());
  Random random(2);
  int shown = 0;
  constexpr int cases = 60;
  for (int i = 0; i < cases; ++i) shown += look_at(with_spoilt_contents(reader, random)) ? 1 : 0;
  EXPECT_GT(shown, cases / 4);
}

}  // namespace
}  // namespace cohort::view
