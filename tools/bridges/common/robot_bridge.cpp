#include "tools/bridges/common/robot_bridge.hpp"

#include <cstdio>
#include <exception>
#include <utility>
#include <variant>

namespace cohort::bridges {
namespace {

constexpr std::chrono::milliseconds stop_is_asked_every{100};

}  // namespace

RobotBridge::RobotBridge(Options options, std::unique_ptr<Firmware> firmware, Patience patience,
                         std::atomic<bool>& stop)
    : options_(std::move(options)),
      firmware_(std::move(firmware)),
      patience_(patience),
      stop_(stop),
      conversation_(open_link(options_.link), options_.who,
                    {[this] { return stop_ || client_->is_over(); }, [this](const std::string& text) { tell(text); }}) {
  tell("the " + options_.who + " connects at " + conversation_.place());
  options_.client.tell = [this](Severity, const std::string& text) { tell(text); };
}

RobotBridge::~RobotBridge() {
  if (!thread_.joinable()) return;
  stop_ = true;
  thread_.join();
}

void RobotBridge::start() {
  thread_ = std::thread([this] { run(); });
}

ClientEnd RobotBridge::wait() {
  thread_.join();
  return end_;
}

void RobotBridge::run() {
  try {
    Client client(options_.client);
    client_ = &client;
    end_ = drive(client);
  } catch (const std::exception& error) {
    tell(error.what());
  }
  // The others' runs go on in vain without this one's.
  if (end_ != ClientEnd::finished) stop_ = true;
}

ClientEnd RobotBridge::drive(Client& client) {
  while (!stop_) {
    const std::optional<ClientEvent> event = client.next(stop_is_asked_every);
    if (!event) continue;
    if (const auto* ended = std::get_if<ClientEnded>(&*event)) return ended->end;
    try {
      if (const auto* lease = std::get_if<LeaseStart>(&*event))
        for (const DrivenRobot& robot : lease->robots) firmware_->start(robot);
      if (const auto* frame = std::get_if<Frame>(&*event)) answer(*frame);
      // What firmware remembers is in the firmware.
      if (const auto* save = std::get_if<SaveState>(&*event)) save->state->leave_out();
    } catch (const GaveUp&) {
      // The client says why, if it was not asked to stop.
    } catch (const std::exception& error) {
      client.fail(error.what());
    }
  }
  tell("interrupted");
  return ClientEnd::interrupted;
}

void RobotBridge::answer(const Frame& frame) {
  for (FrameRobot& robot : frame.robots) {
    if (!firmware_->exchange(conversation_, robot.observation) && patience_.silence == Silence::stand)
      firmware_->stand();
    firmware_->act(robot.command);
  }
}

void RobotBridge::tell(const std::string& text) const {
  std::fprintf(stderr, "robot %s: %s\n", options_.client.robots.front().c_str(), text.c_str());
}

int run_bridges(const std::vector<std::unique_ptr<RobotBridge>>& bridges) {
  for (const auto& bridge : bridges) bridge->start();
  const int finished = exit_code_of(ClientEnd::finished);
  int code = finished;
  for (const auto& bridge : bridges) {
    const int its = exit_code_of(bridge->wait());
    if ((code == finished || code == exit_code_of(ClientEnd::interrupted)) && its != finished) code = its;
  }
  return code;
}

}  // namespace cohort::bridges
