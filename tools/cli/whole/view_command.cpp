// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "server/recording/recording.hpp"
#include "tools/cli/commands/commands.hpp"
#include "tools/cli/commands/refuse_experiment.hpp"
#include "tools/cli/commands/shared_options.hpp"
#include "tools/cli/common/installed_files.hpp"
#include "tools/cli/common/shown.hpp"
#include "tools/common/processes/external_program.hpp"
#include "tools/view/sources/followed_run.hpp"
#include "tools/view/sources/recording_source.hpp"
#include "tools/view/web/admission.hpp"
#include "tools/view/web/web_server.hpp"

namespace cohort::tool {
namespace {

struct ViewCommand {
  std::filesystem::path recording;  ///< recording to show; empty: show a server
  Connection connection{};
  std::filesystem::path secure_control{};  ///< folder of an identity that may control
  std::filesystem::path secure_drive{};    ///< folder of an identity that may drive; empty: the one above
  bool may_control = false;
  std::string network = "127.0.0.1";    ///< address of the interface to serve on
  std::optional<std::uint16_t> port{};  ///< 0: any free port; none: 8080, or any free port if 8080 is in use
  std::string token{};  ///< token that browsers must send; empty: random unless only this machine can connect
  std::vector<std::string> origins{};  ///< origins of other pages that may connect
  unsigned threads = 0;                ///< threads that replay a recording; 0: one for each core
  bool opens = false;                  ///< open a browser
  // Options that a run passes to the view that it starts.
  bool plays_when_seen = false;
  bool while_watched = false;       ///< end when the server has ended and no viewer is connected
  std::filesystem::path written{};  ///< recording that the server writes
  std::string again{};              ///< command line that repeats the run
};

constexpr std::uint16_t usual_port = 8080;

bool is_loopback(const std::string& address) { return address.starts_with("127.") || address == "::1"; }

view::WebOptions web_options(const ViewCommand& command, const std::string& name) {
  view::WebOptions options{name, command.network, command.port.value_or(usual_port), command.token, command.origins};
  options.or_any_free_port = !command.port;
  if (options.token.empty() && !is_loopback(command.network)) options.token = view::random_token();
  return options;
}

view::PageFiles page_or_warning(Log& log) {
  view::PageFiles page = view::read_page(installed_page_folder());
  if (page.empty())
    log.warning(
        "the browser page was not built, so only other viewers can connect. To build it, install node 18 and npm "
        "('tools/dev/install-packages tools/dev/packages-node.txt'), then run 'cmake --build build/release --target "
        "view_page'");
  return page;
}

std::string say_where(const ViewCommand& command, const view::WebOptions& options, std::uint16_t port) {
  const std::string host = command.network == "0.0.0.0" ? "127.0.0.1" : command.network;
  const std::string token = options.token.empty() ? "" : "#token=" + options.token;
  std::string address = fmt::format("http://{}:{}/{}", host, port, token);
  show(address + "\n");
  flush_output();
  return address;
}

// Opens an address in a browser. The browser has its own session, so that it survives this process.
class Browser {
 public:
  explicit Browser(std::string address) : address_(std::move(address)) {
    posix_spawn_file_actions_t streams;
    posix_spawn_file_actions_init(&streams);
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
      posix_spawn_file_actions_addopen(&streams, descriptor, "/dev/null", O_RDWR, 0);
    posix_spawnattr_t session;
    posix_spawnattr_init(&session);
    posix_spawnattr_setflags(&session, POSIX_SPAWN_SETSID);
    const std::vector<std::string> words = {"xdg-open", address_};
    if (posix_spawnp(&process_, "xdg-open", &streams, &session, arguments_of(words).data(), environ) != 0)
      why_failed_ = "xdg-open is not installed";
    posix_spawnattr_destroy(&session);
    posix_spawn_file_actions_destroy(&streams);
  }

  /// Returns why no browser was opened, once this is known; empty otherwise.
  const std::string& why_failed() {
    int status = 0;
    if (why_failed_.empty() && process_ > 0 && waitpid(process_, &status, WNOHANG) == process_) {
      process_ = -1;
      if (exit_code_of(status) != 0)
        why_failed_ = "xdg-open has ended with exit code " + std::to_string(exit_code_of(status));
    }
    return why_failed_;
  }

 private:
  std::string address_;
  pid_t process_ = -1;
  std::string why_failed_;
};

// `is_over` is polled, and returns whether the view is no longer needed.
void serve_until(view::WebServer& server, view::Source& source, const std::atomic<bool>& stop,
                 const std::function<bool()>& is_over) {
  std::jthread watch([&](const std::stop_token& has_ended) {
    while (!stop && !has_ended.stop_requested() && !is_over())
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    server.stop();
  });
  server.run(source);
}

// Detects that viewers were connected and have all left. Reloading a page interrupts its connection only briefly.
class Desertion {
 public:
  explicit Desertion(const view::Topics& topics) : topics_(topics) {}
  bool is_complete() {
    constexpr std::chrono::seconds moment{2};
    const auto now = std::chrono::steady_clock::now();
    if (topics_.is_read()) seen_at_ = now;
    return seen_at_ && now - *seen_at_ > moment;
  }

 private:
  const view::Topics& topics_;
  std::optional<std::chrono::steady_clock::time_point> seen_at_;
};

// `make_source` creates the source that publishes to the server's topics.
template <class MakeSource>
int serve(const ViewCommand& command, const std::string& name, Log& log, const std::atomic<bool>& stop,
          MakeSource make_source, const std::function<bool()>& has_ended = {}, const std::atomic<bool>& is_done = false,
          const std::function<void()>& without_browser = {}) {
  view::WebServer* published_to = nullptr;
  view::Topics topics([&] {
    if (published_to != nullptr) published_to->published();
  });
  const view::WebOptions options = web_options(command, name);
  const auto server = std::make_unique<view::WebServer>(options, page_or_warning(log), topics);
  published_to = server.get();
  const auto source = make_source(topics);
  const std::string address = say_where(command, options, server->port());
  std::optional<Browser> browser;
  if (command.opens) browser.emplace(address);
  Desertion desertion(topics);
  serve_until(*server, *source, stop, [&] {
    if (browser && !browser->why_failed().empty()) {
      log.warning("cannot open a browser: " + browser->why_failed() + ". Open " + address + " yourself");
      if (without_browser) without_browser();
      browser.reset();
    }
    return is_done || (desertion.is_complete() && has_ended && has_ended());
  });
  return stop ? exit_interrupted : exit_ok;
}

unsigned threads_of(const ViewCommand& command) {
  return command.threads == 0 ? std::max(1u, std::thread::hardware_concurrency()) : command.threads;
}

int view_recording(const ViewCommand& command, Log& log, const std::atomic<bool>& stop) {
  refuse_experiment(command.recording, "--view");
  const recording::Recording recording(command.recording);
  if (!recording.damage().empty()) log.warning(recording.damage());
  return serve(command, recording.file().filename().string(), log, stop, [&](view::Topics& topics) {
    return std::make_unique<view::RecordingSource>(recording, topics, threads_of(command));
  });
}

int view_server(const ViewCommand& command, Log& log, const std::atomic<bool>& stop) {
  std::atomic<bool> again{false};
  const auto& secure_drive = command.secure_drive.empty() ? command.secure_control : command.secure_drive;
  const view::LiveOptions live{.server = command.connection.server,
                               .domain = command.connection.domain(),
                               .secure = command.connection.secure.string(),
                               .secure_control = command.secure_control.string(),
                               .secure_drive = secure_drive.string(),
                               .may_control = command.may_control,
                               .plays_when_seen = command.plays_when_seen,
                               .again = command.again,
                               .run_again = command.again.empty() ? std::function<void()>() : [&] { again = true; }};
  view::FollowedRun* followed = nullptr;
  const int code = serve(
      command, "Cohort at " + command.connection.server, log, stop,
      [&](view::Topics& topics) {
        auto source = std::make_unique<view::FollowedRun>(live, command.written, threads_of(command), topics);
        followed = source.get();
        return source;
      },
      [&] { return command.while_watched && followed->has_ended(); }, again, [&] { followed->play_unseen(); });
  return again ? exit_run_again : code;
}

}  // namespace

Subcommand add_view(CommandLine app) {
  const auto command = std::make_shared<ViewCommand>();
  CommandLine line = app.add_subcommand(in_whole::view.name, in_whole::view.text);
  const Option recording =
      line.add_option("RECORDING", command->recording, "Recording (MCAP) to show instead of a server").type_name("");
  add_server_option(line, command->connection.server);
  line.add_flag("--control", command->may_control, "Allow viewers to control the server").excludes(recording);
  line.add_option("--secure-control", command->secure_control,
                  "With --control: folder of an identity that may control the run")
      .type_name("DIR");
  line.add_option(
          "--secure-drive", command->secure_drive,
          "With --control: folder of an identity that may drive robots (default: the folder of --secure-control)")
      .type_name("DIR");
  line.add_flag("--open", command->opens, "Open the page in a browser");
  line.add_flag("--play-when-seen", command->plays_when_seen,
                "When the first viewer connects, or no browser can be opened, resume a run that started paused");
  line.add_flag("--while-watched", command->while_watched, "Exit when the server has ended and no viewer is connected");
  line.add_option("--written", command->written,
                  "Recording that the server writes; it is shown when the server has ended")
      .excludes(recording)
      .type_name("FILE");
  line.add_option("--again", command->again, "Command line that repeats the run; viewers see it when the run has ended")
      .type_name("TEXT");
  line.add_option("--port", command->port, "TCP port of the page (default: 8080, or any free port if 8080 is taken)")
      .check(whole_number(0, std::numeric_limits<std::uint16_t>::max()))
      .type_name("N");
  line.add_option("--network", command->network, "Address of the network interface to which browsers connect")
      .capture_default_str()
      .type_name("ADDRESS");
  line.add_option("--token", command->token,
                  "Token that browsers must send (default: none on the loopback interface, otherwise a random token)")
      .type_name("TEXT");
  line.add_option("--origin", command->origins,
                  "Origins of other web pages that may connect, such as https://app.foxglove.dev")
      .comma_separated()
      .type_name("URL[,URL...]");
  line.add_option("--threads", command->threads, "Number of threads that replay a recording (default: one per core)")
      .check(whole_number(1, 1024))
      .type_name("N");
  add_domain_option(line, command->connection.domains, domain_of_server);
  add_secure_option(line, command->connection.secure, "Folder of an observer's identity (default: $COHORT_SECURE)");
  line.footer("Example: cohort view run.mcap");
  return {line, [command](Log& log, const std::atomic<bool>& stop) {
            return command->recording.empty() ? view_server(*command, log, stop) : view_recording(*command, log, stop);
          }};
}

}  // namespace cohort::tool
