// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <atomic>
#include <cohort/control.hpp>
#include <cohort/observer.hpp>
#include <memory>

#include "idl/dds/transport.hpp"
#include "tests/support/keys.hpp"
#include "tests/support/worlds/sbot_layout.hpp"

// With security an identity drives its own robots, and all others have no effect.
namespace cohort::test {
namespace {

constexpr std::uint64_t blue_id = 0xb1e;  // for the client that these tests implement themselves

std::vector<std::string> host(const std::string& robots, const ReservedDomain& domain, const std::string& identity) {
  return {cohort_program(), "host",        "obstacle_avoidance", "--robots", robots,
          "--domain",       domain.text(), "--secure",           identity};
}

TEST(OnlyIdentitiesDrive, AndTheRunHasTheSameBitsAsWithoutSecurity) {
  const ScratchFolder folder;
  const std::string keys = (folder / "keys").string();
  const Ended made = run_to_end(
      {cohort_program(), "security", "init", keys, "--client", "red=0..3,explorers/sbot_4", "--client", "blue=5..15"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const std::string expected = reference_hash(3);
  {
    const ReservedDomain domain;
    Process server({cohort_program(), "serve", demo_experiment(), "--duration", "3", "--domain", domain.text()},
                   {{"COHORT_SECURE", keys}});
    Process red(host("0..4", domain, keys + "/clients/red"));
    Process blue({COHORT_BUILD_DIR "/bin/obstacle_avoidance", "--robots", "5..15", "--domain", domain.text(),
                  "--secure", keys + "/clients/blue"});
    EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
    EXPECT_EQ(red.wait_for_exit(), 0) << red.output();
    EXPECT_EQ(blue.wait_for_exit(), 0) << blue.output();
    EXPECT_NE(server.output().find(expected), std::string::npos) << server.output();
  }
  // Its own controllers need an identity that may drive their team.
  const std::vector<std::string> run = {cohort_program(), "run", demo_experiment(), "--duration", "3",
                                        "--secure",       keys};
  const Ended refused = run_to_end(run);
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("no client in " + keys + " may drive all robots of team 'explorers'"), std::string::npos)
      << refused.err;
  ASSERT_EQ(run_to_end({cohort_program(), "security", "add", keys, "all", "--robots", "all"}).exit_code, 0);
  const Ended done = run_to_end(run);
  EXPECT_EQ(done.exit_code, 0) << done.err;
  EXPECT_NE(done.out.find(expected), std::string::npos) << done.out;
}

// The client "blue", which drives robots 8 to 15 as usual. It holds back its answers from tick 100 on until the test
// releases them.
class Blue {
 public:
  Blue(const ReservedDomain& domain, const Keys& keys, bool holds_back)
      : goes_on(!holds_back),
        participant_(wire::Participant::client(domain.number(), "127.0.0.1", keys.client("blue"))),
        commands_(participant_),
        join_(participant_),
        observations_(participant_, {[this](const auto& frame, const auto&) { answer(frame); }, {}},
                      wire::partition_of(blue_id)) {
    join_.write({.client = blue_id, .controller = "hand-written", .host = "here", .robots = {"8..15"}});
  }
  std::atomic<bool> goes_on;

 private:
  void answer(const wire::Observation& frame) {
    if (frame.tick >= 100 && !goes_on) return;
    const std::vector<double> drive(frame.robots.size() * sbot_command_size, 0.05);
    commands_.write({blue_id, frame.run, frame.epoch, frame.tick, frame.robots, drive});
  }
  wire::Participant participant_;
  wire::Writer<wire::Command> commands_;
  wire::Writer<wire::Join> join_;
  wire::Reader<wire::Observation> observations_;
};

std::unique_ptr<Process> attacker(const ReservedDomain& domain, const std::string& identity) {
  std::vector<std::string> command = {COHORT_BUILD_DIR "/bin/send_bad_commands", domain.text(),
                                      std::to_string(blue_id)};
  if (!identity.empty()) command.push_back(identity);
  return std::make_unique<Process>(command);
}

TEST(OnlyIdentitiesDrive, AndOthersCannotChangeTheBits) {
  // The rights of observers come from these certificates only, not from those of another authority.
  const Keys keys("sign", 30, wire::Role::controller), others;
  const auto run = [&](bool attacked) {
    const ReservedDomain domain;
    const ScratchFolder folder;
    Process server({cohort_program(), "serve", demo_experiment(), "--duration", "2", "--domain", domain.text(),
                    "--secure", keys.folder(), "--summary", (folder / "summary.json").string()});
    Process red(host("0..7", domain, keys.client_folder("red")));
    Blue blue(domain, keys, attacked);
    // All use blue's id: without an identity, with one of another authority, with red's on blue's participant …
    std::vector<std::unique_ptr<Process>> outside;
    // … and these are admitted, on their own participants: red, and an observer.
    std::vector<std::unique_ptr<Process>> inside;
    if (attacked) {
      EXPECT_TRUE(server.wait_for_output("waiting for explorers/sbot_8 and 7 more: hand-written")) << server.output();
      for (const std::string& identity : {std::string(), others.client_folder("blue"), keys.disguise("red", "blue")})
        outside.push_back(attacker(domain, identity));
      for (const char* name : {"red", "observer"}) inside.push_back(attacker(domain, keys.client_folder(name)));
      for (const auto& each : inside) EXPECT_TRUE(each->wait_for_output("sent a thousand")) << each->output();
      blue.goes_on = true;
    }
    EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
    for (const auto& each : outside) EXPECT_EQ(each->output().find("sending"), std::string::npos) << each->output();
    return read_json(folder / "summary.json");
  };
  const auto quiet = run(false);
  const auto attacked = run(true);
  EXPECT_EQ(attacked["state_hash"], quiet["state_hash"]);
  EXPECT_EQ(attacked["ticks"], 200);
  std::uint64_t foreign = 0;
  for (const auto& event : attacked["events"])
    if (event["kind"] == "rejected" && event["text"].get<std::string>().starts_with("foreign"))
      foreign += event["count"].get<std::uint64_t>();
  EXPECT_GT(foreign, 1000u) << attacked.dump(1);
}

TEST(OnlyIdentitiesDrive, AndAClaimBeyondItsRightsIsRefusedByName) {
  const Keys keys("sign", 30, wire::Role::controller);
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", demo_experiment(), "--domain", domain.text(), "--secure", keys.folder()});
  Process red(host("7,8", domain, keys.client_folder("red")));
  EXPECT_EQ(red.wait_for_exit(), 2);
  EXPECT_NE(red.output().find("its identity 'red' may drive 0..7, not explorers/sbot_8"), std::string::npos)
      << red.output();
  wire::Identity identity = keys.client("observer");
  identity.role = wire::Role::controller;
  write_file(keys.client_folder("observer") + "/identity", wire::identity_text(identity));
  Process observer(host("0", domain, keys.client_folder("observer")));
  EXPECT_EQ(observer.wait_for_exit(), 2);
  EXPECT_NE(observer.output().find("its identity 'observer' may observe, but not drive robots"), std::string::npos)
      << observer.output();
  EXPECT_TRUE(server.wait_for_output("refused: ")) << server.output();
}

TEST(OnlyIdentitiesDrive, AndOnlyIdentitiesWithTheRightControl) {
  const ScratchFolder folder;
  const std::string keys = (folder / "keys").string();
  const Ended made = run_to_end({cohort_program(), "security", "init", keys, "--client", "red=all", "--client",
                                 "operator=none,control", "--client", "both=control,all"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_NE(made.out.find("operator  may control the run, but not drive robots"), std::string::npos) << made.out;
  EXPECT_NE(made.out.find("both  may drive all, and control the run"), std::string::npos) << made.out;
  const auto ctl = [&](const ReservedDomain& domain, const std::string& name, const std::string& what,
                       const std::string& timeout = patience_in_seconds) {
    return run_to_end({cohort_program(), "ctl", "--domain", domain.text(), "--secure", keys + "/clients/" + name,
                       "--timeout", timeout, what});
  };
  const auto serve = [&](const ReservedDomain& domain) {
    return std::vector<std::string>{cohort_program(), "serve",       demo_experiment(), "--paused",
                                    "--domain",       domain.text(), "--secure",        keys};
  };
  const std::string disguised = keys + "/clients/red/identity";
  const std::string red_identity = read_file(disguised);
  {
    const ReservedDomain domain;
    Process server(serve(domain));
    EXPECT_EQ(ctl(domain, "operator", "status").exit_code, 0) << server.output();
    EXPECT_EQ(ctl(domain, "both", "resume").exit_code, 0) << server.output();
    const Ended refused = ctl(domain, "red", "pause");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("can neither control nor observe a run"), std::string::npos) << refused.err;
    // Its file claims the right; DDS decides by the signed permissions.
    write_file(disguised, red_identity + "control: yes\n");
    EXPECT_NE(ctl(domain, "red", "pause", "2").exit_code, 0);
    // Clients without an identity are refused.
    EXPECT_EQ(run_to_end({cohort_program(), "ctl", "--domain", domain.text(), "--timeout", "2", "pause"}).exit_code, 1);
    EXPECT_NE(ctl(domain, "operator", "status").out.find("playing"), std::string::npos);
    Process operator_that_drives(host("0", domain, keys + "/clients/operator"));
    EXPECT_EQ(operator_that_drives.wait_for_exit(), 2) << operator_that_drives.output();
    EXPECT_EQ(ctl(domain, "operator", "shutdown").exit_code, 0);
    EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  }
  // Only the server's own folder counts, not the permissions in a client's certificates.
  const std::string servers = keys + "/server/operator/identity";
  std::string text = read_file(servers);
  text.replace(text.find("control: yes"), 12, "control: no");
  write_file(servers, text);
  const ReservedDomain domain;
  Process server(serve(domain));
  const Ended refused = ctl(domain, "operator", "resume");
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("the identity 'operator' may not control the run"), std::string::npos) << refused.err;
  EXPECT_NE(ctl(domain, "both", "status").out.find("paused"), std::string::npos);
  EXPECT_EQ(ctl(domain, "both", "shutdown").exit_code, 0);
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
}

TEST(OnlyIdentitiesDrive, AndObserversObserveAndRecord) {
  const ScratchFolder folder;
  const std::string keys = (folder / "keys").string();
  const std::string file = (folder / "run.mcap").string();
  ASSERT_EQ(run_to_end({cohort_program(), "security", "init", keys, "--client", "operator=none,control"}).exit_code, 0);
  const ReservedDomain domain;
  const auto as = [&](const std::string& name, std::vector<std::string> command) {
    command.insert(command.begin(), cohort_program());
    command.insert(command.end(), {"--domain", domain.text(), "--secure", keys + "/clients/" + name});
    return command;
  };
  Process server(
      {cohort_program(), "serve", demo_experiment(), "--paused", "--domain", domain.text(), "--secure", keys});
  Process recording(as("observer", {"record", "-o", file}));
  EXPECT_TRUE(recording.wait_for_output("recorded from tick 0 on")) << recording.output();
  EXPECT_EQ(run_to_end(as("observer", {"ctl", "--timeout", patience_in_seconds, "status"})).exit_code, 0);
  EXPECT_EQ(run_to_end(as("observer", {"ctl", "history"})).exit_code, 0);
  EXPECT_EQ(run_to_end(as("observer", {"ctl", "save", (folder / "snapshot").string()})).exit_code, 0);
  for (const std::vector<std::string>& change : {std::vector<std::string>{"ctl", "resume"},
                                                 {"ctl", "shutdown"},
                                                 {"ctl", "load", (folder / "snapshot").string()}}) {
    const Ended refused = run_to_end(as("observer", change));
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.err.find("the identity 'observer' may not control the run"), std::string::npos) << refused.err;
  }
  Observer observer({.domain = domain.number(), .secure = keys + "/clients/observer"});
  EXPECT_EQ(observer.robots(patience).value_or(std::vector<ObservedRobot>{}).size(), 16u);
  EXPECT_TRUE(observer.events(patience));
  EXPECT_THROW(Observer({.secure = keys + "/clients/operator"}), ControlError) << "it may control, not look on";
  EXPECT_EQ(run_to_end(as("operator", {"ctl", "shutdown"})).exit_code, 0);
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  EXPECT_TRUE(eventually([&] { return observer.ended().has_value(); }));
  EXPECT_EQ(recording.wait_for_exit(), 0) << recording.output();
  EXPECT_TRUE(std::filesystem::exists(file));
}

TEST(OnlyIdentitiesDrive, AndAServerOnANetworkWithoutSecurityWarns) {
  const ReservedDomain domain;
  const std::string script = "ip link set lo up && ip addr add 10.77.0.1/32 dev lo && exec \"$@\"";
  if (run_to_end({"/bin/sh", "-c", "unshare -rn true"}).exit_code != 0) GTEST_SKIP() << "no network namespaces here";
  for (const std::string address : {"10.77.0.1", "127.0.0.1"}) {
    Process server({"/usr/bin/unshare", "-rn", "/bin/sh", "-c", script, "sh", cohort_program(), "serve",
                    demo_experiment(), "--domain", domain.text(), "--network", address});
    EXPECT_TRUE(server.wait_for_output("serving 16 robots")) << server.output();
    const bool warns =
        server.output().find(
            "warning: no security: anyone who can reach 10.77.0.1 can drive robots, control this run and end it") !=
        std::string::npos;
    EXPECT_EQ(warns, address == "10.77.0.1") << server.output();
  }
}

}  // namespace
}  // namespace cohort::test
