// SPDX-License-Identifier: Apache-2.0
#include "client_sdk/src/attachment.hpp"

#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "client_sdk/src/client_states.hpp"
#include "client_sdk/src/frame_queue.hpp"
#include "client_sdk/src/network_clock.hpp"
#include "client_sdk/src/robot_descriptions.hpp"
#include "client_sdk/src/this_process.hpp"
#include "idl/dds/transport.hpp"
#include "idl/text/printable.hpp"
#include "idl/text/standard_streams.hpp"

namespace cohort {
namespace {

using Clock = NetworkClock;
using namespace std::chrono_literals;

constexpr auto stop_is_polled_every = 100ms;
constexpr auto state_is_asked_for_every = 20ms;
constexpr auto patience_before_notice = 3s;
constexpr auto joins_again_every = 1s;
constexpr auto time_for_last_words = 500ms;
// For longer steps, the cost of a hand-over does not matter, and DDS must not be blocked. A few steps may be long
// because other processes used the processor.
constexpr auto longest_inline_frame = 1ms;
constexpr int most_long_frames = 8;  // consecutive
constexpr int frames_kept_by_dds = 8;

std::optional<wire::Identity> identity_of(const ClientOptions& options) {
  if (options.secure.empty()) return std::nullopt;
  wire::Identity identity = wire::read_identity(options.secure);
  if (identity.role == wire::Role::observer)
    throw wire::WireError("the identity in " + options.secure + " is an observer's and cannot drive robots");
  return identity;
}

// Releases a lock for a scope.
class Unlocked {
 public:
  explicit Unlocked(std::unique_lock<std::mutex>& lock) : lock_(lock) { lock_.unlock(); }
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;
  ~Unlocked() { lock_.lock(); }

 private:
  std::unique_lock<std::mutex>& lock_;
};

// The client side of the protocol for one process. DDS threads only store received data in the members under `mutex_`.
// The thread in `run` does the rest; with `inline_step`, the thread that received a frame answers it if no other thread
// does.
class Attachment {
 public:
  Attachment(FrameHandler& handler, const std::string& name, const ClientOptions& options,
             const std::atomic<bool>& stop, RunWatch* watch, Claims* claims);
  Attachment(const Attachment&) = delete;
  Attachment& operator=(const Attachment&) = delete;
  ~Attachment() {
    if (claims_ != nullptr) claims_->on_set({});
  }
  ClientEnd run();

 private:
  using Lock = std::unique_lock<std::mutex>;
  struct Offer {
    wire::Admit admit;
    wire::Sender sender;
  };

  // Called on DDS threads.
  void receive(const wire::Admit& admit, const wire::Sender& sender);
  template <class Described>  // a RobotDescription or a RobotTree
  void describe(const Described& described, const wire::Sender& sender);
  void note_trees(const wire::Sender& writer);
  std::optional<wire::Reader<wire::RobotTree>> make_tree_reader();
  void receive(const wire::Observation& frame);
  void receive(const wire::Report& report);
  void note_server(const wire::Sender& writer, bool alive);
  void wake(Lock lock);

  // The functions below are called with `driving_` and `lock` held; `lock` is released during calls of controllers and
  // DDS.
  void drive(Lock& lock);
  void drive_inline(Lock& lock);
  void heed(const wire::Report& report);
  void heed(Offer offer, Lock& lock);
  void exchange_states(Lock& lock);
  void answer_frames(Lock& lock);

  std::optional<ClientEnd> reason_to_leave();
  bool server_is_lost() const;
  void tell_whether_server_responds(bool is_acknowledged);
  std::string waiting_text() const;
  ClientEnd fail(Lock& lock);
  void tell(Severity severity, const std::string& text) const;

  const ClientOptions options_;
  const std::string name_;
  const std::uint64_t id_ = random_id();
  const std::atomic<bool>& stop_;
  RunWatch* const watch_;
  Claims* const claims_;

  std::mutex driving_;  // held by the thread that uses the controllers
  FrameHandler& handler_;

  std::mutex mutex_;  // guards the following members up to the participant
  std::condition_variable wake_;
  bool news_ = false;
  int long_frames_ = 0;           // number of consecutive ones answered on a DDS thread
  std::optional<Offer> offered_;  // an Admit that has not been handled
  std::optional<Offer> current_;
  RobotDescriptions descriptions_;
  std::vector<wire::Report> reports_;
  FrameQueue frames_;
  std::uint64_t tick_ = 0;  // tick of the last frame that was started
  std::optional<std::string> failure_;
  bool starting_ = false;  // the controllers are in `start`, or have failed there
  std::optional<ClientEnd> end_;
  std::set<std::uint64_t> servers_;  // live writers of our Admit
  std::optional<Clock::time_point> server_left_;
  std::set<std::string> reasons_told_;
  Clock::time_point since_ = Clock::now();
  bool notice_given_ = false;
  Clock::time_point received_at_;  // the last frame
  bool is_silent_ = false;         // the server, and the user was told

  wire::Participant participant_;
  wire::Writer<wire::Join> joins_;
  wire::Writer<wire::Command> commands_;
  wire::Writer<wire::Report> own_reports_;
  std::optional<wire::Reader<wire::RobotTree>> tree_reader_;  // none if the identity was made without the right to it
  wire::Reader<wire::RobotDescription> description_reader_;
  wire::Reader<wire::Admit> admit_reader_;
  wire::Reader<wire::Report> report_reader_;
  wire::Reader<wire::Observation> frame_reader_;
  ClientStates states_;  // with `driving_` held
};

Attachment::Attachment(FrameHandler& handler, const std::string& name, const ClientOptions& options,
                       const std::atomic<bool>& stop, RunWatch* watch, Claims* claims)
    : options_(options),
      name_(options.name.empty() ? name : options.name),
      stop_(stop),
      watch_(watch),
      claims_(claims),
      handler_(handler),
      participant_(wire::Participant::client(options.domain, options.server, identity_of(options))),
      joins_(participant_),
      commands_(participant_),
      own_reports_(participant_),
      tree_reader_(make_tree_reader()),
      description_reader_(participant_,
                          {[this](const auto& message, const auto& sender) { describe(message, sender); }, nullptr}),
      admit_reader_(participant_,
                    {[this](const auto& message, const auto& sender) { receive(message, sender); },
                     [this](const auto& sender, bool alive) { note_server(sender, alive); }},
                    wire::partition_of(id_)),
      report_reader_(participant_, {[this](const auto& message, const auto&) { receive(message); }, nullptr},
                     wire::partition_of(id_)),
      frame_reader_(participant_, {[this](const auto& message, const auto&) { receive(message); }, nullptr},
                    wire::partition_of(id_), frames_kept_by_dds),
      states_(participant_, id_, [this] { wake(Lock(mutex_)); }) {
  if (claims_ != nullptr) claims_->on_set([this] { wake(Lock(mutex_)); });
}

ClientEnd Attachment::run() {
  wire::Join join{.client = id_,
                  .minor = states_.are_possible() ? wire::minor_version : wire::first_minor_with_state - 1,
                  .controller = name_,
                  .host = host_name(),
                  .process = static_cast<std::uint32_t>(::getpid()),
                  .robots = options_.robots};
  Clock::time_point joins_at = Clock::now();
  for (;;) {
    // Write repeatedly: to DDS, a writer that has briefly lost its liveliness is alive only when it writes.
    if (claims_ != nullptr && claims_->take(join.robots)) joins_at = Clock::now();
    if (Clock::now() >= joins_at) {
      tell_whether_server_responds(joins_.matched() > 0 && joins_.wait_until_received(0ms));
      joins_.write(join);
      joins_at = Clock::now() + joins_again_every;
    }
    auto sleep = stop_is_polled_every;
    {
      const std::lock_guard driving(driving_);
      Lock lock(mutex_);
      drive(lock);
      if (failure_) return fail(lock);
      if (end_) return *end_;
      if (states_.are_awaited()) sleep = state_is_asked_for_every;
    }
    Lock lock(mutex_);
    if (const auto end = reason_to_leave()) return *end;
    const WaitsByNetworkClock real_time;
    wake_.wait_for(lock, sleep, [&] { return news_; });
    news_ = false;
  }
}

void Attachment::receive(const wire::Admit& admit, const wire::Sender& sender) {
  if (admit.client != id_) return;
  Lock lock(mutex_);
  // Only the latest one is valid: by writing it, the server has withdrawn the previous one.
  offered_ = Offer{admit, sender};
  wake(std::move(lock));
}

template <class Described>
void Attachment::describe(const Described& described, const wire::Sender& sender) {
  Lock lock(mutex_);
  descriptions_.add(described, sender.participant);
  wake(std::move(lock));
}

void Attachment::note_trees(const wire::Sender& writer) {
  const Lock lock(mutex_);
  descriptions_.expect_trees(writer.participant);
}

// Must exist before the reader of descriptions: docs/protocol.md, "Kinematic trees".
std::optional<wire::Reader<wire::RobotTree>> Attachment::make_tree_reader() {
  try {
    return std::make_optional<wire::Reader<wire::RobotTree>>(
        participant_, wire::Reader<wire::RobotTree>::Callbacks{
                          [this](const auto& tree, const auto& sender) { describe(tree, sender); },
                          [this](const auto& sender, bool alive) {
                            if (alive) note_trees(sender);
                          }});
  } catch (const wire::WireError&) {
    if (!participant_.identity()) throw;
    return std::nullopt;
  }
}

void Attachment::receive(const wire::Report& report) {
  if (report.client != id_) return;
  if (watch_ != nullptr && report.kind != wire::ReportKind::rejected) watch_->note_end();
  Lock lock(mutex_);
  reports_.push_back(report);
  wake(std::move(lock));
}

void Attachment::receive(const wire::Observation& frame) {
  if (frame.client != id_) return;
  Lock lock(mutex_);
  frames_.arrive(frame);
  received_at_ = Clock::now();
  if (options_.inline_step && long_frames_ < most_long_frames && !offered_) {
    news_ = true;  // for the thread in `run`: if it is using the controllers, it checks again before it sleeps
    lock.unlock();
    const std::unique_lock driving(driving_, std::try_to_lock);
    lock.lock();
    if (driving) drive_inline(lock);
    if (driving && !failure_ && !end_) return;
  }
  wake(std::move(lock));
}

void Attachment::note_server(const wire::Sender& writer, bool alive) {
  Lock lock(mutex_);
  if (alive) {
    servers_.insert(writer.writer);
    server_left_.reset();
  } else if (servers_.erase(writer.writer) != 0 && servers_.empty()) {
    server_left_ = Clock::now();
  }
  if (watch_ != nullptr) watch_->note_server(!server_left_);
}

void Attachment::wake(Lock lock) {
  news_ = true;
  lock.unlock();
  wake_.notify_one();
}

void Attachment::drive(Lock& lock) {
  try {
    for (const wire::Report& report : std::exchange(reports_, {})) heed(report);
    if (offered_ && descriptions_.describe(offered_->admit, offered_->sender.participant))
      heed(*std::exchange(offered_, std::nullopt), lock);
    exchange_states(lock);
    answer_frames(lock);
  } catch (const LeaveRun&) {
    for (const wire::Report& report : std::exchange(reports_, {})) heed(report);
    if (!end_ && !server_is_lost()) end_ = ClientEnd::interrupted;
  } catch (const std::exception& error) {
    failure_ = error.what();
  }
}

void Attachment::drive_inline(Lock& lock) {
  const auto begin = Clock::now();
  drive(lock);
  long_frames_ = Clock::now() - begin > longest_inline_frame ? long_frames_ + 1 : 0;
}

void Attachment::heed(const wire::Report& report) {
  switch (report.kind) {
    case wire::ReportKind::finished: end_ = ClientEnd::finished; break;
    case wire::ReportKind::superseded:
      tell(Severity::error, "another process took over these robots. " + report.text);
      end_ = ClientEnd::superseded;
      break;
    case wire::ReportKind::failed:
      tell(Severity::error, "the run failed. " + report.text);
      end_ = ClientEnd::failed;
      break;
    case wire::ReportKind::rejected:
      if (reasons_told_.insert(report.reason).second) {
        tell(Severity::warning, "the server rejected the answer to tick " + std::to_string(report.tick) + " (" +
                                    report.reason + "; logged once). " + report.text);
      }
      break;
  }
}

void Attachment::heed(Offer offer, Lock& lock) {
  const wire::Admit& admit = offer.admit;
  if (admit.status != wire::AdmitStatus::admitted) {
    tell(Severity::error, "refused: " + admit.reason);
    end_ = ClientEnd::refused;
    return;
  }
  const bool begun_already = current_ && current_->sender.writer == offer.sender.writer &&
                             current_->admit.run == admit.run && current_->admit.epoch == admit.epoch;
  if (begun_already) return;
  // The epochs of another server may be lower if its clock is behind.
  if (current_ && current_->sender.participant != offer.sender.participant) frames_ = {};
  const bool has_more = admit.start_reason == wire::StartReason::more_robots;
  const bool goes_on = has_more && current_ && current_->sender.participant == offer.sender.participant &&
                       current_->admit.run == admit.run;
  current_ = std::move(offer);
  if (has_more && !goes_on) current_->admit.start_reason = wire::StartReason::first;
  tick_ = current_->admit.tick;
  if (goes_on)
    frames_.extend(current_->admit);
  else
    frames_.begin(current_->admit);
  const std::vector<wire::RobotDescription> descriptions = descriptions_.keep(current_->sender.participant);
  const Unlocked unlocked(lock);
  starting_ = true;
  handler_.start(current_->admit, descriptions);
  starting_ = false;
  states_.begin(current_->admit);
}

void Attachment::exchange_states(Lock& lock) {
  if (!states_.have_work()) return;
  std::vector<std::string> notices;
  {
    const std::uint64_t next_tick = frames_.next_tick();
    const Unlocked unlocked(lock);
    notices = states_.act(handler_, next_tick);
  }
  for (const std::string& notice : notices) tell(Severity::warning, notice);
}

void Attachment::answer_frames(Lock& lock) {
  if (states_.are_awaited()) return;
  // Frames may arrive faster than they can be answered, so check for more urgent events between them.
  while (!end_ && !failure_ && !stop_ && !offered_ && reports_.empty()) {
    if (const auto repeat = frames_.next_repeat()) {
      const Unlocked unlocked(lock);
      commands_.write(*repeat);
      continue;
    }
    const wire::Observation* frame = frames_.next();
    if (frame == nullptr) return;
    tick_ = frame->tick;
    std::span<const double> values;
    try {
      const Unlocked unlocked(lock);
      values = handler_.answer(*frame);
    } catch (const NoAnswer&) {
      frames_.leave_unanswered();
      continue;
    }
    const wire::Command command = frames_.finish(values);
    const Unlocked unlocked(lock);
    commands_.write(command);  // a failed write counts as lost, and the server asks again
  }
}

std::optional<ClientEnd> Attachment::reason_to_leave() {
  if (stop_) {
    tell(Severity::info, "interrupted");
    return ClientEnd::interrupted;
  }
  if (server_is_lost()) {
    tell(Severity::error,
         "the server at " + options_.server + ", domain " + std::to_string(options_.domain) + " is gone");
    return ClientEnd::server_lost;
  }
  if (!current_ && !notice_given_ && Clock::now() - since_ > patience_before_notice) {
    notice_given_ = true;
    tell(Severity::warning, joins_.matched() == 0 ? waiting_text() : "waiting for the server to admit this client");
  }
  return std::nullopt;
}

// `is_acknowledged`: whether the server has acknowledged the Join of a second ago.
void Attachment::tell_whether_server_responds(bool is_acknowledged) {
  const Lock lock(mutex_);
  const bool is_silent = !is_acknowledged && Clock::now() - received_at_ > joins_again_every;
  if (!current_ || end_ || is_silent == is_silent_) return;
  is_silent_ = is_silent;
  const std::string server = "the server at " + options_.server + ", domain " + std::to_string(options_.domain);
  tell(Severity::warning, is_silent ? server +
                                          " has not responded for 1 s: it has ended or stopped, or it cannot be "
                                          "reached. Waiting a few seconds for it"
                                    : server + " responds again");
}

bool Attachment::server_is_lost() const { return server_left_ && Clock::now() - *server_left_ > server_may_be_away; }
std::string Attachment::waiting_text() const {
  std::string text = "waiting for a server at " + options_.server + ", domain " + std::to_string(options_.domain);
  const auto& identity = participant_.identity();
  if (!identity) return text;
  return text + ", as '" + identity->name + "' of " + identity->folder.string() +
         ". Check that the server uses --secure, that its folder contains server/" + identity->name +
         " from the same certificate authority ('cohort security list' shows it), and that its "
         "certificates and both clocks are valid; 'cohort doctor' checks all of this";
}

ClientEnd Attachment::fail(Lock& lock) {
  const bool is_unfit = starting_ && !options_.start_must_succeed;
  tell(Severity::error, *failure_);
  const wire::Report report{.client = id_,
                            .run = current_ ? current_->admit.run : 0,
                            .kind = wire::ReportKind::failed,
                            .tick = tick_,
                            .reason = is_unfit ? wire::failed_in_start : "exception",
                            .text = *failure_};
  const Unlocked unlocked(lock);
  if (own_reports_.write(report)) own_reports_.wait_until_received(time_for_last_words);
  return ClientEnd::failed;
}

void Attachment::tell(Severity severity, const std::string& said) const {
  const std::string text = printable(said, std::string::npos, Lines::kept);
  if (options_.tell)
    options_.tell(severity, text);
  else
    print_message(name_ + ": " + text);
}

}  // namespace

ClientEnd run_client(FrameHandler& handler, const std::string& name, const ClientOptions& options,
                     const std::atomic<bool>& stop, RunWatch* watch, Claims* claims) {
  return Attachment(handler, name, options, stop, watch, claims).run();
}

ClientEnd run_client(const ControllerKind& kind, const ClientOptions& options, const std::atomic<bool>& stop) {
  const std::unique_ptr<FrameHandler> handler = make_handler(kind);
  return run_client(*handler, kind.name, options, stop, nullptr);
}

ClientEnd run_client(const Plugin& plugin, const ClientOptions& options, const std::atomic<bool>& stop) {
  return run_client(kind_of(plugin), options, stop);
}

}  // namespace cohort
