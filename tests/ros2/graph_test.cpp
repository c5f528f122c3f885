// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "idl/dds/ros2/ros_graph.hpp"
#include "idl/dds/ros2/ros_participant.hpp"
#include "idl/messages/ros_discovery_messages.hpp"
#include "tests/ros2/own_network.hpp"
#include "tests/support/patience.hpp"

// Participants of ROS 2 of our own that announce their nodes as those of different distributions do.
namespace cohort::ros2 {
namespace {

using test::eventually;

RosParticipant::Options node(const std::string& name) { return {{}, "/", name}; }

// Announces a node as a program does that is no rmw layer: without the hash of the type.
RosWriter announce_without_hash(RosParticipant& participant, const ParticipantInfo& info, GidFormat format) {
  RosWriter writer(participant, {discovery_topic, discovery_type, "", {true, true, 1}});
  writer.write(encode_discovery(info, format));
  return writer;
}

class RosGraphTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::has_own_network()) GTEST_SKIP() << "no network namespaces here";
    own_.emplace(node("cohort"));
    graph_.emplace(*own_, [] {});
  }
  bool sees(const RosParticipant& peer) const {
    return eventually([&] { return graph_->knows_nodes_of(peer.gid()); });
  }

  std::optional<RosParticipant> own_;
  std::optional<RosGraph> graph_;
};

TEST_F(RosGraphTest, DoesNotKnowTheGidFormatBeforeNodesAreAnnounced) { EXPECT_EQ(graph_->gid_format(), std::nullopt); }

TEST_F(RosGraphTest, DetectsAHumbleParticipantByItsLongGids) {
  RosParticipant peer(node("slam"));
  peer.announce(GidFormat::humble);
  ASSERT_TRUE(sees(peer));
  EXPECT_EQ(graph_->nodes_of(peer.gid()), "/slam");
  EXPECT_EQ(graph_->gid_format(), GidFormat::humble);
}

TEST_F(RosGraphTest, AParticipantWithShortGidsNeedsNoHashOfItsType) {
  RosParticipant peer(node("agent"));
  const ParticipantInfo info{peer.gid(), {{"/", "firmware", {}, {peer.gid()}}}};
  const RosWriter announcement = announce_without_hash(peer, info, GidFormat::since_iron);
  ASSERT_TRUE(sees(peer));
  EXPECT_EQ(graph_->nodes_of(peer.gid()), "/firmware");
  EXPECT_EQ(graph_->gid_format(), GidFormat::since_iron);
}

TEST_F(RosGraphTest, OneNewerParticipantDecidesHowGidsAreWritten) {
  RosParticipant older(node("older"));
  older.announce(GidFormat::humble);
  RosParticipant newer(node("newer"));
  newer.announce(GidFormat::since_iron);
  ASSERT_TRUE(sees(older) && sees(newer));
  EXPECT_EQ(graph_->gid_format(), GidFormat::since_iron);
}

// Two bridges would otherwise hold each other to what both began with.
TEST_F(RosGraphTest, ProgramsOfOneNameDoNotDecideForEachOther) {
  RosParticipant other_bridge(node("cohort"));
  other_bridge.announce(GidFormat::since_iron);
  RosParticipant peer(node("slam"));
  peer.announce(GidFormat::humble);
  ASSERT_TRUE(sees(other_bridge) && sees(peer));
  EXPECT_EQ(graph_->gid_format(), GidFormat::humble);
}

TEST_F(RosGraphTest, AParticipantThatIsGoneDoesNotDecide) {
  RosParticipant older(node("older"));
  older.announce(GidFormat::humble);
  {
    RosParticipant newer(node("newer"));
    newer.announce(GidFormat::since_iron);
    ASSERT_TRUE(sees(older) && sees(newer));
  }
  EXPECT_TRUE(eventually([&] { return graph_->gid_format() == GidFormat::humble; }));
}

TEST_F(RosGraphTest, AParticipantThatJoinsAfterAWithdrawalGetsOnlyTheNextAnnouncement) {
  RosParticipant peer(node("slam"));
  peer.announce(GidFormat::since_iron);
  ASSERT_TRUE(sees(peer));
  peer.withdraw();
  RosParticipant late(node("late"));
  const RosGraph its_graph(late, [] {});
  peer.announce(GidFormat::humble);
  ASSERT_TRUE(eventually([&] { return its_graph.knows_nodes_of(peer.gid()); }));
  EXPECT_EQ(its_graph.gid_format(), GidFormat::humble);
}

// As of an agent of firmware, which would be waited for otherwise.
TEST_F(RosGraphTest, AParticipantWithoutNodesDoesNotListenToAnnouncements) {
  RosParticipant bare(node("bare")), other(node("other"));
  const RosGraph graph_of_other(other, [] {});
  const EndpointSpec spec = topic_endpoint("/cmd_vel", "geometry_msgs/msg/Twist", "");
  const RosWriter writer(bare, spec), writer_of_other(other, spec);
  const std::array both = {bare.gid(), other.gid()};
  ASSERT_TRUE(eventually([&] {
    const auto is_of_bare = [&](const RosEndpoint& each) { return each.participant == bare.gid(); };
    return std::ranges::any_of(graph_->endpoints(), is_of_bare) && !graph_->listeners(both).empty();
  }));
  EXPECT_EQ(graph_->listeners(both), std::vector{other.gid()});
  EXPECT_TRUE(own_->is_announced_to(graph_->listeners(std::array<Gid, 1>{bare.gid()})));
}

TEST(DiscoveryInfo, AMessageShowsHowLongItsGidsAre) {
  Gid gid{};
  gid.fill(7);
  const std::array<ParticipantInfo, 4> infos = {
      ParticipantInfo{gid, {}}, ParticipantInfo{gid, {{"/", "a", {}, {}}}},
      ParticipantInfo{gid, {{"", "", {}, {}}, {"/b", "c", {gid}, {gid, gid}}}}, ParticipantInfo{}};
  for (const ParticipantInfo& info : infos)
    for (const GidFormat format : {GidFormat::humble, GidFormat::since_iron}) {
      const std::vector<std::byte> bytes = encode_discovery(info, format);
      EXPECT_EQ(gid_format_of(bytes), format);
      const ParticipantInfo decoded = decode_discovery(bytes);
      EXPECT_EQ(decoded.participant, info.participant);
      ASSERT_EQ(decoded.nodes.size(), info.nodes.size());
      for (std::size_t i = 0; i < info.nodes.size(); ++i) {
        EXPECT_EQ(decoded.nodes[i].name, info.nodes[i].name);
        EXPECT_EQ(decoded.nodes[i].writers, info.nodes[i].writers);
      }
    }
}

}  // namespace
}  // namespace cohort::ros2
