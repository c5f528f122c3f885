#include <exception>
#include <mutex>
#include <thread>
#include <utility>

#include "client_sdk/include/cohort/client.hpp"
#include "client_sdk/src/attachment.hpp"
#include "client_sdk/src/claims.hpp"
#include "client_sdk/src/hand_over.hpp"
#include "client_sdk/src/loop_host.hpp"
#include "client_sdk/src/standard_streams.hpp"

namespace cohort {

struct Client::State {
  explicit State(const ClientOptions& given)
      : options(given), host(given.name.empty() ? "client" : given.name, hand_over) {
    options.name = host.name();
    options.tell = [this, tell_user = given.tell](Severity severity, const std::string& text) {
      if (tell_user)
        tell_user(severity, text);
      else if (severity != Severity::info)
        print_message(options.name + ": " + text);
      if (severity != Severity::error) return;
      const std::lock_guard lock(mutex);
      why = text;
    };
    thread = std::thread([this] { run(); });
  }

  void run() noexcept {
    ClientEnd end = ClientEnd::failed;
    try {
      end = run_client(host, options.name, options, stop, &watch, &claims);
    } catch (const std::exception& error) {
      options.tell(Severity::error, error.what());
    }
    const std::lock_guard lock(mutex);
    hand_over.end({end, std::exchange(why, {})});
  }

  ClientOptions options;
  std::atomic<bool> stop{false};
  RunWatch watch;
  Claims claims;
  HandOver hand_over;
  LoopHost host;
  std::mutex mutex;
  std::string why;  // guarded by `mutex`
  std::thread thread;
};

Client::Client(const ClientOptions& options) : state_(std::make_unique<State>(options)) {}

Client::~Client() {
  state_->stop = true;
  state_->hand_over.leave();
  state_->thread.join();
}

ClientEvent Client::next() {
  answer();
  return *state_->hand_over.take(std::nullopt);
}

std::optional<ClientEvent> Client::next(std::chrono::milliseconds at_most) {
  answer();
  return state_->hand_over.take(std::chrono::steady_clock::now() + at_most);
}

void Client::claim(std::vector<std::string> robots) { state_->claims.set(std::move(robots)); }
void Client::answer() { state_->hand_over.answer(); }
void Client::leave_unanswered() { state_->hand_over.leave_unanswered(); }
void Client::fail(const std::string& why) { state_->hand_over.fail(why); }
bool Client::is_over() const { return state_->watch.is_over(); }
int Client::descriptor() const { return state_->hand_over.descriptor(); }

}  // namespace cohort
