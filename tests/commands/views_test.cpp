// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>

#include "tests/commands/small_experiment.hpp"

// `cohort run --view`, whose page is not opened, or cannot be.
namespace cohort::test {
namespace {

namespace fs = std::filesystem;

// A TCP port of the loopback that another program uses.
class TakenPort {
 public:
  TakenPort() : socket_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    auto* const any = reinterpret_cast<sockaddr*>(&address);
    if (bind(socket_, any, size) != 0 || listen(socket_, 1) != 0 || getsockname(socket_, any, &size) != 0)
      throw std::runtime_error("no free port");
    number_ = ntohs(address.sin_port);
  }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;
  ~TakenPort() { close(socket_); }
  std::string text() const { return std::to_string(number_); }

 private:
  int socket_;
  int number_ = 0;
};

TEST(AView, StaysUntilCtrlCIfNoPageWasOpened) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.1);
  const std::string summary = (experiment / "summary.json").string();
  Process run(experiment.run({"--view", "--port", "0", "--speed", "max", "--summary", summary}));
  ASSERT_TRUE(run.wait_for_output("the run has ended; the view stays open")) << run.output();
  EXPECT_TRUE(fs::exists(summary));
  EXPECT_TRUE(run.running());
  run.signal(SIGINT);
  EXPECT_EQ(run.wait_for_exit(), 0) << run.output();
}

TEST(AView, LetsTheRunBeginIfNoBrowserCanBeOpened) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.1);
  const ScratchFolder programs;
  write_file(programs / "xdg-open", "#!/bin/sh\nexit 3\n");
  fs::permissions(programs / "xdg-open", fs::perms::owner_all);
  for (const std::string& path : {programs.path().string() + ":" + std::getenv("PATH"), std::string("/nowhere")}) {
    Process run(experiment.run({"--view", "--port", "0", "--open", "--speed", "max"}), {{"PATH", path}});
    ASSERT_TRUE(run.wait_for_output("the run has ended; the view stays open")) << run.output();
    EXPECT_NE(run.output().find("cannot open a browser: xdg-open "), std::string::npos) << run.output();
    run.signal(SIGINT);
    EXPECT_EQ(run.wait_for_exit(), 0) << run.output();
  }
}

TEST(AView, ThatCannotHaveItsPortStartsNothing) {
  const SmallExperiment experiment(test_controller("misbehaving"), "", 0.1);
  const TakenPort port;
  const Ended run = run_to_end(experiment.run({"--view", "--port", port.text()}));
  EXPECT_EQ(run.exit_code, 2) << run.err;
  EXPECT_NE(run.err.find("cannot listen on 127.0.0.1, port " + port.text() + ": Address already in use"),
            std::string::npos)
      << run.err;
  EXPECT_NE(run.err.find("the run is not started"), std::string::npos) << run.err;
  EXPECT_EQ(run.err.find("restart"), std::string::npos) << run.err;
  EXPECT_EQ(run.out, "");
}

}  // namespace
}  // namespace cohort::test
