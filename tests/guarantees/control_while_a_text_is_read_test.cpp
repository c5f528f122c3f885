// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "client_sdk/src/control/control_client.hpp"
#include "server/parsing/experiment/read_experiment.hpp"
#include "server/serving/server.hpp"
#include "tests/support/controlled_run.hpp"

// Reading the text of a model may take a long time.
namespace cohort::test {
namespace {

using wire::ResultCode;

constexpr const char* static_box = R"(<sdf version="1.9"><model name="box"><static>true</static><link name="body">
  <collision name="hull"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision>
</link></model></sdf>)";

/// A served run of robots that need no controller, in this process. The test decides when texts of models are read.
class RunWithASlowReader {
 public:
  RunWithASlowReader() : server_(std::span(&free_.server, 1)) {
    experiment_ = parsing::read_experiment(field_.file(), {}, {}, {COHORT_SOURCE_DIR "/worlds/robots"});
    experiment_.read_model = [read = experiment_.read_model, this](const std::string& text) {
      may_read_.wait();
      return read(text);
    };
    simulation_.emplace(experiment_, 1);
    thread_ = std::thread([this] { server_.run(experiment_, *simulation_, {}, {}, stop_); });
  }
  ~RunWithASlowReader() {
    stop_ = true;
    thread_.join();
  }
  void let_read() { release_.set_value(); }
  ControlClient client() const { return ControlClient({.domain = free_.domain}); }

 private:
  std::promise<void> release_;
  std::shared_future<void> may_read_{release_.get_future()};
  FieldOfRobots field_{2, 1e6, ", required: false"};
  FreeDomain free_ = take_free_domain();
  description::Experiment experiment_;
  std::optional<Simulation> simulation_;
  session::Server server_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

wire::SpawnEntity spawn(const std::string& text) {
  wire::SpawnEntity spawn;
  spawn.entity = "crate";
  spawn.resource_string = text;
  spawn.pose.position = {5, 5, 1};
  return spawn;
}

std::uint64_t tick_of(ControlClient& client) {
  const auto reply = client.ask(wire::GetSimulationState{}, patience, never);
  return reply ? reply->tick : 0;
}

TEST(ControlWhileATextIsRead, BlocksNeitherOtherClientsNorTheRun) {
  RunWithASlowReader run;
  std::optional<wire::Reply> spawned;
  std::thread waiting([&] {
    ControlClient client = run.client();
    spawned = client.ask(spawn(static_box), patience, never);
  });
  ControlClient other = run.client();
  EXPECT_TRUE(eventually([&] { return tick_of(other) > 0; }));
  const std::uint64_t tick = tick_of(other);
  EXPECT_TRUE(eventually([&] { return tick_of(other) > tick + 100; }));
  const auto removed = other.ask(wire::DeleteEntity{"swarm/sbot_1"}, patience, never);
  EXPECT_TRUE(removed && removed->result == ResultCode::ok);
  run.let_read();
  waiting.join();
  ASSERT_TRUE(spawned);
  EXPECT_EQ(spawned->result, ResultCode::ok) << spawned->error_message;
  EXPECT_GT(spawned->tick, tick + 100);
}

TEST(ControlWhileATextIsRead, KeepsTheOrderOfEachClient) {
  RunWithASlowReader run;
  ControlClient client = run.client();
  // This client stops waiting. Its request is carried out all the same, before its next one.
  EXPECT_FALSE(client.ask(spawn(static_box), std::chrono::milliseconds(200), never));
  std::thread later([&] {
    ControlClient other = run.client();
    const std::uint64_t tick = tick_of(other);
    EXPECT_TRUE(eventually([&] { return tick_of(other) > tick + 100; }));
    run.let_read();
  });
  const auto removed = client.ask(wire::DeleteEntity{"crate"}, patience, never);
  later.join();
  ASSERT_TRUE(removed);
  EXPECT_EQ(removed->result, ResultCode::ok) << removed->error_message;
}

TEST(ControlWhileATextIsRead, ReportsTheErrorInTheText) {
  RunWithASlowReader run;
  run.let_read();
  ControlClient client = run.client();
  const auto reply = client.ask(spawn("<sdf version='1.9'>\n<modl/></sdf>"), patience, never);
  ASSERT_TRUE(reply);
  EXPECT_EQ(reply->result, ResultCode::resource_parse_error);
  EXPECT_EQ(reply->error_message.find("the text of the model: "), 0u) << reply->error_message;
}

}  // namespace
}  // namespace cohort::test
