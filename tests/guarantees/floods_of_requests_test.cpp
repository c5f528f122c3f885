// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "idl/wire/control_messages.hpp"
#include "tests/support/controlled_run.hpp"

namespace cohort::test {
namespace {

// The steps of all runs of a server, as an observer receives them.
class Steps {
 public:
  explicit Steps(const ReservedDomain& domain)
      : participant_(wire::Participant::client(domain.number())),
        reader_(participant_, {[this](const wire::WorldState& state, const wire::Sender&) { note(state); }, {}},
                "view") {}
  double per_second(std::chrono::milliseconds time) const {
    const std::uint64_t before = steps_;
    const auto start = std::chrono::steady_clock::now();
    std::this_thread::sleep_for(time);
    return static_cast<double>(steps_ - before) /
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  bool have_begun() const {
    return eventually([&] { return steps_ > 0; });
  }

 private:
  void note(const wire::WorldState& state) {
    steps_ += state.run == run_ && state.tick >= tick_ ? state.tick - tick_ : state.tick;
    run_ = state.run;
    tick_ = state.tick;
  }
  std::uint32_t run_ = 0;
  std::uint64_t tick_ = 0;
  std::atomic<std::uint64_t> steps_ = 0;
  wire::Participant participant_;
  wire::Reader<wire::WorldState> reader_;
};

// A client that sends the same request a thousand times a second, without waiting for replies.
class Asker {
 public:
  Asker(const ReservedDomain& domain, std::uint64_t id, const wire::Operation& operation)
      : participant_(wire::Participant::client(domain.number())), requests_(participant_) {
    EXPECT_TRUE(eventually([&] { return requests_.matched() == 1; }));
    thread_ = std::jthread([this, id, operation](const std::stop_token& enough) {
      wire::Request request{.client = id, .operation = operation};
      for (request.number = 1; !enough.stop_requested(); ++request.number) {
        requests_.write(request);
        std::this_thread::sleep_for(1ms);
      }
    });
  }

 private:
  wire::Participant participant_;
  wire::Writer<wire::Request> requests_;
  std::jthread thread_;
};

class FloodsOf : public ::testing::TestWithParam<wire::Operation> {};

TEST_P(FloodsOf, RequestsDoNotStopTheProgress) {
  const FieldOfRobots field(400, 1e6);
  ControlledRun run(field);
  const Steps steps(run.domain());
  ASSERT_TRUE(steps.have_begun()) << run.server().output();
  std::vector<double> quiet, flooded;
  for (std::uint64_t round = 1; round <= 3; ++round) {
    quiet.push_back(steps.per_second(500ms));
    const Asker first(run.domain(), 2 * round, GetParam()), second(run.domain(), 2 * round + 1, GetParam());
    flooded.push_back(steps.per_second(1500ms));
  }
  std::ranges::sort(quiet);
  // Requests take a quarter of the time; the clients themselves and other programs also need processor time. Resets
  // without a limit leave no time for a single step.
  const double best = std::ranges::max(flooded);
  EXPECT_GT(best, 0.2 * quiet[1]) << best << " ticks/s of " << quiet[1];
  run.done({"pause"});
  const bool is_another_run = run.status()["run"] > 1;
  run.done({"shutdown"});
  const auto controlled = events_of(run.finish(), "control");
  const bool is_done = std::ranges::any_of(controlled, [](const auto& event) {
    return event["text"].template get<std::string>().starts_with(wire::name_of(wire::code_of(GetParam())));
  });
  EXPECT_TRUE(is_done || is_another_run || wire::is_query(wire::code_of(GetParam())))
      << "what is asked for costs nothing if it is refused";
}

INSTANTIATE_TEST_SUITE_P(, FloodsOf,
                         ::testing::Values(wire::SaveSnapshot{}, wire::ResetSimulation{}, wire::GetEntities{}),
                         [](const auto& flood) { return wire::name_of(wire::code_of(flood.param)); });

TEST(FloodsNeverStopARun, OfUploadsDropTheOldestWithAReason) {
  const FieldOfRobots field(1, 1e4);
  ControlledRun run(field, {"--paused"}, false);
  constexpr std::uint64_t size = std::uint64_t{140} << 20;
  const auto hand_over = [](ControlClient& client) {
    wire::PutData part{.size = size};
    part.data.resize(wire::largest_part);
    for (; part.offset < size; part.offset += part.data.size()) {
      const auto reply = client.ask(part, patience, never);
      ASSERT_TRUE(reply && reply->is_done()) << part.offset;
    }
  };
  ControlClient first = client_of(run), second = client_of(run);
  hand_over(first);
  hand_over(second);
  const auto load = [](ControlClient& client) {
    const auto reply = client.ask(wire::LoadSnapshot{}, patience, never);
    return reply ? reply->error_message : "";
  };
  EXPECT_NE(load(first).find("dropped: more than 256 MiB are kept for all clients"), std::string::npos);
  EXPECT_EQ(load(second).find("dropped"), std::string::npos) << "it is there, if it is no snapshot";
  run.done({"shutdown"});
  const auto dropped = events_of(run.finish(), "dropped");
  ASSERT_EQ(dropped.size(), 1u);
}

}  // namespace
}  // namespace cohort::test
