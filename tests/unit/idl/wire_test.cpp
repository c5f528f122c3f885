#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "idl/dds/transport.hpp"
#include "idl/wire/control_messages.hpp"
#include "tests/support/free_domain.hpp"

namespace cohort::wire {
namespace {

using namespace test;

// Messages as they can be kept and compared: views become vectors.
std::string show(const std::string& text) { return "'" + text + "'"; }
template <class Number>
requires std::is_arithmetic_v<Number> std::string show(Number number) { return std::to_string(number); }
std::string show(const Channel& c) {
  return show(c.name) + show(c.unit) + show(c.size) + show(c.lower) + show(c.upper) + show(c.neutral);
}
std::string show(const AdmittedRobot& r) {
  return show(r.robot) + show(r.name) + show(r.team) + " " + show(r.description) + show(r.seed) + " " + show(r.period) +
         " " + show(r.phase) + " " + show(r.delay);
}
std::string show(const Parameter& p);
std::string show(const Team& t);
std::string show(const Vector3& v);
std::string show(const Pose& p);
std::string show(const Twist& t);
std::string show(const EntityState& s);
std::string show(const ControllerStatus& s);
std::string show(const SimulationStatus& s);
template <class List>
requires requires(const List& list) { list.size(), list.data()[0]; }
std::string show_list(const List& list) {
  std::string text = "[";
  for (const auto& element : list) text += show(element) + ",";
  return text + "]";
}
std::string show(const Parameter& p) { return show(p.name) + show_list(p.values); }
std::string show(const Team& t) { return show(t.name) + show(t.controller) + show_list(t.parameters); }
template <class... Fields>
std::string show_all(const Fields&... fields) {
  return ((show(fields) + " ") + ...);
}
std::string show(const Join& m) {
  return show_all(m.client, m.minor, m.controller, m.host, m.process) + show_list(m.robots);
}
std::string show(const Admit& m) {
  return show_all(m.client, static_cast<std::uint32_t>(m.status), m.reason, m.run, m.epoch,
                  static_cast<std::uint32_t>(m.start_reason), m.tick, m.step_ns) +
         show_list(m.teams) + show_list(m.robots);
}
std::string show(const RobotDescription& m) {
  return show_all(m.description, m.model) + show_list(m.observation) + show_list(m.command);
}
std::string show(const Observation& m) {
  return show_all(m.client, m.run, m.resent, m.epoch, m.tick, m.time_ns) + show_list(m.robots) + show_list(m.values);
}
std::string show(const Command& m) {
  return show_all(m.client, m.run, m.epoch, m.tick) + show_list(m.robots) + show_list(m.values);
}
std::string show(const WorldState& m) {
  return show_all(m.run, m.tick, m.time_ns, m.state_hash) + show_list(m.robots) + show_list(m.poses);
}
std::string show(const Vector3& v) { return show_all(v.x, v.y, v.z); }
std::string show(const Pose& p) {
  const Quaternion& q = p.orientation;
  return show(p.position) + show_all(q.x, q.y, q.z, q.w);
}
std::string show(const Twist& t) { return show(t.linear) + show(t.angular); }
std::string show(const EntityState& s) { return show(s.entity) + show(s.pose) + show(s.twist); }
std::string show(const ControllerStatus& s) {
  return show_all(s.label, s.client, s.alive, s.awaited, s.awaited_ns, s.due_tick, s.answers, s.late, s.rejected,
                  s.resent, s.answer_p50_ns, s.answer_p99_ns) +
         show_list(s.robots);
}
std::string show(const SimulationStatus& s) {
  return show_all(s.experiment, s.seed, s.started, s.step_ns, s.duration_ns, s.speed, s.real_time_factor, s.state_hash,
                  s.robots, s.awaited_count, s.waiting_ns) +
         show_list(s.awaited) + show_list(s.controllers);
}
std::string show(const Request& m) {
  return show_all(m.client, m.minor, m.number, static_cast<std::uint32_t>(m.operation), m.label,
                  static_cast<std::uint32_t>(m.state), m.scope, m.set_seed, m.seed, m.steps, m.speed, m.filter,
                  m.entity, m.allow_renaming, m.uri, m.resource_string, m.set_pose, m.pose, m.set_twist, m.twist, m.on,
                  m.set_intensity, m.intensity, m.set_color, m.color, m.link, m.force, m.torque, m.duration_ns, m.size,
                  m.offset) +
         show_list(m.data);
}
std::string show(const Reply& m) {
  return show_all(m.client, m.number, static_cast<std::uint32_t>(m.operation), static_cast<std::uint32_t>(m.result),
                  m.error_message, static_cast<std::uint32_t>(m.state), m.run, m.tick, m.time_ns, m.entity, m.size,
                  m.offset) +
         show_list(m.features) + show_list(m.spawn_formats) + show_list(m.entities) + show_list(m.states) +
         show_list(m.status) + show_list(m.data);
}
std::string show(const Report& m) {
  return show_all(m.client, m.run, static_cast<std::uint32_t>(m.kind), m.tick, m.reason, m.text);
}

// What a reader received, as text, in order.
template <class Message>
class Inbox {
 public:
  explicit Inbox(Participant& participant, const std::string& partition = "", int depth = 8)
      : reader_(participant, {[this](const Message& message, const Sender&) { add(show(message)); }, nullptr},
                partition, depth) {}

  std::vector<std::string> received() const {
    const std::lock_guard lock(mutex_);
    return received_;
  }
  bool waits_for(std::size_t count) const {
    return eventually([&] { return received().size() >= count; });
  }
  std::uint32_t matched() const { return reader_.matched(); }

 private:
  void add(std::string text) {
    const std::lock_guard lock(mutex_);
    received_.push_back(std::move(text));
  }

  mutable std::mutex mutex_;
  std::vector<std::string> received_;
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
        return eventually([&] { return !inbox.received().empty() && inbox.received().back() == show(messages[i]); },
                          std::chrono::milliseconds(200));
      })) << show(messages[i]).substr(0, 1000);
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
                            .delay = 4};
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
  expect_round_trip<Command>(client, free.server,
                             {{.client = 5, .run = 1, .epoch = 3, .tick = 4, .robots = robots, .values = values},
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

TEST_F(WireTest, ARequestArrivesUnchanged) {
  Request all;
  all.client = 5;
  all.number = ~std::uint64_t{0};
  all.operation = Operation::spawn_entity;
  all.label = "Näherung";
  all.state = SimulationState::quitting;
  all.scope = 255;
  all.set_seed = all.allow_renaming = all.set_pose = all.set_twist = all.on = all.set_intensity = all.set_color = true;
  all.seed = 1;
  all.steps = 2;
  all.speed = 0.1;
  all.filter = "f";
  all.entity = "team/sbot_1";
  all.uri = "u";
  all.resource_string = long_text;
  all.pose = {{1, 2, 3}, {0.1, 0.2, 0.3, 0.4}};
  all.twist = {{4, 5, 6}, {7, 8, 9}};
  all.intensity = -0.0;
  all.color = {0.1, 0.2, 0.3};
  all.link = "l";
  all.force = {-1, -2, -3};
  all.torque = {-4, -5, -6};
  all.duration_ns = -7;
  all.size = 3;
  all.offset = 4;
  all.data.assign(largest_part, 0xfe);
  expect_round_trip<Request>(client, free.server, {all, {.client = 5}, all});
}

TEST_F(WireTest, AReplyArrivesUnchanged) {
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
  const SimulationStatus status{.experiment = "e",
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
                                .controllers = {controller, {}, controller}};
  Reply all;
  all.client = 5;
  all.number = 6;
  all.operation = Operation::get_status;
  all.result = ResultCode::not_permitted;
  all.error_message = "no";
  all.state = SimulationState::paused;
  all.run = 7;
  all.tick = 8;
  all.time_ns = 9;
  all.entity = "n";
  all.features = {1, 2};
  all.spawn_formats = {"sdf"};
  all.entities = std::vector<std::string>(3000, "team/sbot");
  all.states = {{"x", {{1, 2, 3}, {4, 5, 6, 7}}, {{8, 9, 10}, {11, 12, 13}}}, {}};
  all.status = {status, {}, status};
  all.size = 10;
  all.offset = 11;
  all.data.assign(largest_part, 3);
  expect_round_trip<Reply>(free.server, client, {all, {.client = 5}, all});
}

TEST_F(WireTest, ALateReaderGetsWhatTheServerHasToSayToLateJoiners) {
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

TEST_F(WireTest, ASecondServerOnADomainIsToldWhatToDo) {
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
  EXPECT_NE(message_of([] { Participant::server(60, "203.0.113.7"); }).find("no network interface"), std::string::npos);
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
  EXPECT_EQ(first_inbox.received(), std::vector{show(Report{.client = 1, .text = "first"})});
  EXPECT_EQ(second_inbox.received(), std::vector{show(Report{.client = 2, .text = "second"})});
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

TEST_F(WireTest, WhatAClientSendsIsKnownToBeOfOneParticipant) {
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

TEST(WireLiveliness, AKilledClientIsNoticedByTheLeaseOfItsJoin) {
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
