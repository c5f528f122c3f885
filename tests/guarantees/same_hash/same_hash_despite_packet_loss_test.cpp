// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "tests/support/worlds/field_of_robots.hpp"

namespace cohort::test {
namespace {

class SameHashDespitePacketLoss : public ::testing::TestWithParam<const char*> {};

// The server is in one network namespace, and the controllers of eight robots are in another. A cable between them
// loses this share of the packets in each direction.
TEST_P(SameHashDespitePacketLoss, OfTwoHosts) {
  const FieldOfRobots field(8, 10.0);
  const auto expected = run_experiment(field.file(), {"--controllers", "inprocess"});

  write_file(field / "two_hosts.sh", R"(set -e
mount -t tmpfs none /run
ip netns add here
ip netns add there
"$LINK" here there "$LOSS" 7 > link.out &
link=$!
trap 'kill $link' EXIT
until grep -q up link.out; do sleep 0.02; done
for side in here:10.99.0.1/24 there:10.99.0.2/24; do
  ip -n ${side%%:*} link set lo up
  ip -n ${side%%:*} addr add ${side#*:} dev cable
  ip -n ${side%%:*} link set cable up
done
ip netns exec here "$COHORT" serve experiment.yaml --network 10.99.0.1 --summary summary.json > server.out 2>&1 &
server=$!
ip netns exec there "$COHORT" host obstacle_avoidance --robots all --server 10.99.0.1 > host.out 2>&1 &
wait $server
)");
  Process hosts({"/usr/bin/unshare", "--map-root-user", "--net", "--mount", "/bin/bash", "-c",
                 "cd " + (field / "").string() + " && . ./two_hosts.sh"},
                {{"LINK", COHORT_BUILD_DIR "/bin/lossy_link"}, {"LOSS", GetParam()}, {"COHORT", cohort_program()}});
  const auto exit_code = hosts.wait_for_exit();
  const std::string output = hosts.output();
  if (output.find("ermitted") != std::string::npos || output.find("/dev/net/tun") != std::string::npos)
    GTEST_SKIP() << "no network namespaces here: " << output;
  ASSERT_EQ(exit_code, 0) << output << read_file(field / "server.out") << read_file(field / "host.out");
  const auto summary = field.summary();
  EXPECT_EQ(summary["state_hash"], expected["state_hash"]);
  EXPECT_EQ(summary["late"], 0);
  RecordProperty("ticks_per_second", std::to_string(summary["ticks"].get<double>() / summary["wall_s"].get<double>()));
}

INSTANTIATE_TEST_SUITE_P(Shares, SameHashDespitePacketLoss, ::testing::Values("0", "0.05", "0.2"),
                         [](const auto& share) {
                           const std::string text = share.param;
                           return text == "0" ? "None" : text == "0.05" ? "FivePercent" : "TwentyPercent";
                         });

}  // namespace
}  // namespace cohort::test
