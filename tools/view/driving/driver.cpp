// SPDX-License-Identifier: Apache-2.0
#include "tools/view/driving/driver.hpp"

#include <chrono>
#include <condition_variable>
#include <stop_token>
#include <utility>

namespace cohort::view {
namespace {

// On a busy machine a server may be found only after seconds.
constexpr std::chrono::seconds longest_claim{10};

class ObedientController final : public Controller {
 public:
  ObedientController(HeldCommand& command, std::function<void()> begun) : held_(command), begun_(std::move(begun)) {}

  void start(const Start& start) override {
    // The parameters are for the other controllers of this team.
    for (const Parameter& parameter : start.parameters.all()) start.parameters.has(parameter.name);
    channels_.clear();
    channels_.reserve(start.command_channels.size());
    for (const ChannelInfo& channel : start.command_channels) channels_.push_back(start.command(channel.name));
    held_.begin(start.command_channels);
    begun_();
  }

  void step(const Observation&, Command& command) override {
    const std::vector<double> values = held_.values(HeldCommand::Clock::now());
    if (values.empty()) return;
    auto next = values.begin();
    for (const CommandChannel& channel : channels_)
      for (std::size_t i = 0; i < channel.size; ++i) command.set(channel, *next++, i);
  }

  void save(StateWriter&) const override {}  // the page holds the command

 private:
  HeldCommand& held_;
  std::function<void()> begun_;
  std::vector<CommandChannel> channels_;
};

}  // namespace

ControllerKind obedient_controllers(HeldCommand& command, std::function<void()> begun) {
  return {"view", [&command, begun = std::move(begun)] {
            return OwnedController(new ObedientController(command, begun),
                                   [](Controller* controller) { delete controller; });
          }};
}

Driver::Driver(ClientOptions options, std::function<void(const Answer&)> claimed, std::shared_future<void> after)
    : options_(std::move(options)), claimed_(std::move(claimed)) {
  options_.tell = [this](Severity severity, const std::string& text) { tell(severity, text); };
  thread_ = std::thread([this, after = std::move(after)] { run(after); });
}

Driver::~Driver() {
  leave();
  thread_.join();
}

bool Driver::has_ended() const { return ended_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }

std::string Driver::why() const {
  const std::lock_guard lock(mutex_);
  return why_;
}

void Driver::run(const std::shared_future<void>& after) {
  if (after.valid()) after.wait();
  const std::string why = drive();
  {
    const std::lock_guard lock(mutex_);
    why_ = why;
  }
  answer({false, why});
  end_.set_value();
}

// Until it ends; why.
std::string Driver::drive() {
  const std::string robot = options_.robots.front();
  const auto begun = [this, robot] {
    {
      const std::lock_guard lock(mutex_);
      has_begun_ = true;
      told_.clear();  // it no longer waits for the server
    }
    answer({true, "drives " + robot});
  };
  const std::jthread limit([this](const std::stop_token& stop) { limit_claim(stop); });
  try {
    const ClientEnd end = run_client(obedient_controllers(command_, begun), options_, leaves_);
    const std::lock_guard lock(mutex_);
    switch (end) {
      case ClientEnd::finished: return "the run is over";
      case ClientEnd::interrupted: return told_.empty() ? robot + " is released" : told_;
      case ClientEnd::refused:
      case ClientEnd::superseded:
      case ClientEnd::failed:
      case ClientEnd::server_lost: break;
    }
    return told_;
  } catch (const std::exception& error) {
    return error.what();
  }
}

// The client itself would wait on.
void Driver::limit_claim(const std::stop_token& stop) {
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex_);
  stopped.wait_for(lock, stop, longest_claim, [] { return false; });
  if (has_begun_ || leaves_ || stop.stop_requested()) return;
  leaves_ = true;
  told_ = options_.robots.front() + " could not be claimed" + (told_.empty() ? "" : " (" + told_ + ")") +
          ". Its current controller may be silent because the run is not advancing";
}

void Driver::tell(Severity severity, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (leaves_) return;
  told_ = text;
  if (!has_begun_ && severity == Severity::error) leaves_ = true;
}

void Driver::answer(const Answer& answer) {
  std::function<void(const Answer&)> claimed;
  {
    const std::lock_guard lock(mutex_);
    claimed = std::exchange(claimed_, nullptr);
  }
  if (claimed) claimed(answer);
}

}  // namespace cohort::view
