#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "client_sdk/hosting/c_handles.hpp"
#include "client_sdk/src/client.hpp"
#include "client_sdk/src/environment.hpp"

namespace cohort {
namespace {

// Where the client's thread and the loop of whoever connected meet: one event at a time.
class HandOver {
 public:
  // On the client's thread: returns when the loop has answered. Throws LeaveRun if it closes instead.
  void offer(const CohortEvent& event) {
    Lock lock(mutex_);
    event_ = event;
    offered_ = true;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !offered_ || closed_; });
    if (!std::exchange(offered_, false)) return;
    throw LeaveRun{};
  }
  // On the client's thread, at last.
  void end(CohortEnd end, std::string why) {
    const Lock lock(mutex_);
    end_ = end;
    why_ = std::move(why);
    changed_.notify_all();
  }

  // By the loop.
  CohortEvent next() {
    Lock lock(mutex_);
    changed_.wait(lock, [&] { return offered_ || end_; });
    if (offered_) {
      taken_ = true;
      return event_;
    }
    last_error() = why_;
    CohortEvent event{};
    event.kind = cohort_event_end;
    event.end = *end_;
    return event;
  }
  void answer() {
    const Lock lock(mutex_);
    if (!std::exchange(taken_, false)) return;
    offered_ = false;
    changed_.notify_all();
  }
  void close() {
    const Lock lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  using Lock = std::unique_lock<std::mutex>;

  std::mutex mutex_;  // guards all below
  std::condition_variable changed_;
  CohortEvent event_{};
  bool offered_ = false;  // `event_` waits for its answer
  bool taken_ = false;    // the loop has it
  bool closed_ = false;
  std::optional<CohortEnd> end_;
  std::string why_;
};

// Drives a robot by handing over whatever comes.
class LoopController final : public Controller {
 public:
  explicit LoopController(HandOver& hand_over) : hand_over_(hand_over) {}

  void start(const Start& start) override {
    robot_ = start.robot;
    const CohortStart handle(start);
    CohortEvent event{};
    event.kind = cohort_event_start;
    event.robot = robot_;
    event.start = &handle;
    hand_over_.offer(event);
    if (handle.mistake) throw std::runtime_error(*handle.mistake);
  }

  void step(const Observation& observation, Command& command) override {
    const CohortObservation observation_handle{observation};
    CohortCommand command_handle{command};
    CohortEvent event{};
    event.kind = cohort_event_observation;
    event.robot = robot_;
    event.observation = &observation_handle;
    event.command = &command_handle;
    hand_over_.offer(event);
  }

 private:
  HandOver& hand_over_;
  std::uint32_t robot_ = 0;
};

ControllerKind loop_controllers(const std::string& name, HandOver& hand_over) {
  return {name, [&hand_over] {
            return OwnedController(new LoopController(hand_over), [](Controller* controller) { delete controller; });
          }};
}

CohortEnd end_of(ClientEnd end) {
  switch (end) {
    case ClientEnd::finished: return cohort_end_finished;
    case ClientEnd::refused: return cohort_end_refused;
    case ClientEnd::superseded: return cohort_end_superseded;
    case ClientEnd::failed: return cohort_end_failed;
    case ClientEnd::server_lost: return cohort_end_server_lost;
    case ClientEnd::interrupted: break;
  }
  return cohort_end_interrupted;
}

ClientOptions options_of(const CohortOptions* given) {
  ClientOptions options;
  options.name = "controller";
  take_environment(options);
  if (given == nullptr) return options;
  options.domain = given->domain;
  if (given->server != nullptr) options.server = given->server;
  if (given->name != nullptr) options.name = given->name;
  if (given->secure != nullptr) options.secure = given->secure;
  if (given->robots != nullptr) options.robots = split_selectors(given->robots);
  if (options.robots.empty()) throw std::invalid_argument("the options name no robot");
  return options;
}

}  // namespace
}  // namespace cohort

struct CohortClient {
  explicit CohortClient(cohort::ClientOptions its_options) : options(std::move(its_options)) {
    options.tell = [this](cohort::Severity severity, const std::string& text) { tell(severity, text); };
    thread = std::thread([this] { run(); });
  }
  CohortClient(const CohortClient&) = delete;
  CohortClient& operator=(const CohortClient&) = delete;
  ~CohortClient() {
    stop = true;
    hand_over.close();
    thread.join();
  }

  void run() noexcept {
    CohortEnd end = cohort_end_failed;
    try {
      end = cohort::end_of(cohort::run_client(cohort::loop_controllers(options.name, hand_over), options, stop));
    } catch (const std::exception& error) {
      tell(cohort::Severity::error, error.what());
    }
    const std::lock_guard lock(mutex);
    hand_over.end(end, std::exchange(why, {}));
  }

  // Not of an interruption: whoever closes knows.
  void tell(cohort::Severity severity, const std::string& text) {
    if (severity == cohort::Severity::info) return;
    std::fprintf(stderr, "%s: %s\n", options.name.c_str(), text.c_str());
    if (severity != cohort::Severity::error) return;
    const std::lock_guard lock(mutex);
    why = text;
  }

  cohort::ClientOptions options;
  std::atomic<bool> stop{false};
  cohort::HandOver hand_over;
  std::mutex mutex;
  std::string why;  // guarded by `mutex`
  std::thread thread;
};

CohortClient* cohort_connect(const CohortOptions* options) {
  try {
    return new CohortClient(cohort::options_of(options));
  } catch (const std::exception& error) {
    cohort::last_error() = error.what();
    return nullptr;
  }
}

CohortEventKind cohort_next(CohortClient* client, CohortEvent* event) {
  client->hand_over.answer();
  *event = client->hand_over.next();
  return event->kind;
}

void cohort_answer(CohortClient* client) { client->hand_over.answer(); }

void cohort_close(CohortClient* client) { delete client; }

int cohort_run_controller(const CohortPlugin* plugin, int argc, char** argv) {
  return cohort::run_controller(*reinterpret_cast<const cohort::Plugin*>(plugin), argc, argv);
}
