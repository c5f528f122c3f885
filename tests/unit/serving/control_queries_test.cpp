// SPDX-License-Identifier: Apache-2.0
#include "server/serving/control/control_queries.hpp"

#include <gtest/gtest.h>

#include "client_sdk/include/cohort/control.hpp"
#include "client_sdk/src/control/experiment_query.hpp"
#include "server/messages/experiment_inputs.hpp"
#include "tests/support/robots.hpp"

// Questions to a run, without a network.
namespace cohort::session {
namespace {

using namespace std::chrono_literals;
using namespace test;
using wire::ResultCode;

constexpr std::uint64_t client = 7;

std::shared_ptr<const description::KeptFiles> files_of_three_parts() {
  return std::make_shared<const description::KeptFiles>(description::KeptFiles{
      .experiment = "a.yaml",
      .working_folder = "/here",
      .model_path = "/models",
      .last_model_folders = {"robots"},
      .files = {{"/here/a.yaml", "world: w.sdf"}, {"/here/w.sdf", std::string(2 * wire::largest_part, '\0')}},
      .folders = {"/here", "/models"}});
}

class ClientQueries : public testing::Test {
 protected:
  ClientQueries() {
    experiment_.name = "asked";
    experiment_.world = world_with_floor();
    experiment_.duration = 10s;
    experiment_.seed = 3;
    begin();
  }
  void begin() {
    ++run_.number;
    queries_.begin(run_);
  }
  wire::Reply ask(const wire::Operation& operation) {
    wire::Reply reply;
    reply.operation = wire::code_of(operation);
    reply.run = run_.number;
    queries_.answer(reply, {.client = client, .number = ++number_, .operation = operation});
    return reply;
  }
  wire::DataPart part(std::uint64_t offset) {
    const wire::Reply reply = ask(wire::GetExperiment{offset});
    const auto* const part = reply.get<wire::DataPart>();
    return part == nullptr ? wire::DataPart{} : *part;
  }

  description::Experiment experiment_;

 private:
  Simulation simulation_{experiment_, 1};
  RunMonitor monitor_{experiment_, simulation_, {}, {}};
  ControlledRun run_{experiment_, simulation_, monitor_, 0, {}, {}};
  RequestLedger ledger_;
  LiveRecordings recordings_;
  KeptSnapshots kept_{0, 0};
  ControlQueries queries_{ledger_, recordings_, kept_};
  std::uint64_t number_ = 0;
};

TEST_F(ClientQueries, AnExperimentBuiltByAProgramHasNoFiles) {
  const wire::Reply reply = ask(wire::GetExperiment{});
  EXPECT_EQ(reply.result, ResultCode::not_found);
  EXPECT_EQ(reply.error_message, "the experiment was built by a program, not read from files");
}

TEST_F(ClientQueries, FilesOfAnExperimentArriveUnchangedInBoundedParts) {
  experiment_.inputs = files_of_three_parts();
  const wire::DataPart first = part(0);
  EXPECT_EQ(first.data.size(), wire::largest_part);
  EXPECT_GT(first.size, 2 * wire::largest_part);
  EXPECT_EQ(part(first.size - 5).data.size(), 5u);
  EXPECT_TRUE(part(first.size).data.empty());
  const wire::Reply beyond = ask(wire::GetExperiment{first.size + 1});
  EXPECT_EQ(beyond.result, ResultCode::malformed);
  EXPECT_NE(beyond.error_message.find("beyond"), std::string::npos) << beyond.error_message;

  const auto read = query_experiment([&](const wire::GetExperiment& question) { return ask(question); });
  EXPECT_EQ(read.seed, 3u);
  EXPECT_EQ(read.duration, 10s);
  const description::KeptFiles kept = messages::kept_files(read);
  EXPECT_EQ(kept.experiment, "a.yaml");
  EXPECT_EQ(kept.working_folder, "/here");
  EXPECT_EQ(kept.model_path, "/models");
  EXPECT_EQ(kept.last_model_folders, std::vector<std::string>{"robots"});
  EXPECT_EQ(kept.folders, (std::vector<std::string>{"/here", "/models"}));
  ASSERT_EQ(kept.files.size(), 2u);
  EXPECT_EQ(kept.files[1].path, "/here/w.sdf");
  EXPECT_EQ(kept.files[1].bytes, experiment_.inputs->files[1].bytes);
}

TEST_F(ClientQueries, FetchingStartsAgainForAnotherRun) {
  experiment_.inputs = files_of_three_parts();
  int asked = 0;
  const auto read = query_experiment([&](const wire::GetExperiment& question) {
    if (++asked == 2) {
      experiment_.seed = 4;
      begin();
    }
    return ask(question);
  });
  EXPECT_EQ(read.seed, 4u);
  EXPECT_EQ(asked, 5) << "one part of the first run, one of the second that does not fit, and its three";
}

TEST_F(ClientQueries, AClientRejectsInvalidFiles) {
  const auto refused = [](const wire::Returned& returned) {
    try {
      query_experiment([&](const wire::GetExperiment&) {
        wire::Reply reply;
        reply.returned = returned;
        return reply;
      });
    } catch (const ControlError& error) {
      return error.result == ControlResult::bad_reply;
    }
    return false;
  };
  EXPECT_TRUE(refused(std::monostate{}));
  EXPECT_TRUE(refused(wire::DataPart{0, 0, {}})) << "nothing";
  EXPECT_TRUE(refused(wire::DataPart{~std::uint64_t{0}, 0, {1}})) << "too much";
  EXPECT_TRUE(refused(wire::DataPart{8, 4, {0, 1, 0, 0}})) << "another part";
  EXPECT_TRUE(refused(wire::DataPart{4, 0, {0, 1, 0, 0, 9}})) << "more than there is";
  EXPECT_TRUE(refused(wire::DataPart{4, 0, {9, 9, 9, 9}})) << "no CDR";
  EXPECT_TRUE(refused(wire::DataPart{4, 0, {0, 1, 0, 0}})) << "a message that ends too early";
}

}  // namespace
}  // namespace cohort::session
