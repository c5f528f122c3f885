// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/process.hpp"
#include "tools/bridges/common/conversation.hpp"
#include "tools/bridges/common/descriptor.hpp"
#include "tools/bridges/common/link.hpp"

namespace cohort::bridges {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }
std::string text_of(const Bytes& bytes) { return {bytes.begin(), bytes.end()}; }

// Messages are lines.
std::size_t line_framing(std::span<const std::uint8_t> bytes) {
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == '!') throw std::runtime_error("a line has no '!'");
    if (bytes[i] == '\n') return i + 1;
  }
  return 0;
}

// A conversation over a link, and what it told people.
class Conversing {
 public:
  explicit Conversing(const std::string& place)
      : conversation(open_link(place), "firmware",
                     {[this] { return gives_up; }, [this](const std::string& text) { told += text + "\n"; }}) {}

  std::string receive(const Patience& patience = {}) {
    const auto message = conversation.receive(line_framing, patience);
    return message ? text_of(*message) : "silence";
  }
  void send(const std::string& text) { conversation.send(bytes_of(text)); }

  std::string told;
  bool gives_up = false;
  Conversation conversation;
};

sockaddr_in address_in(const std::string& place) {
  const auto colon = place.rfind(':');
  sockaddr_in endpoint{};
  endpoint.sin_family = AF_INET;
  ::inet_pton(AF_INET, place.substr(0, colon).c_str(), &endpoint.sin_addr);
  endpoint.sin_port = htons(static_cast<std::uint16_t>(std::stoul(place.substr(colon + 1))));
  return endpoint;
}

// The firmware's end: a socket of this type that is connected to a place.
class Peer {
 public:
  Peer(int type, const std::string& place) : socket_(::socket(AF_INET, type | SOCK_CLOEXEC, 0)) {
    const sockaddr_in endpoint = address_in(place);
    EXPECT_EQ(::connect(socket_.number(), reinterpret_cast<const sockaddr*>(&endpoint), sizeof endpoint), 0);
  }
  explicit Peer(const std::string& device) : socket_(::open(device.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    EXPECT_TRUE(socket_.is_open()) << device;
  }
  void write(const std::string& text) const {
    EXPECT_EQ(::write(socket_.number(), text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  std::string read() const {
    char text[256];
    const ssize_t count = ::read(socket_.number(), text, sizeof text);
    return {text, count > 0 ? static_cast<std::size_t>(count) : 0};
  }

 private:
  Descriptor socket_;
};

TEST(Links, OverTcpTakeOneFirmwareAtATimeAndTellWhoComesAndWhyItLeaves) {
  Conversing bridge("tcp:127.0.0.1:0");
  bridge.send("nobody hears this\n");
  {
    const Peer first(SOCK_STREAM, bridge.conversation.place());
    first.write("one\ntw");
    EXPECT_EQ(bridge.receive(), "one\n");
    first.write("o\n");
    EXPECT_EQ(bridge.receive(), "two\n");
    bridge.send("heard\n");
    EXPECT_EQ(first.read(), "heard\n");
    first.write("half");
  }
  const Peer second(SOCK_STREAM, bridge.conversation.place());
  second.write("three\n");
  EXPECT_EQ(bridge.receive(), "three\n");
  EXPECT_NE(bridge.told.find("the firmware has connected from 127.0.0.1:"), std::string::npos) << bridge.told;
  EXPECT_NE(bridge.told.find("has disconnected inside a message, after 4 bytes"), std::string::npos) << bridge.told;
}

TEST(Links, OverUdpAnswerWhereTheLastDatagramCameFrom) {
  Conversing bridge("udp:127.0.0.1:0");
  const Peer first(SOCK_DGRAM, bridge.conversation.place());
  first.write("one\n");
  EXPECT_EQ(bridge.receive(), "one\n");
  const Peer second(SOCK_DGRAM, bridge.conversation.place());
  second.write("two\n");
  EXPECT_EQ(bridge.receive(), "two\n");
  bridge.send("for the second\n");
  EXPECT_EQ(second.read(), "for the second\n");
}

TEST(Links, OverUdpHearTheLaterOfTwoUntilItIsHungUp) {
  Conversing bridge("udp:127.0.0.1:0");
  const Peer first(SOCK_DGRAM, bridge.conversation.place());
  const Peer second(SOCK_DGRAM, bridge.conversation.place());
  first.write("one\n");
  EXPECT_EQ(bridge.receive(), "one\n");
  second.write("two\n");
  EXPECT_EQ(bridge.receive(), "two\n");
  first.write("not heard\n");
  second.write("three\n");
  EXPECT_EQ(bridge.receive(), "three\n");
  bridge.send("to the second\n");
  EXPECT_EQ(second.read(), "to the second\n");
  second.write("broken!\n");
  first.write("four\n");
  EXPECT_EQ(bridge.receive(), "four\n");
  EXPECT_NE(bridge.told.find("the firmware now sends from 127.0.0.1:"), std::string::npos) << bridge.told;
}

TEST(Links, OverUdpWithAPeerSendFirstAndIgnoreOtherSenders) {
  Descriptor firmware(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  sockaddr_in endpoint = address_in("127.0.0.1:0");
  ASSERT_EQ(::bind(firmware.number(), reinterpret_cast<sockaddr*>(&endpoint), sizeof endpoint), 0);
  socklen_t size = sizeof endpoint;
  ::getsockname(firmware.number(), reinterpret_cast<sockaddr*>(&endpoint), &size);
  Conversing bridge("udp:127.0.0.1:0:127.0.0.1:" + std::to_string(ntohs(endpoint.sin_port)));
  bridge.send("first\n");
  char text[16];
  sockaddr_in from{};
  size = sizeof from;
  EXPECT_EQ(::recvfrom(firmware.number(), text, sizeof text, 0, reinterpret_cast<sockaddr*>(&from), &size), 6);

  const Peer stranger(SOCK_DGRAM, bridge.conversation.place());
  stranger.write("from elsewhere\n");
  ::sendto(firmware.number(), "answer\n", 7, 0, reinterpret_cast<sockaddr*>(&from), size);
  EXPECT_EQ(bridge.receive(), "answer\n");
}

TEST(Links, OverAPseudoTerminalAreASerialDeviceToTheFirmware) {
  const test::ScratchFolder folder;
  const std::string device = (folder / "ttyROBOT").string();
  {
    Conversing bridge("pty:" + device);
    EXPECT_EQ(bridge.conversation.place(), device);
    bridge.send("before it is opened\r\n");
    {
      const Peer firmware(device);
      EXPECT_EQ(firmware.read(), "before it is opened\r\n") << "raw: nothing is changed or echoed";
      firmware.write("a\r\n");
      EXPECT_EQ(bridge.receive(), "a\r\n");
    }
    EXPECT_EQ(bridge.receive({Silence::hold, std::chrono::milliseconds(0)}), "silence");
    const Peer again(device);
    again.write("b\n");
    EXPECT_EQ(bridge.receive(), "b\n");
    EXPECT_THROW(open_link("pty:" + device), std::runtime_error) << "the name is taken";
  }
  EXPECT_FALSE(std::filesystem::is_symlink(device));
}

TEST(Links, ToASerialDeviceAreRaw) {
  Conversing other_end("pty");
  Conversing bridge("serial:" + other_end.conversation.place() + ":115200");
  EXPECT_TRUE(bridge.conversation.wait_for_connection({}));
  bridge.send("a\r\n");
  EXPECT_EQ(other_end.receive(), "a\r\n");
  other_end.send("b\n");
  EXPECT_EQ(bridge.receive(), "b\n");
}

TEST(Links, ToAnUnpluggedSerialDeviceAreLostAndReconnectWhenItIsBack) {
  const test::ScratchFolder folder;
  const std::string device = (folder / "ttyBOARD").string();
  std::optional<Conversing> board("pty:" + device);
  Conversing bridge("serial:" + device + ":115200");
  board->send("one\nhalf");
  EXPECT_EQ(bridge.receive(), "one\n");
  board.reset();
  EXPECT_EQ(bridge.receive({Silence::hold, std::chrono::seconds(10)}), "silence");
  EXPECT_NE(bridge.told.find("is lost: " + device + " is unplugged"), std::string::npos) << bridge.told;
  bridge.send("nobody hears this\n");
  EXPECT_EQ(bridge.receive({Silence::hold, std::chrono::milliseconds(0)}), "silence");
  board.emplace("pty:" + device);
  EXPECT_TRUE(bridge.conversation.wait_for_connection({}));
  EXPECT_EQ(bridge.conversation.connections(), 2U);
  board->send("two\n");
  EXPECT_EQ(bridge.receive(), "two\n");
  board.reset();
  bridge.send("it is lost where it is written to\n");
  EXPECT_FALSE(bridge.conversation.is_connected());
}

TEST(Links, ToASerialDeviceAreExclusiveAndItsNameMayHaveColons) {
  const test::ScratchFolder folder;
  const std::string device = (folder / "pci-0000:00:14.0-usb-0:1:1.0-port0").string();
  const Conversing board("pty");
  std::filesystem::create_symlink(board.conversation.place(), device);
  const Conversing bridge("serial:" + device + ":115200");
  EXPECT_EQ(bridge.conversation.place(), device);
  try {
    open_link("serial:" + device + ":9600");
    ADD_FAILURE() << "opened twice";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("another program is using it"), std::string::npos) << error.what();
  }
}

TEST(Conversations, EndConnectionsThatSendWhatCannotBeAMessage) {
  Conversing bridge("tcp:127.0.0.1:0");
  for (const auto& [sent, reason] : {std::pair<std::string, std::string>{"oops!\n", "a line has no '!'"},
                                     {std::string(Conversation::largest_message, 'x'), "has more than 65536 bytes"}}) {
    const Peer wrong(SOCK_STREAM, bridge.conversation.place());
    wrong.write(sent);
    while (bridge.told.find("the firmware is disconnected: ") == std::string::npos)
      EXPECT_EQ(bridge.receive({Silence::stand, std::chrono::milliseconds(10)}), "silence");
    EXPECT_NE(bridge.told.find(reason), std::string::npos) << bridge.told;
    bridge.told.clear();
    EXPECT_EQ(wrong.read(), "");
  }
  const Peer right(SOCK_STREAM, bridge.conversation.place());
  right.write("right\n");
  EXPECT_EQ(bridge.receive(), "right\n");
}

TEST(Conversations, WaitNoLongerThanTheirPatience) {
  Conversing bridge("tcp:127.0.0.1:0");
  EXPECT_EQ(bridge.receive({Silence::stand, std::nullopt}), "silence") << "nobody is connected";
  const Peer silent(SOCK_STREAM, bridge.conversation.place());
  EXPECT_EQ(bridge.receive({Silence::stand, std::chrono::milliseconds(5)}), "silence");
  bridge.gives_up = true;
  EXPECT_THROW(bridge.receive(), GaveUp);
}

TEST(Conversations, HearTheNextFirmwareInTheNextCall) {
  Conversing bridge("tcp:127.0.0.1:0");
  const Patience soon{Silence::hold, std::chrono::milliseconds(100)};
  auto first = std::make_unique<Peer>(SOCK_STREAM, bridge.conversation.place());
  EXPECT_EQ(bridge.receive(soon), "silence");
  EXPECT_EQ(bridge.conversation.connections(), 1u);
  const Peer second(SOCK_STREAM, bridge.conversation.place());
  second.write("second\n");
  first.reset();
  EXPECT_EQ(bridge.receive(soon), "silence");
  EXPECT_EQ(bridge.conversation.connections(), 1u);
  EXPECT_EQ(bridge.receive(soon), "second\n");
  EXPECT_EQ(bridge.conversation.connections(), 2u);
}

TEST(Links, ThatCannotBeOpenedSayWhy) {
  for (const auto& [place, text] : std::vector<std::pair<std::string, std::string>>{
           {"carrier:pigeon", "expected a link tcp:ADDRESS:PORT"},
           {"tcp:localhost:1", "'localhost' is not an IPv4 address"},
           {"tcp:127.0.0.1:70000", "'70000' is not a port"},
           {"udp:127.0.0.1:1:127.0.0.1", "expected a link tcp:ADDRESS:PORT"},
           {"tcp:192.0.2.1:0", "cannot listen on 192.0.2.1:0"},
           {"serial:/no/such/device:115200", "cannot open /no/such/device"},
           {"serial:/dev/null:115200", "cannot be set up as a serial line"},
           {"serial:/dev/null:12345", "unsupported rate of 12345 baud: expected one of 9600"}}) {
    try {
      open_link(place);
      ADD_FAILURE() << place << " was opened";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace cohort::bridges
