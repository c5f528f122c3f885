// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "idl/dds/transport.hpp"
#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {
namespace {

// A participant that claims to be a client, and is none.
class Stranger {
 public:
  explicit Stranger(const ReservedDomain& domain)
      : participant_(wire::Participant::client(domain.number())), joins_(participant_) {
    EXPECT_TRUE(eventually([&] { return joins_.matched() == 1; }));
  }
  void join(std::uint64_t id, const std::string& robots, const std::string& name = "stranger") {
    wire::Join join;
    join.client = id;
    join.controller = name;
    join.host = "elsewhere";
    join.robots = {robots};
    joins_.write(join);
  }
  bool wait_until_received() { return joins_.wait_until_received(30s); }

 private:
  wire::Participant participant_;
  wire::Writer<wire::Join> joins_;
};

// Counts rejections whose text begins so.
std::uint64_t rejected(const nlohmann::json& summary, const std::string& text) {
  std::uint64_t count = 0;
  for (const auto& event : events_of(summary, "rejected"))
    if (event["text"].get<std::string>().starts_with(text)) count += event["count"].get<std::uint64_t>();
  return count;
}

TEST(FloodsNeverStopARun, OfJoinsUnderManyNames) {
  const FieldOfRobots field(4, 5.0);
  const std::string expected = run_experiment(field.file(), {"--controllers", "inprocess"})["state_hash"];
  const ReservedDomain domain;
  Process server(field.serve(domain));
  Stranger stranger(domain);
  constexpr std::uint64_t names = 10'000;
  for (std::uint64_t id = 1; id <= names; ++id) {
    stranger.join(id, "nobody");
    if (id % 256 == 0) {
      ASSERT_TRUE(stranger.wait_until_received()) << server.output();
    }
  }
  ASSERT_TRUE(stranger.wait_until_received()) << server.output();
  Process controllers(FieldOfRobots::host(domain, "all"));
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(controllers.wait_for_exit(), 0) << controllers.output();
  const auto summary = field.summary();
  EXPECT_EQ(summary["state_hash"], expected);
  EXPECT_GT(rejected(summary, "foreign: a participant that has joined sent a Join with another id"), names / 2);
}

// It claims all robots under one id, sends another id, and leaves. Its robots are then free, as usual.
TEST(FloodsNeverStopARun, OfNamesDoNotHideALostClient) {
  const FieldOfRobots field(4, 5.0);
  const std::string expected = run_experiment(field.file(), {"--controllers", "inprocess"})["state_hash"];
  const ReservedDomain domain;
  Process server(field.serve(domain, {"--verbose"}));
  {
    Stranger stranger(domain);
    stranger.join(1, "all", "claims all");
    ASSERT_TRUE(server.wait_for_output("claims all (process 0 on elsewhere) drives")) << server.output();
    stranger.join(2, "0", "another");
    ASSERT_TRUE(stranger.wait_until_received());
  }
  Process controllers(FieldOfRobots::host(domain, "all"));
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(controllers.wait_for_exit(), 0) << controllers.output();
  EXPECT_EQ(field.summary()["state_hash"], expected);
}

TEST(FloodsNeverStopARun, OfLargeJoinsDoNotLeakMemory) {
  const FieldOfRobots field(4, 5.0);
  const ReservedDomain domain;
  Process server(field.serve(domain));
  constexpr std::size_t megabyte = 1 << 20;
  {
    Stranger first(domain);
    first.join(1, "nobody");
    ASSERT_TRUE(first.wait_until_received());
  }
  const std::size_t before = resident_bytes(server.pid());
  const std::string large(15 * megabyte, 'x');
  for (std::uint64_t participant = 0; participant < 6; ++participant) {
    Stranger stranger(domain);
    for (std::uint64_t i = 1; i <= 10; ++i) {
      stranger.join(100 * participant + i, large);
      ASSERT_TRUE(stranger.wait_until_received()) << server.output();
    }
  }
  EXPECT_TRUE(eventually([&] { return resident_bytes(server.pid()) < before + 64 * megabyte; }))
      << before / megabyte << " MB before, " << resident_bytes(server.pid()) / megabyte << " MB after";
  Process controllers(FieldOfRobots::host(domain, "all"));
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_EQ(controllers.wait_for_exit(), 0) << controllers.output();
  EXPECT_EQ(rejected(field.summary(), "malformed from an unknown client: a Join is larger than 128 KiB"), 60u)
      << field.summary()["events"].dump(1);
}

}  // namespace
}  // namespace cohort::test
