// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <concepts>
#include <csignal>
#include <cstdlib>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <variant>
#include <vector>

#include "idl/dds/codec.hpp"
#include "idl/dds/transport.hpp"
#include "idl/wire/control_messages.hpp"
#include "tests/support/free_domain.hpp"

namespace cohort::wire {

// A message with a list that leaves out one of its members, and most fields of its sample.
struct HalfListed {
  std::uint64_t client = 0;
  std::optional<std::string> host{};
};
template <>
struct OnWire<HalfListed> : Between<HalfListed, cohort_v1_Join> {
  static constexpr std::tuple fields = {field(&M::client, &S::client)};
};
// And one that has a member twice, instead of another.
struct TwiceListed {
  double x = 0.0, y = 0.0, z = 0.0;
};
template <>
struct OnWire<TwiceListed> : Between<TwiceListed, cohort_v1_Vector3> {
  static constexpr std::tuple fields = {field(&M::x, &S::x), field(&M::y, &S::y), field(&M::y, &S::z)};
};

namespace {

using namespace test;

// Messages with views as text, for storage and comparison.
template <class... Numbers>
std::string show_all(const Numbers&... numbers) {
  return ((std::to_string(numbers) + " ") + ...);
}
template <class List>
std::string show_list(const List& list) {
  std::string text = "[";
  for (const auto& element : list) text += std::to_string(element) + ",";
  return text + "]";
}
std::string show(const Observation& m) {
  return show_all(m.client, m.run, m.resent, m.epoch, m.tick, m.time_ns) + show_list(m.robots) + show_list(m.values);
}
std::string show(const Command& m) {
  return show_all(m.client, m.run, m.epoch, m.tick, m.resent) + show_list(m.robots) + show_list(m.values);
}
std::string show(const WorldState& m) {
  return show_all(m.run, m.tick, m.time_ns, m.state_hash) + show_list(m.robots) + show_list(m.poses);
}
std::string show(const SceneDescription& m) { return show_all(m.run, m.revision) + show_list(m.scene); }
std::string show(const SceneUpdate& m) {
  return show_all(m.run, m.revision, m.tick) + show_list(m.frame) + show_list(m.signals) + show_list(m.contacts) +
         show_list(m.robots);
}
std::string show(const ControllerState& m) {
  return show_all(m.client, m.run, static_cast<std::uint32_t>(m.kind), m.epoch, m.tick, m.size, m.offset) +
         show_list(m.data);
}

// A message, for storage and comparison.
template <class Message>
auto kept(const Message& message) {
  if constexpr (std::equality_comparable<Message>)
    return message;
  else
    return show(message);
}

// Samples that a reader received, in order.
template <class Message>
class Inbox {
 public:
  explicit Inbox(Participant& participant, const std::string& partition = "", int depth = 8)
      : reader_(participant, {[this](const Message& message, const Sender&) { add(kept(message)); }, nullptr},
                partition, depth) {}

  using Kept = decltype(kept(std::declval<Message>()));
  std::vector<Kept> received() const {
    const std::lock_guard lock(mutex_);
    return received_;
  }
  bool waits_for(std::size_t count) const {
    return eventually([&] { return received().size() >= count; });
  }
  std::uint32_t matched() const { return reader_.matched(); }

 private:
  void add(Kept message) {
    const std::lock_guard lock(mutex_);
    received_.push_back(std::move(message));
  }

  mutable std::mutex mutex_;
  std::vector<Kept> received_;
  Reader<Message> reader_;
};

class WireTest : public testing::Test {
 protected:
  WireTest() : client(Participant::client(free.domain)) {}

  // Writes the messages one after the other, each when the one before has arrived, and compares.
  template <class Message>
  void expect_round_trip(Participant& from, Participant& to, const std::vector<Message>& messages) {
    Inbox<Message> inbox(to);
    Writer<Message> writer(from);
    ASSERT_TRUE(eventually([&] { return inbox.matched() == 1 && writer.matched() == 1; }));
    for (std::size_t i = 0; i < messages.size(); ++i) {
      // The first message after a match may be lost where it is not transient local.
      ASSERT_TRUE(eventually([&] {
        writer.write(messages[i]);
        return eventually([&] { return !inbox.received().empty() && inbox.received().back() == kept(messages[i]); },
                          std::chrono::milliseconds(200));
      })) << "message "
          << i;
    }
  }

  FreeDomain free = take_free_domain();
  Participant client;
};

const std::string long_text(100'000, 'x');

TEST_F(WireTest, AJoinArrivesUnchanged) {
  expect_round_trip<Join>(client, free.server,
                          {{.client = 0xfedcba9876543210,
                            .controller = "Näherung",
                            .host = "h",
                            .process = 77,
                            .robots = {"all", "", "team/sbot_*"}},
                           {.client = 1},
                           {.client = 1, .controller = long_text, .host = long_text, .robots = {long_text, "a"}},
                           {.client = 1, .controller = "short again", .robots = {"b"}},
                           {.client = 1, .robots = std::vector<std::string>(5000, "sbot")}});
}

TEST_F(WireTest, AnAdmitArrivesUnchanged) {
  const AdmittedRobot robot{.robot = 3,
                            .name = "team/sbot_3",
                            .team = 1,
                            .description = 1,
                            .seed = ~std::uint64_t{0},
                            .period = 2,
                            .phase = 1,
                            .delay = 4,
                            .mode = Mode::free};
  expect_round_trip<Admit>(
      free.server, client,
      {{.client = 5,
        .run = 2,
        .epoch = 9,
        .start_reason = StartReason::takeover,
        .tick = 1'000'000'000'000,
        .step_ns = 10'000'000,
        .teams = {{.name = "a", .controller = "none"},
                  {"b", "braitenberg", {{"gain", {"1e-3"}}, {"track.weights", {"-1", "", "2"}}, {"", {}}}}},
        .robots = {robot, {}, robot}},
       {.client = 5, .status = AdmitStatus::refused, .reason = "robot 3 is driven by 'sweeper' on host h"},
       {.client = 5, .robots = std::vector<AdmittedRobot>(3000, robot)}});
}

TEST_F(WireTest, ARobotDescriptionArrivesUnchanged) {
  const Channel channel{
      .name = "proximity/0/reading", .unit = "1", .size = 3, .lower = -0.5, .upper = 1e300, .neutral = -0.0};
  expect_round_trip<RobotDescription>(
      free.server, client,
      {{.description = 1, .model = "sbot", .observation = {channel, {}}, .command = {channel}},
       {.description = 1},
       {.description = 1,
        .model = long_text,
        .observation = std::vector<Channel>(2000, channel),
        .command = {channel}}});
}

TEST_F(WireTest, ARobotTreeArrivesUnchanged) {
  const FramePose pose{{1.0, -0.0, 1e300}, {0.5, 0.5, -0.5, 0.5}};
  const JointInfo joint{.name = "wheel",
                        .type = JointInfo::Type::universal,
                        .parent = JointInfo::world,
                        .child = 1,
                        .pose = pose,
                        .frame = {{}, pose.orientation},
                        .axes = {{{0, 0, 1}, -1.0, std::numeric_limits<double>::infinity(), 3.0, 4.0}, {}},
                        .thread_pitch = -0.25,
                        .devices = {"encoder", "", "motor"}};
  expect_round_trip<RobotTree>(
      free.server, client,
      {{.description = 1,
        .tree = {.links = {{"hull", 0.4, {1, 2, 3}}, {}}, .joints = {joint, {}}, .sensors = {{"lidar", 1, pose}}}},
       {.description = 1},
       {.description = 1, .tree = {.links = {}, .joints = std::vector<JointInfo>(500, joint), .sensors = {}}}});
}

TEST_F(WireTest, AnObservationArrivesUnchanged) {
  const std::vector<std::uint32_t> robots{0, 7, 4'000'000'000};
  const std::vector<double> values{0.1, -0.0, 5e-324, 1.7976931348623157e308};
  const std::vector<double> many(50'000, 0.3);
  expect_round_trip<Observation>(
      free.server, client,
      {{.client = 5, .run = 1, .resent = 2, .epoch = 3, .tick = 4, .time_ns = -5, .robots = robots, .values = values},
       {.client = 5},
       {.client = 5, .tick = 1, .robots = robots, .values = many},
       {.client = 5, .tick = 2, .values = values}});
}

TEST_F(WireTest, ACommandArrivesUnchanged) {
  const std::vector<std::uint32_t> robots{1, 2};
  const std::vector<double> values{0.2, -0.2};
  const std::vector<double> many(50'000, -0.3);
  expect_round_trip<Command>(
      client, free.server,
      {{.client = 5, .run = 1, .epoch = 3, .tick = 4, .robots = robots, .values = values, .resent = 6},
       {.client = 5, .tick = 5},
       {.client = 5, .tick = 6, .robots = robots, .values = many}});
}

TEST_F(WireTest, AWorldStateArrivesUnchanged) {
  const std::vector<std::uint32_t> robots{1};
  const std::vector<double> poses{1, 2, 3, 0, 0, 0, 1};
  const std::vector<double> many(20'000, 0.5);
  expect_round_trip<WorldState>(
      free.server, client,
      {{.run = 1, .tick = 2, .time_ns = 3, .state_hash = 0x8000000000000001, .robots = robots, .poses = poses},
       {.tick = 4},
       {.tick = 5, .poses = many}});
}

TEST_F(WireTest, ASceneAndItsUpdatesArriveUnchanged) {
  const std::vector<std::uint8_t> a{1, 255}, b{2}, c{3, 4}, d{5};
  expect_round_trip<SceneDescription>(free.server, client, {{.run = 1, .revision = 2, .scene = a}, {.run = 3}});
  expect_round_trip<SceneUpdate>(
      free.server, client,
      {{.run = 1, .revision = 2, .tick = 3, .frame = a, .signals = b, .contacts = c, .robots = d}, {.tick = 4}});
}

TEST_F(WireTest, StateOfControllersArrivesUnchangedEitherWay) {
  const std::vector<std::uint8_t> part(largest_state_part, 7);
  const std::vector<ControllerState> states{
      {.client = 5, .run = 1, .kind = StateKind::here, .epoch = 2, .tick = 3, .size = 4, .offset = 6, .data = part},
      {.client = 5}};
  expect_round_trip(free.server, client, states);
  expect_round_trip(client, free.server, states);
}

TEST_F(WireTest, AReportArrivesUnchangedEitherWay) {
  const std::vector<Report> reports{{.client = 5,
                                     .run = 1,
                                     .kind = ReportKind::rejected,
                                     .tick = 3,
                                     .reason = "not_finite",
                                     .text = "value 3 is NaN"},
                                    {.client = 5, .kind = ReportKind::failed, .text = long_text},
                                    {.client = 5}};
  expect_round_trip(free.server, client, reports);
  expect_round_trip(client, free.server, reports);
}

// One of each operation, with distinct values in all fields.
const std::vector<Operation> all_operations = {
    GetSimulatorFeatures{},
    GetSimulationState{},
    SetSimulationState{SimulationState::quitting},
    StepSimulation{2},
    ResetSimulation{.scope = 255, .seed = ~std::uint64_t{0}},
    GetEntities{"f"},
    GetEntityState{"team/sbot_1"},
    SetEntityState{"e", Pose{{1, 2, 3}, {0.1, 0.2, 0.3, 0.4}}, Twist{{4, 5, 6}, {7, 8, 9}}},
    SpawnEntity{.entity = "e",
                .allow_renaming = true,
                .uri = "u",
                .resource_string = long_text,
                .pose = {{1, 2, 3}, {0.1, 0.2, 0.3, 0.4}},
                .team = "t"},
    DeleteEntity{"e"},
    GetStatus{},
    SetSpeed{0.1},
    SetLight{"e", true, -0.0, Vector3{0.1, 0.2, 0.3}},
    ApplyForce{"e", "l", {-1, -2, -3}, {-4, -5, -6}, -7},
    SaveSnapshot{},
    GetData{4},
    PutData{3, 4, std::vector<std::uint8_t>(largest_part, 0xfe)},
    LoadSnapshot{},
    StartRecording{"poses: true"},
    GetRecording{5},
    StopRecording{},
    GoBack{-7},
    GetHistory{6},
    AdvanceTime{.steps = 8, .release = true},
    GetExperiment{9},
    UnknownOperation{4711},
};

TEST_F(WireTest, ARequestOfEachOperationArrivesUnchanged) {
  ASSERT_EQ(all_operations.size(), std::variant_size_v<Operation>);
  std::vector<Request> requests;
  for (std::size_t i = 0; i < all_operations.size(); ++i) {
    ASSERT_EQ(all_operations[i].index(), i) << "one of each";
    requests.push_back({5, 1, ~std::uint64_t{0} - i, "Näherung", all_operations[i]});
  }
  requests.push_back({.client = 5, .operation = ResetSimulation{}});
  requests.push_back({.client = 5, .operation = SetEntityState{"e"}});
  requests.push_back({.client = 5, .operation = SetEntityState{.twist = Twist{}}});
  requests.push_back({.client = 5, .operation = SetLight{"e"}});
  expect_round_trip<Request>(client, free.server, requests);
}

TEST(WireFields, AnIncompleteListIsDetected) {
  EXPECT_FALSE(lists_all_members<HalfListed>());
  EXPECT_FALSE(lists_all_fields<HalfListed>());
  EXPECT_FALSE(lists_all_members<TwiceListed>());
  EXPECT_TRUE(lists_all_fields<TwiceListed>());
  EXPECT_EQ(member_count<HalfListed>(), 2u);
  EXPECT_EQ(member_count<cohort_v1_Request>(), 32u) << "as cohort.idl has them";
  EXPECT_TRUE(lists_all_members<Request>());
  EXPECT_TRUE(lists_all_fields<Request>());
}

// Programs of earlier versions rely on these: docs/protocol.md's numbers, and fields side by side.
TEST(WireCompatibility, ARequestHasItsFieldsWhereCohortIdlHasThem) {
  const auto sample_of = [](const Operation& operation, const auto& check) {
    const Request request{.client = 5, .number = 6, .label = "l", .operation = operation};
    const Codec<Request>::Outgoing outgoing(request);
    EXPECT_EQ(outgoing.sample.client, 5u);
    EXPECT_EQ(outgoing.sample.minor, minor_version);
    EXPECT_EQ(outgoing.sample.number, 6u);
    EXPECT_STREQ(outgoing.sample.label, "l");
    check(outgoing.sample);
  };
  sample_of(SpawnEntity{.entity = "e", .uri = "u", .resource_string = "r", .pose = {{1, 2, 3}, {}}, .team = "t"},
            [](const cohort_v1_Request& sample) {
              EXPECT_EQ(sample.operation, 8u);
              EXPECT_STREQ(sample.entity, "e");
              EXPECT_STREQ(sample.uri, "u");
              EXPECT_STREQ(sample.resource_string, "r");
              EXPECT_STREQ(sample.filter, "t") << "the team";
              EXPECT_EQ(sample.pose.position.y, 2.0);
              EXPECT_EQ(sample.pose.orientation.w, 1.0);
            });
  sample_of(ResetSimulation{.seed = 7}, [](const cohort_v1_Request& sample) {
    EXPECT_EQ(sample.operation, 4u);
    EXPECT_TRUE(sample.set_seed);
    EXPECT_EQ(sample.seed, 7u);
  });
  sample_of(StartRecording{"r"}, [](const cohort_v1_Request& sample) {
    EXPECT_EQ(sample.operation, 108u);
    EXPECT_STREQ(sample.resource_string, "r");
  });
  sample_of(GetHistory{7}, [](const cohort_v1_Request& sample) {
    EXPECT_EQ(sample.operation, 112u);
    EXPECT_EQ(sample.offset, 7u);
  });
  sample_of(GetExperiment{8}, [](const cohort_v1_Request& sample) {
    EXPECT_EQ(sample.operation, 114u);
    EXPECT_EQ(sample.offset, 8u);
  });
}

// `cohort ctl` of 1.2 had `steps` 1 in every request, and the view `set_pose` where it spawns.
TEST(WireCompatibility, FieldsThatAnOperationDoesNotUseAreIgnored) {
  cohort_v1_Request sample{};
  sample.operation = 8;
  sample.steps = 1;
  sample.set_pose = sample.set_seed = true;
  sample.force.x = std::numeric_limits<double>::quiet_NaN();
  sample.pose.orientation.w = 1.0;
  EXPECT_EQ(Codec<Request>::decode(sample).operation, Operation(SpawnEntity{}));
  sample.operation = 4711;
  EXPECT_EQ(Codec<Request>::decode(sample).operation, Operation(UnknownOperation{4711}));
  EXPECT_EQ(Codec<Request>::decode(sample).code(), static_cast<OperationCode>(4711));
}

TEST_F(WireTest, AReplyToEachOperationArrivesUnchanged) {
  const ControllerStatus controller{.label = "c",
                                    .client = 1,
                                    .robots = {2, 3},
                                    .alive = true,
                                    .awaited = true,
                                    .awaited_ns = 4,
                                    .due_tick = 5,
                                    .answers = 6,
                                    .late = 7,
                                    .rejected = 8,
                                    .resent = 9,
                                    .answer_p50_ns = 10,
                                    .answer_p99_ns = 11};
  const std::vector<Returned> all = {
      std::monostate{},
      SimulatorFeatures{{1, 2}, {"sdf", ""}},
      EntityNames{std::vector<std::string>(3000, "team/sbot")},
      EntityName{"n"},
      EntityState{"x", {{1, 2, 3}, {4, 5, 6, 7}}, {{8, 9, 10}, {11, 12, 13}}},
      SimulationStatus{.experiment = "e",
                       .seed = 1,
                       .started = true,
                       .step_ns = 2,
                       .duration_ns = 3,
                       .speed = 4,
                       .real_time_factor = 5,
                       .state_hash = 6,
                       .robots = 7,
                       .awaited_count = 8,
                       .awaited = {"a", "b"},
                       .waiting_ns = 9,
                       .controllers = {controller, {}, controller}},
      DataPart{10, 11, std::vector<std::uint8_t>(largest_part, 3)},
      HistoryPart{12, 13, {1, 2}},
  };
  ASSERT_EQ(all.size(), std::variant_size_v<Returned>);
  std::vector<Reply> replies;
  for (const Operation& operation : all_operations) {
    const auto returned = std::visit(
        [&]<class One>(const One&) -> const Returned& {
          if constexpr (requires { typename One::Returned; })
            return *std::ranges::find_if(
                all, [](const Returned& each) { return std::holds_alternative<typename One::Returned>(each); });
          return all.front();
        },
        operation);
    replies.push_back(
        {5, 6, code_of(operation), ResultCode::not_permitted, "no", SimulationState::paused, 7, 8, 9, returned});
  }
  // There is no state of an entity that was not found, and no status.
  replies.push_back({.client = 5, .operation = OperationCode::get_entity_state, .result = ResultCode::not_found});
  replies.push_back({.client = 5, .operation = OperationCode::get_status});
  expect_round_trip<Reply>(free.server, client, replies);
}

TEST_F(WireTest, ALateReaderGetsTheServersMessagesForLateJoiners) {
  Writer<RobotDescription> descriptions(free.server);
  Writer<Report> reports(free.server);
  for (std::uint32_t i = 0; i < 3; ++i) {
    descriptions.write({.description = i});
    reports.write({.client = 5, .tick = i});
  }
  Inbox<RobotDescription> late_descriptions(client);
  Inbox<Report> late_reports(client);
  EXPECT_TRUE(late_descriptions.waits_for(3)) << "one for each description";
  EXPECT_TRUE(late_reports.waits_for(3)) << "the last 16";
}

TEST_F(WireTest, ASecondServerOnADomainFailsWithAdvice) {
  testing::internal::CaptureStderr();
  try {
    Participant::server(free.domain);
    ADD_FAILURE() << "two servers on one domain";
  } catch (const DomainTaken& error) {
    EXPECT_NE(std::string(error.what()).find("UDP port " + std::to_string(discovery_port(free.domain))),
              std::string::npos);
    EXPECT_NE(std::string(error.what()).find("another domain"), std::string::npos);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "the middleware's own complaints are not for users";
}

TEST(WireAddress, MistakesAreNamed) {
  const auto message_of = [](auto&& tried) -> std::string {
    try {
      tried();
    } catch (const WireError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message_of([] { Participant::client(60, "no-such-host.invalid"); }).find("no-such-host.invalid"),
            std::string::npos);
  EXPECT_NE(message_of([] { Participant::server(60, "203.0.113.7"); }).find("no active network interface"),
            std::string::npos);
  EXPECT_NE(message_of([] { Participant::server(233); }).find("0 to 232"), std::string::npos);
}

TEST_F(WireTest, APartitionKeepsClientsApart) {
  auto second = Participant::client(free.domain);
  Inbox<Report> first_inbox(client, partition_of(1));
  Inbox<Report> second_inbox(second, partition_of(2));
  Writer<Report> to_first(free.server, partition_of(1));
  Writer<Report> to_second(free.server, partition_of(2));
  to_first.write({.client = 1, .text = "first"});
  to_second.write({.client = 2, .text = "second"});
  ASSERT_TRUE(first_inbox.waits_for(1));
  ASSERT_TRUE(second_inbox.waits_for(1));
  EXPECT_EQ(first_inbox.received(), (std::vector<Report>{{.client = 1, .text = "first"}}));
  EXPECT_EQ(second_inbox.received(), (std::vector<Report>{{.client = 2, .text = "second"}}));
  EXPECT_EQ(to_first.matched(), 1u);
}

TEST_F(WireTest, NoCallbackRunsOnceAReaderIsGone) {
  Writer<Command> writer(client);
  std::atomic<bool> done{false};
  std::thread flood([&] {
    for (std::uint64_t tick = 0; !done; ++tick) writer.write({.client = 5, .tick = tick});
  });
  for (int round = 0; round < 20; ++round) {
    auto calls = std::make_unique<std::atomic<int>>(0);
    std::optional<Reader<Command>> reader;
    reader.emplace(free.server, Reader<Command>::Callbacks{[&](const Command&, const Sender&) { ++*calls; }, nullptr});
    EXPECT_TRUE(eventually([&] { return *calls > 10; }));
    reader.reset();
    calls.reset();  // a callback that ran now would be a use after free
  }
  done = true;
  flood.join();
}

TEST_F(WireTest, AWriterThatLeavesIsReportedDeadAtOnce) {
  std::atomic<std::uint64_t> alive{0};
  std::atomic<std::uint64_t> dead{0};
  std::atomic<std::uint64_t> sender_of_message{0};
  Reader<Join> reader(free.server, {[&](const Join&, const Sender& sender) { sender_of_message = sender.writer; },
                                    [&](const Sender& sender, bool lives) { (lives ? alive : dead) = sender.writer; }});
  {
    Writer<Join> writer(client);
    writer.write({.client = 5});
    ASSERT_TRUE(eventually([&] { return alive != 0 && sender_of_message != 0; }));
  }
  ASSERT_TRUE(eventually([&] { return dead != 0; }));
  EXPECT_EQ(alive, dead);
  EXPECT_EQ(alive, sender_of_message);
}

TEST_F(WireTest, AllMessagesOfAClientHaveTheSameParticipant) {
  auto second = Participant::client(free.domain);
  std::mutex mutex;
  std::map<std::uint64_t, std::set<std::uint64_t>> participants;  // by client
  const auto note = [&](std::uint64_t id, const Sender& sender) {
    const std::lock_guard lock(mutex);
    participants[id].insert(sender.participant);
  };
  std::atomic<int> messages{0};
  Reader<Join> joins(free.server, {[&](const Join& join, const Sender& sender) {
                                     note(join.client, sender);
                                     ++messages;
                                   },
                                   nullptr});
  Reader<Report> reports(free.server, {[&](const Report& report, const Sender& sender) {
                                         note(report.client, sender);
                                         ++messages;
                                       },
                                       nullptr});
  Writer<Join> first_join(client);
  Writer<Report> first_report(client);
  Writer<Join> second_join(second);
  first_join.write({.client = 1});
  first_report.write({.client = 1});
  second_join.write({.client = 2});
  ASSERT_TRUE(eventually([&] { return messages == 3; }));
  EXPECT_EQ(participants[1].size(), 1u);
  EXPECT_FALSE(participants[1].contains(0));
  EXPECT_NE(participants[1], participants[2]);
}

// The other process of the next test: joins, and stays until it is killed.
TEST(WireTestProcess, DISABLED_JoinsAndStays) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  const char* domain = std::getenv("COHORT_TEST_DOMAIN");
  ASSERT_NE(domain, nullptr);
  auto client = Participant::client(static_cast<std::uint32_t>(std::stoul(domain)));
  Writer<Report> reports(client);
  Writer<Join> writer(client);
  writer.write({.client = 5});
  for (;;) ::pause();
}

TEST(WireLiveliness, AKilledClientIsDetectedByTheLeaseOfItsJoin) {
  auto free = take_free_domain();
  std::atomic<bool> joined{false};
  std::atomic<bool> dead{false};
  std::atomic<std::uint32_t> reports_matched{0};
  // Its Report has no lease but the participant's, which is longer: it is still there when the Join's lease is over.
  const Reader<Report> reports(free.server, {[](const Report&, const Sender&) {}, nullptr});
  Reader<Join> reader(free.server, {[&](const Join&, const Sender&) { joined = true; },
                                    [&](const Sender&, bool alive) {
                                      if (!alive) reports_matched = reports.matched();
                                      dead = !alive;
                                    }});
  ::setenv("COHORT_TEST_DOMAIN", std::to_string(free.domain).c_str(), 1);
  std::string program = "/proc/self/exe";
  std::string filter = "--gtest_filter=WireTestProcess.DISABLED_JoinsAndStays";
  std::string disabled_too = "--gtest_also_run_disabled_tests";
  char* arguments[] = {program.data(), filter.data(), disabled_too.data(), nullptr};
  pid_t process = 0;
  ASSERT_EQ(::posix_spawn(&process, "/proc/self/exe", nullptr, nullptr, arguments, environ), 0);
  const bool came = eventually([&] { return joined && reports.matched() == 1; });
  ::kill(process, SIGKILL);
  ::waitpid(process, nullptr, 0);
  ASSERT_TRUE(came);
  ASSERT_TRUE(eventually([&] { return dead.load(); }));
  EXPECT_EQ(reports_matched, 1u);
}

TEST(WireNames, PartitionAndPortAreThoseOfTheProtocol) {
  EXPECT_EQ(partition_of(0x0123456789abcdef), "c0123456789abcdef");
  EXPECT_EQ(partition_of(1), "c0000000000000001");
  EXPECT_EQ(discovery_port(0), 7410);
  EXPECT_EQ(discovery_port(79), 7410 + 250 * 79);
}

}  // namespace
}  // namespace cohort::wire
