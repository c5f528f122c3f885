// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/commands/doctor/doctor.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "idl/dds/survey.hpp"
#include "tests/support/keys.hpp"
#include "tests/support/worlds/version_2.hpp"

// Each test causes a fault that the doctor must find.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;
using tool::Finding;
using tool::Health;

struct Examined {
  std::optional<int> exit_code;
  std::map<std::string, nlohmann::json> findings;  // the last of each check
  std::string all;
  std::string health(const std::string& check) { return findings[check].value("health", "missing"); }
  std::string found(const std::string& check) { return findings[check].value("found", ""); }
  std::string advice(const std::string& check) { return findings[check].value("advice", ""); }
};

Examined examine(const std::vector<std::string>& arguments, const std::vector<std::string>& around = {}) {
  std::vector<std::string> command = around;
  command.insert(command.end(), {cohort_program(), "doctor", "--json"});
  command.insert(command.end(), arguments.begin(), arguments.end());
  const Ended ended = run_to_end(command);
  Examined examined{ended.exit_code, {}, ended.out + ended.err};
  for (const auto& finding : nlohmann::json::parse(ended.out, nullptr, false))
    examined.findings[finding.value("check", "")] = finding;
  return examined;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Runs a command in a separate network namespace, after `setup`.
std::vector<std::string> alone(const std::string& setup) {
  return {"/usr/bin/unshare", "-rn", "/bin/sh", "-c", setup + " && exec \"$@\"", "sh"};
}

bool has_namespaces() { return run_to_end({"/usr/bin/unshare", "-rn", "/bin/true"}).exit_code == 0; }

TEST(Doctor, FindsNoProblemOnAHealthyMachine) {
  const ReservedDomain domain;
  Examined examined = examine({"--domain", domain.text()});
  EXPECT_EQ(examined.exit_code, 0) << examined.all;
  for (const char* check : {"interface", "multicast", "ports", "firewall", "server", "library"})
    EXPECT_EQ(examined.health(check), "ok") << check << examined.all;
  for (const char* check : {"buffers", "limits", "clock", "processor"})
    EXPECT_TRUE(examined.health(check) == "ok" || examined.health(check) == "warning") << examined.all;
}

TEST(Doctor, PrintsFindingsAsText) {
  const ReservedDomain domain;
  const Ended ended = run_to_end({cohort_program(), "doctor", "--domain", domain.text(), "--network", "10.250.250.1"});
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_TRUE(has(ended.out,
                  "problem  interface  no active interface has the address 10.250.250.1; active interfaces: 127.0.0.1"))
      << ended.out;
  EXPECT_TRUE(has(ended.out, "-> Use one of these addresses for --network")) << ended.out;
}

TEST(Doctor, ReportsAServerItsRobotsAndItsTick) {
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", demo_experiment(), "--domain", domain.text(), "--speed", "1"});
  ASSERT_TRUE(server.wait_for_output("serving")) << server.output();
  Examined waiting = examine({"--domain", domain.text(), "--server", "127.0.0.1"});
  EXPECT_EQ(waiting.exit_code, 0) << waiting.all;
  EXPECT_TRUE(has(waiting.found("server"), "a server answers; its robots: sbot; no run is in progress")) << waiting.all;
  EXPECT_TRUE(has(waiting.found("ports"), "process " + std::to_string(server.pid()) + " (cohort), a server"))
      << waiting.all;

  Process controllers({cohort_program(), "host", "obstacle_avoidance", "--robots", "all", "--domain", domain.text()});
  ASSERT_TRUE(server.wait_for_output("x real time")) << server.output();
  Examined running = examine({"--domain", domain.text()});
  EXPECT_TRUE(has(running.found("server"), "run 1 is at tick ")) << running.all;
}

TEST(Doctor, ReportsAMissingServer) {
  const ReservedDomain domain;
  Examined examined = examine({"--domain", domain.text(), "--server", "127.0.0.1"});
  EXPECT_EQ(examined.exit_code, 1) << examined.all;
  EXPECT_TRUE(has(examined.found("server"), "is closed")) << examined.all;
}

TEST(Doctor, NamesTheProcessThatUsesThePortsOfTheDomain) {
  const ReservedDomain domain;
  const int udp = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(wire::discovery_port(domain.number()));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ASSERT_EQ(bind(udp, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  Examined examined = examine({"--domain", domain.text()});
  close(udp);
  EXPECT_EQ(examined.exit_code, 1) << examined.all;
  EXPECT_EQ(examined.health("ports"), "problem");
  EXPECT_TRUE(has(examined.found("ports"), "process " + std::to_string(getpid()))) << examined.all;
}

TEST(Doctor, ReportsThatNoInterfaceIsActive) {
  if (!has_namespaces()) GTEST_SKIP() << "no network namespaces here";
  Examined examined = examine({}, alone("true"));
  EXPECT_EQ(examined.exit_code, 1) << examined.all;
  EXPECT_TRUE(has(examined.advice("interface"), "ip link set lo up")) << examined.all;
}

TEST(Doctor, ReportsLostDatagramsToItsOwnPort) {
  if (!has_namespaces()) GTEST_SKIP() << "no network namespaces here";
  // Packets to an own address use the loopback interface, which is down.
  const std::string setup =
      "ip link add one type veth peer name other && ip addr add 10.77.0.1/24 dev one && ip link set one up";
  Examined examined = examine({"--network", "10.77.0.1"}, alone(setup));
  EXPECT_EQ(examined.exit_code, 1) << examined.all;
  EXPECT_EQ(examined.health("firewall"), "problem") << examined.all;
  EXPECT_EQ(examined.health("interface"), "ok") << examined.all;
  EXPECT_TRUE(has(examined.found("security"), "anyone who can reach 10.77.0.1 can drive the robots")) << examined.all;
}

TEST(Doctor, WarnsOfEphemeralPorts) { EXPECT_EQ(tool::check_ports(200, "127.0.0.1", {0}).health, Health::warning); }

TEST(Doctor, ReportsAServerOfAnotherMajorVersion) {
  const ReservedDomain domain;
  const test::Version2 other(wire::Participant::server(domain.number()));
  Examined examined = examine({"--domain", domain.text(), "--server", "127.0.0.1"});
  EXPECT_EQ(examined.exit_code, 1) << examined.all;
  EXPECT_TRUE(has(examined.found("server"), "uses version 2 of the protocol; this program uses version 1"))
      << examined.all;
}

TEST(Versions, TheServerNamesAClientOfAnotherMajorVersionOnce) {
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", demo_experiment(), "--duration", "1", "--domain", domain.text()});
  ASSERT_TRUE(server.wait_for_output("serving")) << server.output();
  const test::Version2 first(wire::Participant::client(domain.number())),
      second(wire::Participant::client(domain.number()));
  EXPECT_TRUE(
      server.wait_for_output("version: a client uses version 2 of the protocol, but this server uses version 1"))
      << server.output();
  Process controllers({cohort_program(), "host", "obstacle_avoidance", "--robots", "all", "--domain", domain.text()});
  EXPECT_EQ(server.wait_for_exit(), 0) << server.output();
  const std::string output = server.output();
  EXPECT_EQ(output.find("a client uses version"), output.rfind("a client uses version")) << output;
}

TEST(Versions, AreReadFromTheNamesOfTopics) {
  EXPECT_EQ(wire::major_version_of("cohort/v1/join"), 1u);
  EXPECT_EQ(wire::major_version_of("cohort/v22/join"), 22u);
  for (const char* topic :
       {"rt/cohort/v2/join", "cohort/v/join", "cohort/v2", "cohort/v2x/join", "cohort/v99999999999/join"})
    EXPECT_EQ(wire::major_version_of(topic), std::nullopt) << topic;
}

TEST(Doctor, ChecksCertificatesAndExplainsARefusedConnection) {
  const Keys keys, others;
  const ReservedDomain domain;
  Process server({cohort_program(), "serve", demo_experiment(), "--domain", domain.text(), "--secure", keys.folder()});
  ASSERT_TRUE(server.wait_for_output("secure")) << server.output();
  const auto with = [&](const std::string& folder) {
    return examine({"--domain", domain.text(), "--server", "127.0.0.1", "--secure", folder});
  };
  for (const std::string& folder : {keys.folder(), keys.client_folder("red")}) {
    Examined legitimate = with(folder);
    EXPECT_EQ(legitimate.exit_code, 0) << legitimate.all;
    EXPECT_TRUE(has(legitimate.found("server"), "a server answers; its robots: sbot")) << legitimate.all;
    EXPECT_TRUE(has(legitimate.found("security"), "valid until")) << legitimate.all;
  }
  Examined foreign = with(others.client_folder("red"));
  EXPECT_EQ(foreign.exit_code, 1) << foreign.all;
  EXPECT_TRUE(has(foreign.advice("server"), "from different authorities")) << foreign.all;
  Examined none = examine({"--domain", domain.text(), "--server", "127.0.0.1"});
  EXPECT_EQ(none.exit_code, 1) << none.all;
  EXPECT_TRUE(has(none.advice("server"), "The server runs with --secure")) << none.all;
}

TEST(Doctor, FindsProblemsOfAFolderOfIdentities) {
  const auto only = [](const std::vector<Finding>& findings) { return findings.empty() ? Finding{} : findings.back(); };
  const Keys keys("sign", 5), over("sign", 0);
  const Finding soon = only(tool::check_security(keys.client_folder("red")));
  EXPECT_EQ(soon.health, Health::warning);
  EXPECT_TRUE(has(soon.found, "expires at")) << soon.found;
  fs::permissions(keys.client_folder("blue") + "/key.pem", fs::perms::others_read, fs::perm_options::add);
  const Finding open = only(tool::check_security(keys.client_folder("blue")));
  EXPECT_EQ(open.health, Health::warning);
  EXPECT_TRUE(has(open.advice, "chmod 600")) << open.advice;
  EXPECT_EQ(tool::check_security(keys.folder()).size(), 3u);
  EXPECT_EQ(only(tool::check_security("/nowhere")).health, Health::problem);
  write_file(keys.client_folder("red") + "/certificate.pem", "nonsense");
  EXPECT_EQ(only(tool::check_security(keys.client_folder("red"))).health, Health::problem);
  const Finding expired = only(tool::check_security(over.client_folder("red")));
  EXPECT_EQ(expired.health, Health::problem);
  EXPECT_TRUE(has(expired.found, "expired at")) << expired.found;
}

// Files of the kernel on a machine with problems.
TEST(Doctor, ReadsTheLimitsOfTheKernel) {
  const ScratchFolder folder;
  const auto tells = [&](const std::string& file, const std::string& text) {
    fs::create_directories((folder.path() / file).parent_path());
    write_file(folder.path() / file, text + "\n");
  };
  tells("sys/net/core/rmem_max", "212992");
  const Finding buffers = tool::check_buffers(folder.path());
  EXPECT_EQ(buffers.health, Health::warning);
  EXPECT_TRUE(has(buffers.advice, "sysctl -w net.core.rmem_max=4194304")) << buffers.advice;
  tells("sys/net/core/rmem_max", "4194304");
  EXPECT_EQ(tool::check_buffers(folder.path()).health, Health::ok);

  tells("self/cgroup", "0::/box");
  tells("fs/cgroup/box/pids.max", "300");
  tells("fs/cgroup/box/pids.current", "150");
  const Finding limits = tool::check_limits(folder.path(), folder.path());
  EXPECT_EQ(limits.health, Health::warning);
  EXPECT_TRUE(has(limits.found, "in this control group 150 of 300")) << limits.found;
  EXPECT_TRUE(has(limits.advice, "pids.max")) << limits.advice;

  tells("devices/system/cpu/cpu0/cpufreq/scaling_governor", "powersave");
  EXPECT_EQ(tool::check_processor(folder.path()).health, Health::warning);
  tells("devices/system/clocksource/clocksource0/current_clocksource", "hpet");
  const Finding clock = tool::check_clock(folder.path());
  EXPECT_EQ(clock.health, Health::warning);
  EXPECT_TRUE(has(clock.found, "source hpet")) << clock.found;
}

TEST(Doctor, WarnsOfALowLimitOfOpenFiles) {
  Examined examined = examine({}, {"/bin/sh", "-c", "ulimit -n 256; exec \"$@\"", "sh"});
  EXPECT_EQ(examined.health("limits"), "warning") << examined.all;
  EXPECT_TRUE(has(examined.advice("limits"), "ulimit -n 1024")) << examined.all;
}

}  // namespace
}  // namespace cohort::test
