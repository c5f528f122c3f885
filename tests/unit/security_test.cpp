#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/free_domain.hpp"
#include "tests/support/process.hpp"
#include "tools/cohort/certificates.hpp"

// Who gets in at a door of the server, tried with real participants and real certificates.
namespace cohort::wire {
namespace {

namespace fs = std::filesystem;
using test::eventually;
using testing::ScratchFolder;

// Identities of one server: observer, red and blue.
class Keys {
 public:
  explicit Keys(const std::string& protection = "sign", unsigned days = 30) {
    std::uint32_t door = 0;
    for (const char* name : {"observer", "red", "blue"}) {
      const Role role = door == observers_door ? Role::observer : Role::controller;
      tool::make_door({.name = name, .role = role, .door = door++, .protection = protection, .robots = {"all"}},
                      folder / "server" / name, folder / "clients" / name, days);
    }
  }
  Identity client(const std::string& name) const { return read_identity(folder / "clients" / name); }
  Identity door(const std::string& name) const { return read_identity(folder / "server" / name); }

  struct Folder : ScratchFolder {
    fs::path operator/(const std::string& name) const { return path() / name; }
  } folder;
};

// What comes in at a door.
class Door {
 public:
  Door(std::uint32_t domain, const Identity& identity)
      : participant(Participant::server(domain, "127.0.0.1", identity)),
        joins(participant, {[this](const Join& join, const Sender& sender) {
                              received = join.process;
                              from = sender.participant;
                            },
                            {}}),
        states(participant, "view") {}
  Participant participant;
  std::atomic<std::uint32_t> received = 0;
  std::atomic<std::uint64_t> from = 0;
  Reader<Join> joins;
  Writer<WorldState> states;
};

// Long enough for a handshake, which takes a few tens of milliseconds, on a machine with much else to do.
constexpr std::chrono::seconds long_enough{3};

class SecurityTest : public ::testing::TestWithParam<const char*> {
 protected:
  // A domain whose ports of doors are free as well: nobody else uses more than the first two of a domain.
  SecurityTest() : domain_(reserved_.number()) {}
  const testing::ReservedDomain reserved_;
  const std::uint32_t domain_;
};

TEST_P(SecurityTest, AClientGetsInAtItsOwnDoor) {
  const Keys keys(GetParam());
  Door red(domain_, keys.door("red"));
  Door blue(domain_, keys.door("blue"));
  Participant client = Participant::client(domain_, "127.0.0.1", keys.client("red"));
  Writer<Join> joins(client);
  joins.write({.client = 1, .process = 7});
  EXPECT_TRUE(eventually([&] { return red.received == 7; }));
  EXPECT_EQ(blue.joins.matched(), 0u);
}

INSTANTIATE_TEST_SUITE_P(All, SecurityTest, ::testing::Values("sign", "encrypt"),
                         [](const auto& protection) { return std::string(protection.param); });

}  // namespace
}  // namespace cohort::wire
