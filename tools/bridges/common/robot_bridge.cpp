// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/common/robot_bridge.hpp"

#include <exception>
#include <utility>
#include <variant>

#include "idl/text/standard_streams.hpp"

namespace cohort::bridges {
namespace {

constexpr std::chrono::milliseconds stop_is_asked_every{100};
constexpr std::chrono::milliseconds ends_by_itself_within{1000};

// How a program finds the link at `place`: an IPv4 address and a port, or a path.
std::vector<std::string> variables_of(const std::string& place) {
  const auto colon = place.rfind(':');
  const bool is_path = colon == std::string::npos || place.find_first_not_of("0123456789.:") != std::string::npos;
  if (is_path) return {"COHORT_DEVICE=" + place};
  return {"COHORT_ADDRESS=" + place.substr(0, colon), "COHORT_PORT=" + place.substr(colon + 1)};
}

std::string text_of(Silence silence) {
  switch (silence) {
    case Silence::wait: return "the run waits until a program connects again";
    case Silence::stand: return "the robot stands";
    case Silence::hold: return "the robot keeps its last command";
  }
  return "";
}

}  // namespace

RobotBridge::RobotBridge(Options options, Driver driver, Patience patience, std::atomic<bool>& stop)
    : options_(std::move(options)),
      firmware_(std::move(driver.firmware)),
      patience_(patience),
      stop_(stop),
      conversation_(std::move(driver.link), options_.who,
                    {[this] { return stop_ || client_->is_over(); }, [this](const std::string& text) { tell(text); }}) {
  tell("waiting for the " + options_.who + " at " + conversation_.place());
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
  end_program();
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
        for (const DrivenRobot& robot : lease->robots) {
          firmware_->start(robot);
          const StartReason reason = robot.start.reason;
          is_other_run_ = is_other_run_ || reason == StartReason::reset || reason == StartReason::restored;
        }
      if (const auto* frame = std::get_if<Frame>(&*event)) answer(client, *frame);
      // The state of firmware is in the firmware, and is not saved here.
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

void RobotBridge::answer(Client& client, const Frame& frame) {
  for (FrameRobot& robot : frame.robots) {
    if (!options_.command.empty()) begin_frame(frame, robot.robot->start);
    const bool is_silent = !firmware_->exchange(conversation_, robot.observation);
    // A program in virtual time that is connected has nothing to say in this frame, and the robot keeps its command.
    const bool is_gone = !conversation_.is_in_virtual_time() || !conversation_.is_connected();
    if (is_silent && is_gone && patience_.silence == Silence::wait && !robot.robot->policy.waits) {
      client.leave_unanswered();
      return;
    }
    if (is_silent && is_gone && patience_.silence == Silence::stand) firmware_->stand();
    firmware_->act(robot.command);
  }
}

void RobotBridge::begin_frame(const Frame& frame, const Start& robot) {
  if (!program_) start_program(frame.time);
  program_->begin_frame(frame.time, frame.time + robot.step * robot.period, std::exchange(is_other_run_, false));
}

// On the thread that drives the robot, since a program ends with the thread that has started it.
void RobotBridge::start_program(std::chrono::nanoseconds time) {
  TimedProgram::Options options;
  options.command = options_.command;
  options.environment = variables_of(conversation_.place());
  options.environment.push_back("COHORT_ROBOT=" + options_.client.robots.front());
  options.start = time;
  options.given_up = [this] { return conversation_.is_given_up(); };
  options.tell = [this](const std::string& text) { tell(text); };
  options.ended = [this](const std::string& how) {
    tell("'" + options_.command + "' " + how + ": " + text_of(patience_.silence));
  };
  program_ = std::make_unique<TimedProgram>(std::move(options));
  is_other_run_ = false;
  conversation_.goes_by_time_of(program_.get());
}

void RobotBridge::end_program() {
  if (!program_) return;
  conversation_.leave();
  program_->end(stop_ ? std::chrono::milliseconds(0) : ends_by_itself_within);
  conversation_.goes_by_time_of(nullptr);
  program_.reset();
}

void RobotBridge::tell(const std::string& text) const {
  print_message("robot " + options_.client.robots.front() + ": " + text);
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
