// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <csignal>

#include "idl/dds/transport.hpp"
#include "tests/support/control.hpp"
#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {
namespace {

std::uint64_t tick_of(const nlohmann::json& event) { return event["tick"]; }

// Without a controller, a robot that does not require one does nothing. With one it receives frames from the tick of
// the event on. When the controller leaves, the robot stops again, and the run continues.
TEST(JoinAndLeaveAtTickBoundariesOnly, ControllersThatAreNotRequired) {
  const FieldOfRobots field(4, 12.0, ", required: false",
                            "constant, parameters: {treel/left/velocity: 0.1, "
                            "treel/right/velocity: 0.1}");
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--paused"}), {{"COHORT_LOG", "info"}});
  control(domain, {"step", "100"});  // without a controller at first
  Process early(FieldOfRobots::host(domain, "0..1", "constant"));
  ASSERT_TRUE(server.wait_for_output("drives swarm/sbot_0")) << server.output();
  control(domain, {"step", "100"});
  Process late(FieldOfRobots::host(domain, "2", "constant"));
  ASSERT_TRUE(server.wait_for_output("drives swarm/sbot_2")) << server.output();
  control(domain, {"step", "100"});
  early.signal(SIGTERM);
  ASSERT_TRUE(server.wait_for_output("the controller of swarm/sbot_0 and 1 more, is gone")) << server.output();
  control(domain, {"step", "100"});
  Process again(FieldOfRobots::host(domain, "0", "constant"));
  ASSERT_TRUE(comes_to_drive(domain, 0)) << server.output();
  control(domain, {"resume"});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(late.wait_for_exit(), 0) << late.output();
  EXPECT_EQ(again.wait_for_exit(), 0) << again.output();

  const auto summary = field.summary();
  EXPECT_EQ(summary["ticks"], 1200);
  const auto joined = events_of(summary, "joined");
  const auto lost = events_of(summary, "lost");
  ASSERT_EQ(joined.size(), 3u) << summary.dump(1);
  ASSERT_EQ(lost.size(), 1u) << summary.dump(1);
  EXPECT_EQ(tick_of(joined[0]), 100u);
  EXPECT_EQ(tick_of(joined[1]), 200u);
  EXPECT_EQ(tick_of(lost[0]), 300u);
  EXPECT_EQ(tick_of(joined[2]), 400u);
}

// The run never waits for a robot in free mode: its controller may be stopped for any time.
TEST(JoinAndLeaveAtTickBoundariesOnly, AStoppedFreeControllerDelaysNoOthers) {
  const FieldOfRobots field(2, 6.0, ", mode: free, on_late: zero, deadline: 0.2",
                            "constant, parameters: {treel/left/velocity: 0.1, "
                            "treel/right/velocity: 0.1}");
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--paused", "--speed", "2"}), {{"COHORT_LOG", "info"}});
  Process controller(FieldOfRobots::host(domain, "all", "constant"));
  // A run does not wait for free controllers: one that is stopped before it has joined would miss nothing.
  ASSERT_TRUE(server.wait_for_output("drives swarm/sbot_0")) << server.output();
  control(domain, {"step", "10"});
  controller.signal(SIGSTOP);
  control(domain, {"resume"});
  EXPECT_TRUE(server.wait_for_output("missed: swarm/sbot_0")) << server.output();
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  controller.signal(SIGCONT);
  const auto summary = field.summary();
  EXPECT_EQ(summary["ticks"], 600);
  ASSERT_GE(summary["misses"].size(), 2u);
  EXPECT_EQ(summary["misses"][0]["on_late"], "zero");
  EXPECT_GE(summary["misses"][0]["waited_s"].get<double>(), 0.2);
  EXPECT_GT(summary["lateness_us"]["max"].get<double>(), 0.0);
}

const Process::Environment fails_in_start = {{"COHORT_TEST_FAULT", "throw in start"}};

std::vector<std::string> unfit_host(const ReservedDomain& domain, const std::string& robots) {
  return FieldOfRobots::host(domain, robots, test_controller("misbehaving"));
}

TEST(JoinAndLeaveAtTickBoundariesOnly, AControllerThatFailsInStartIsRefusedAndTheRunWaitsForAnother) {
  const FieldOfRobots field(4, 3.0);
  const std::string expected = run_experiment(field.file(), {"--controllers", "inprocess"})["state_hash"];
  const ReservedDomain domain;
  Process server(field.serve(domain));
  Process early(FieldOfRobots::host(domain, "0..1"));
  for (int times = 0; times < 2; ++times) {
    Process unfit(unfit_host(domain, "2..3"), fails_in_start);
    EXPECT_EQ(unfit.wait_for_exit(), 1) << unfit.output();
    EXPECT_NE(unfit.output().find("'swarm/sbot_2' failed in start at tick 0: a fault on purpose"), std::string::npos)
        << unfit.output();
  }
  Process fit(FieldOfRobots::host(domain, "2..3"));
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(early.wait_for_exit(), 0) << early.output();
  EXPECT_EQ(fit.wait_for_exit(), 0) << fit.output();
  const auto summary = field.summary();
  EXPECT_EQ(summary["state_hash"], expected);
  const auto refused = events_of(summary, "refused");
  ASSERT_EQ(refused.size(), 2u) << summary.dump(1);
  const std::string text = refused[0]["text"];
  for (const char* said : {"Misbehaving (process", "team 'swarm'", "'swarm/sbot_2'", "a fault on purpose"})
    EXPECT_NE(text.find(said), std::string::npos) << text;
}

// A client that only joins and fails in start, and notes the answer.
class Applicant {
 public:
  Applicant(const ReservedDomain& domain, std::uint32_t minor, const std::string& robots)
      : join_{.client = ++last_id, .minor = minor, .controller = "applicant", .host = "here", .robots = {robots}},
        participant_(wire::Participant::client(domain.number())),
        admits_(participant_, {[this](const wire::Admit& admit, const wire::Sender&) { status_ = admit.status; }, {}},
                wire::partition_of(join_.client)),
        reports_(participant_),
        joins_(participant_) {}
  wire::AdmitStatus refusal() {
    EXPECT_TRUE(eventually([&] {
      joins_.write(join_);
      if (status_ == wire::AdmitStatus::admitted)
        reports_.write({.client = join_.client, .kind = wire::ReportKind::failed, .reason = wire::failed_in_start});
      return status_ != none && status_ != wire::AdmitStatus::admitted;
    }));
    return status_;
  }

 private:
  static constexpr auto none = static_cast<wire::AdmitStatus>(99);
  static inline std::uint64_t last_id = 0x1000;
  const wire::Join join_;
  std::atomic<wire::AdmitStatus> status_ = none;
  wire::Participant participant_;
  wire::Reader<wire::Admit> admits_;
  wire::Writer<wire::Report> reports_;
  wire::Writer<wire::Join> joins_;
};

TEST(JoinAndLeaveAtTickBoundariesOnly, ARefusalHasACodeThatOldClientsKnow) {
  const FieldOfRobots field(2, 1e5, ", required: false");
  const ReservedDomain domain;
  Process server(field.serve(domain));
  Process holder(FieldOfRobots::host(domain, "0"));
  ASSERT_TRUE(comes_to_drive(domain, 0)) << server.output();
  const std::vector<std::pair<std::string, wire::AdmitStatus>> refused = {{"nobody", wire::AdmitStatus::unknown_robot},
                                                                          {"0", wire::AdmitStatus::robot_taken},
                                                                          {"1", wire::AdmitStatus::failed_in_start}};
  for (const auto& [robots, status] : refused) {
    EXPECT_EQ(Applicant(domain, wire::minor_version, robots).refusal(), status) << robots;
    EXPECT_EQ(Applicant(domain, wire::first_minor_with_reasons - 1, robots).refusal(), wire::AdmitStatus::refused)
        << robots;
  }
  control(domain, {"shutdown"});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
}

TEST(JoinAndLeaveAtTickBoundariesOnly, ATakeoverThatFailsInStartKeepsTheBits) {
  const FieldOfRobots field(2, 20.0);
  const std::string expected = run_experiment(field.file(), {"--controllers", "inprocess"})["state_hash"];
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--speed", "8"}), {{"COHORT_LOG", "info"}});
  {
    Process first(FieldOfRobots::host(domain, "all"));
    ASSERT_TRUE(server.wait_for_output("simulated")) << server.output();
  }
  Process unfit(unfit_host(domain, "all"), fails_in_start);
  EXPECT_EQ(unfit.wait_for_exit(), 1) << unfit.output();
  Process second(FieldOfRobots::host(domain, "all"));
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  const auto summary = field.summary();
  EXPECT_EQ(summary["state_hash"], expected);
  EXPECT_EQ(events_of(summary, "refused").size(), 1u) << summary.dump(1);
}

TEST(JoinAndLeaveAtTickBoundariesOnly, ARunEndsWhenItsOwnControllerFailsInStart) {
  const FieldOfRobots field(2, 3.0, "", test_controller("misbehaving"));
  for (const char* where : {"process", "inprocess"}) {
    const Ended ended = run_to_end({cohort_program(), "run", field.file(), "--controllers", where}, fails_in_start);
    EXPECT_EQ(ended.exit_code, 1) << where;
    EXPECT_NE(ended.err.find("failed in start at tick 0: a fault on purpose"), std::string::npos) << ended.err;
  }
}

}  // namespace
}  // namespace cohort::test
