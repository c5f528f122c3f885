// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "idl/dds/transport.hpp"
#include "tests/support/free_domain.hpp"
#include "tests/support/keys.hpp"

// Tests which clients a participant of the server admits, with real participants and real certificates.
namespace cohort::wire {
namespace {

namespace fs = std::filesystem;
using namespace test;

class ServerParticipant {
 public:
  ServerParticipant(std::uint32_t domain, const Identity& identity)
      : participant(Participant::server(domain, "127.0.0.1", identity)),
        joins(participant, {[this](const Join& join, const Sender&) { process = join.process; }, {}}),
        states(participant, "view") {}

  Participant participant;
  std::atomic<std::uint32_t> process = 0;  // sender of the last Join
  Reader<Join> joins;
  Writer<WorldState> states;
};

class Joining {
 public:
  Joining(std::uint32_t domain, const std::optional<Identity>& identity, std::uint32_t process)
      : participant(Participant::client(domain, "127.0.0.1", identity)), joins(participant) {
    joins.write({.client = process, .process = process});
  }
  Participant participant;
  Writer<Join> joins;
};

// Captures the log of Cyclone DDS while this lives.
class Told {
 public:
  Told() {
    set_dds_log([](std::string_view message, DdsLogKind kind) noexcept {
      const std::lock_guard lock(mutex);
      if (kind == DdsLogKind::refusal) refusals.emplace_back(message);
    });
  }
  Told(const Told&) = delete;
  Told& operator=(const Told&) = delete;
  ~Told() { set_dds_log(nullptr); }
  // Returns the number of messages that contain all these texts.
  static std::size_t count(const std::vector<std::string>& texts) {
    const std::lock_guard lock(mutex);
    return static_cast<std::size_t>(std::ranges::count_if(refusals, [&](const std::string& refusal) {
      return std::ranges::all_of(texts, [&](const auto& text) { return refusal.find(text) != std::string::npos; });
    }));
  }

 private:
  static inline std::mutex mutex;
  static inline std::vector<std::string> refusals;
};

class SecureDomain : public ::testing::Test {
 protected:
  std::uint32_t domain() const { return reserved_.number(); }

 private:
  const ReservedDomain reserved_;
};

class ProtectedDomain : public SecureDomain, public ::testing::WithParamInterface<const char*> {};

TEST_P(ProtectedDomain, AClientIsAdmittedOnlyAtItsOwnParticipant) {
  const Keys keys(GetParam());
  ServerParticipant red(domain(), keys.server_identity("red"));
  ServerParticipant blue(domain(), keys.server_identity("blue"));
  const Joining client(domain(), keys.client("red"), 7);
  EXPECT_TRUE(eventually([&] { return red.process == 7; }));
  EXPECT_EQ(blue.joins.matched(), 0u);
  EXPECT_EQ(red.participant.identity()->name, "red");
  EXPECT_EQ(red.participant.identity()->robots, std::vector<std::string>{"0..7"});
}

INSTANTIATE_TEST_SUITE_P(All, ProtectedDomain, ::testing::Values("sign", "encrypt"),
                         [](const auto& protection) { return std::string(protection.param); });

TEST_F(SecureDomain, AClientWithOtherCertificatesIsRefusedAndBothSidesLogItOnce) {
  const Told told;
  const Keys keys, others;
  ServerParticipant red(domain(), keys.server_identity("red"));
  ServerParticipant blue(domain(), keys.server_identity("blue"));
  const Joining of_another_making(domain(), others.client("red"), 1);
  const Joining disguised(domain(), read_identity(keys.disguise("red", "blue")), 2);
  EXPECT_TRUE(eventually([] { return Told::count({"OU=red/CN=client", "unable to get local issuer"}) > 0; }));
  EXPECT_TRUE(eventually([] { return Told::count({"OU=red/CN=server", "signature failure"}) > 0; }));
  // Two later clients are admitted, but these are not.
  const Joining first(domain(), keys.client("red"), 3), second(domain(), keys.client("blue"), 4);
  EXPECT_TRUE(eventually([&] { return red.process == 3 && blue.process == 4; }));
  EXPECT_EQ(red.joins.matched(), 1u);
  EXPECT_EQ(blue.joins.matched(), 1u);
  EXPECT_EQ(of_another_making.joins.matched() + disguised.joins.matched(), 0u);
  EXPECT_EQ(Told::count({"OU=red/CN=server", "signature failure"}), 1u) << "though it is tried every second";
}

TEST_F(SecureDomain, AClientWithoutCertificatesNeitherWritesNorReads) {
  const Keys keys;
  ServerParticipant server(domain(), keys.server_identity("observer"));
  Participant plain = Participant::client(domain());
  Writer<Join> joins(plain);
  joins.write({.client = 1, .process = 1});
  const Reader<WorldState> looking_on(plain, {[](const WorldState&, const Sender&) {}, {}}, "view");
  Participant observer = Participant::client(domain(), "127.0.0.1", keys.client("observer"));
  std::atomic<bool> sees = false;
  const Reader<WorldState> states(observer, {[&](const WorldState&, const Sender&) { sees = true; }, {}}, "view");
  EXPECT_TRUE(eventually([&] {
    server.states.write({.run = 1});
    return sees.load();
  }));
  EXPECT_EQ(looking_on.matched() + joins.matched() + server.joins.matched(), 0u);
  EXPECT_EQ(server.states.matched(), 1u);
}

TEST_F(SecureDomain, AnErrorNamesTheRightThatAnIdentityLacks) {
  const Keys keys;
  Participant observer = Participant::client(domain(), "127.0.0.1", keys.client("observer"));
  EXPECT_THROW(Writer<Command>{observer}, WireError);
  Participant red = Participant::client(domain(), "127.0.0.1", keys.client("red"));
  const Writer<Command> commands(red);
  const auto look_on = [&] { Reader<WorldState>(red, {[](const WorldState&, const Sender&) {}, {}}, "view"); };
  EXPECT_THROW(look_on(), WireError);
  const auto admits_in = [&](const std::string& partition) {
    Reader<Admit>(red, {[](const Admit&, const Sender&) {}, {}}, partition);
  };
  EXPECT_NO_THROW(admits_in(partition_of(1)));
  EXPECT_THROW(admits_in("another"), WireError) << "partitions of permissions count too";
}

TEST_F(SecureDomain, AnExpiredCertificateIsNamed) {
  const Keys keys("sign", 0);
  try {
    ServerParticipant(domain(), keys.server_identity("red"));
    FAIL() << "it is accepted";
  } catch (const WireError& error) {
    EXPECT_NE(std::string(error.what()).find("expired"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("server/red"), std::string::npos) << error.what();
  }
}

void expect_wire_error(const std::function<void()>& action, const std::string& text) {
  try {
    action();
    ADD_FAILURE() << "no error; expected " << text;
  } catch (const WireError& error) {
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(Identities, FilesBelongOnlyToTheirOwnerAndTheAuthoritysKeyIsDeleted) {
  const Keys keys;
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(keys.folder())) {
    EXPECT_EQ(entry.path().filename().string().find("authority_key"), std::string::npos);
    if (!entry.is_regular_file()) continue;
    EXPECT_EQ(entry.status().permissions(), fs::perms::owner_read | fs::perms::owner_write) << entry.path();
    ++files;
  }
  EXPECT_EQ(files, 6 * 6);
}

TEST(Identities, AMissingOrMismatchedFileIsNamed) {
  const Keys keys;
  expect_wire_error([&] { read_identity(keys.folder()); }, "give the folder of one");
  expect_wire_error([&] { read_identity("/nowhere"); }, "/nowhere/identity: No such file");
  expect_wire_error([&] { read_server_identities(keys.client_folder("red")); }, "no identity of observers");
  expect_wire_error([&] { Participant::client(0, "127.0.0.1", keys.server_identity("red")); },
                    "is the server's identity");
  EXPECT_EQ(read_server_identities(keys.folder()).size(), 3u);
  EXPECT_EQ(read_server_identities(keys.folder() + "/server").back().name, "blue");
  fs::remove(keys.client_folder("red") + "/key.pem");
  expect_wire_error([&] { keys.client("red"); }, "red/key.pem: No such file");
  write_file(keys.client_folder("blue") + "/identity", "name: blue\ndoor: 2\n");
  EXPECT_EQ(keys.client("blue").participant, 2u) << "as version 0.1.0 wrote it";
  write_file(keys.client_folder("blue") + "/identity", "name: blue\nparticipant: 999\n");
  expect_wire_error([&] { keys.client("blue"); }, "expected a participant from 0 to 119, not '999'");
  fs::remove_all(keys.folder() + "/server/observer");
  expect_wire_error([&] { read_server_identities(keys.folder()); }, "no identity of observers");
}

}  // namespace
}  // namespace cohort::wire
