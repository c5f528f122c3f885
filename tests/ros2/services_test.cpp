// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>

#include "tests/ros2/services_helper.hpp"
#include "tools/bridges/ros2/services/service_frames.hpp"
#include "tools/bridges/ros2/services/service_process.hpp"

namespace cohort::test {
namespace {

using namespace bridges::ros2;

constexpr std::uint32_t camera = 0, trigger = 1;

OfferService offer(std::uint32_t service, const std::string& name, const std::string& type) {
  return {.service = service,
          .request_topic = "rq" + name + "Request",
          .request_type = type + "_Request_",
          .request_user_data = {},
          .reply_topic = "rr" + name + "Reply",
          .reply_type = type + "_Response_",
          .reply_user_data = {}};
}

// {bool success, string message}, as the replies of both services are.
std::string success(const std::string& message) {
  std::string cdr("\0\1\0\0\1\0\0\0", 8);
  const auto size = static_cast<std::uint32_t>(message.size() + 1);
  cdr.append(reinterpret_cast<const char*>(&size), sizeof size);
  return cdr + message + '\0';
}

// Answers requests as the bridge does.
class Answers {
 public:
  explicit Answers(const OwnNetwork& network) : helper_(network.in({helper_program})) {
    helper_.send(OpenDomain{.domain = 0, .user_data = "enclave=/;", .multicast = true, .peers = {}});
    helper_.send(offer(camera, "/camera/set", "sensor_msgs::srv::dds_::SetCameraInfo"));
    helper_.send(offer(trigger, "/trigger", "std_srvs::srv::dds_::Trigger"));
  }

  // Answers until `is_over`; false if the helper ends or patience runs out.
  bool until(const std::function<bool()>& is_over) {
    return eventually([&] {
      while (const auto frame = helper_.receive(std::chrono::milliseconds(20)))
        if (const auto* request = std::get_if<RequestReceived>(&*frame)) answer(*request);
      return is_over();
    });
  }

  ServiceProcess& helper() { return helper_; }
  const std::map<Guid, std::size_t>& calls() const { return calls_; }
  std::size_t largest() const { return largest_; }

 private:
  void answer(const RequestReceived& request) {
    ++calls_[request.client];
    largest_ = std::max(largest_, request.request.size());
    std::int32_t number = -1;
    if (request.service == camera && request.request.size() >= 8)
      std::memcpy(&number, request.request.data() + 4, sizeof number);
    const std::string text = request.service == camera ? "number " + std::to_string(number) : "triggered";
    helper_.send(SendReply{request.service, request.client, request.sequence, success(text)});
  }

  ServiceProcess helper_;
  std::map<Guid, std::size_t> calls_;
  std::size_t largest_ = 0;
};

// One caller after the other: a reader of a client keeps the last 10 replies to any client, so callers that are slow
// beside others lose theirs.
TEST(Ros2Services, ClientsOfBothDistributionsGetTheAnswersToTheirCalls) {
  if (const std::string missing = missing_for_services(); !missing.empty()) GTEST_SKIP() << missing;
  const OwnNetwork network;
  Answers answers(network);
  for (const Ros2Distribution& distribution : ros2_distributions()) {
    const auto caller = network.start_node(distribution, "caller.py", {"200", "1000", "0"});
    EXPECT_TRUE(answers.until([&] { return !caller->running(); }));
    EXPECT_EQ(caller->output(), "services are there\ntrigger: triggered\nright answers: 200\n") << distribution.name;
  }
}

TEST(Ros2Services, RequestsMayBeLargerThanADatagram) {
  if (const std::string missing = missing_for_services(); !missing.empty()) GTEST_SKIP() << missing;
  const OwnNetwork network;
  Answers answers(network);
  for (const Ros2Distribution& distribution : ros2_distributions()) {
    const auto caller = network.start_node(distribution, "caller.py", {"3", "1", "1000000"});
    EXPECT_TRUE(answers.until([&] { return !caller->running(); }));
    EXPECT_EQ(caller->output(), "services are there\ntrigger: triggered\nright answers: 3\n") << distribution.name;
  }
  EXPECT_GT(answers.largest(), 1'000'000u);
}

TEST(Ros2Services, ABridgeSeesThatItsHelperHasEnded) {
  if (const std::string missing = missing_for_services(); !missing.empty()) GTEST_SKIP() << missing;
  const OwnNetwork network;
  Answers answers(network);
  ASSERT_TRUE(answers.helper().receive(std::chrono::seconds(30)));  // it runs
  ASSERT_FALSE(answers.helper().has_ended());
  ::kill(answers.helper().pid(), SIGKILL);
  EXPECT_TRUE(answers.until([&] { return answers.helper().has_ended(); }));
  answers.helper().send(SendReply{});  // no client takes it
}

// Runs the helper on a file of bytes.
Ended run_helper_on(const std::string& bytes) {
  const ScratchFolder folder;
  std::ofstream(folder / "bytes") << bytes;
  return run_to_end({"/bin/sh", "-c", "exec \"$0\" < \"$1\"", helper_program, (folder / "bytes").string()});
}

TEST(Ros2Services, TheHelperFailsAtAnInvalidFrame) {
  if (!std::filesystem::exists(helper_program)) GTEST_SKIP() << missing_for_services();
  const auto expect_error = [](const std::string& bytes, const std::string& text) {
    const Ended ended = run_helper_on(bytes);
    EXPECT_EQ(ended.exit_code, 1);
    EXPECT_EQ(ended.err, "cohort-ros2-services: standard input: " + text + "\n");
  };
  expect_error("\xff\xff\xff\xff", "frame of 4294967295 bytes; expected 1 to 16777216");
  expect_error(std::string(8, '\0'), "frame of 0 bytes; expected 1 to 16777216");
  expect_error(std::string("\1\0\0\0\x63", 5), "frame: unknown kind 99");
  expect_error(std::string("\3\0\0\0\3ab", 7), "frame: a field has 4 bytes, but only 2 are left");
  expect_error(std::string("\x9\0\0\0\3", 5), "the stream ends inside a frame");
  expect_error(encode(offer(0, "/a", "b")), "no domain is open; expected OpenDomain first");
}

TEST(Ros2Services, FramesPassThroughTheStreamUnchanged) {
  const SendReply reply{7, Guid{1, 2, 3}, -5, "reply"};
  const std::string bytes =
      encode(OpenDomain{42, "enclave=/;", false, {"127.0.0.1", "10.0.0.1"}}) + encode(FrameToHelper(reply));
  FrameStream<FrameToHelper> stream;
  std::vector<FrameToHelper> frames;
  for (const char byte : bytes) {
    stream.append({&byte, 1});
    while (auto frame = stream.next()) frames.push_back(*frame);
  }
  ASSERT_EQ(frames.size(), 2u);
  EXPECT_FALSE(stream.is_inside_frame());
  const auto& open = std::get<OpenDomain>(frames[0]);
  EXPECT_EQ(open.domain, 42u);
  EXPECT_EQ(open.user_data, "enclave=/;");
  EXPECT_FALSE(open.multicast);
  EXPECT_EQ(open.peers, (std::vector<std::string>{"127.0.0.1", "10.0.0.1"}));
  const auto& second = std::get<SendReply>(frames[1]);
  EXPECT_EQ(second.service, 7u);
  EXPECT_EQ(second.client, reply.client);
  EXPECT_EQ(second.sequence, -5);
  EXPECT_EQ(second.reply, "reply");
}

}  // namespace
}  // namespace cohort::test
