// SPDX-License-Identifier: Apache-2.0
#include "server/serving/client_names.hpp"

#include <gtest/gtest.h>

namespace cohort::session {
namespace {

wire::Sender writer_of(std::uint64_t participant, std::uint64_t writer) {
  return {.writer = writer, .participant = participant};
}

std::string word_of(const std::string& refusal) { return refusal.substr(0, refusal.find(':')); }

TEST(ClientNames, AParticipantHasOneClientUntilItIsGone) {
  ClientNames names;
  EXPECT_EQ(names.enter(7, writer_of(1, 10)), "");
  EXPECT_EQ(names.enter(7, writer_of(1, 10)), "") << "Joins come again";
  EXPECT_EQ(word_of(names.enter(8, writer_of(1, 10))), "foreign") << "on the same writer";
  EXPECT_EQ(word_of(names.enter(8, writer_of(1, 11))), "foreign") << "and on another one";
  EXPECT_EQ(word_of(names.enter(7, writer_of(2, 20))), "foreign") << "from another participant";
  EXPECT_EQ(names.client_of_writer(10), 7u);
  EXPECT_FALSE(names.client_of_writer(11));
  names.set_gone(7, true);
  EXPECT_EQ(names.enter(8, writer_of(1, 11)), "");
  EXPECT_EQ(word_of(names.enter(7, writer_of(1, 10))), "foreign") << "the former comes back beside the latter";
  names.forget(8);
  EXPECT_EQ(names.enter(7, writer_of(1, 10)), "");
}

TEST(ClientNames, AClientIsIdentifiedByTheWriterOfItsLastJoin) {
  ClientNames names;
  names.enter(7, writer_of(1, 10));
  names.enter(7, writer_of(1, 11));
  EXPECT_FALSE(names.client_of_writer(10));
  EXPECT_EQ(names.client_of_writer(11), 7u);
  EXPECT_TRUE(names.is_in_own_name(7, writer_of(1, 99))) << "its commands have another writer";
  EXPECT_FALSE(names.is_in_own_name(7, writer_of(2, 11)));
  EXPECT_FALSE(names.is_in_own_name(8, writer_of(1, 11)));
  names.forget(7);
  EXPECT_FALSE(names.client_of_writer(11));
  EXPECT_FALSE(names.is_in_own_name(7, writer_of(1, 11)));
}

TEST(ClientNames, RejectsIdZero) { EXPECT_EQ(word_of(ClientNames().enter(0, writer_of(1, 10))), "malformed"); }

TEST(ClientNames, OneIdentityLeavesRoomForOthers) {
  ClientNames names;
  const std::optional greedy = wire::Identity{.name = "greedy"}, modest = wire::Identity{.name = "modest"};
  std::uint64_t id = 0;
  const auto enter = [&](const auto& identity) {
    ++id;
    return names.enter(id, writer_of(id, id), identity);
  };
  for (std::size_t i = 0; i < ClientNames::most_of_one_identity; ++i) ASSERT_EQ(enter(greedy), "");
  const std::string refusal = enter(greedy);
  EXPECT_EQ(word_of(refusal), "flood");
  EXPECT_NE(refusal.find("'greedy'"), std::string::npos) << refusal;
  EXPECT_EQ(enter(modest), "");
  names.forget(1);
  EXPECT_EQ(enter(greedy), "") << "one has left";
}

TEST(ClientNames, BoundsTheNumberOfClients) {
  ClientNames names;
  std::size_t entered = 0;
  for (std::uint64_t id = 1; id <= 2 * ClientNames::most_clients; ++id)
    if (names.enter(id, writer_of(id, id)).empty()) ++entered;
  EXPECT_EQ(entered, ClientNames::most_clients);
}

}  // namespace
}  // namespace cohort::session
