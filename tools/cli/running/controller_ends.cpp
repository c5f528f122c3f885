// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/running/controller_ends.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <string_view>
#include <vector>

#include "client_sdk/hosting/controller_call.hpp"
#include "tools/cli/common/output_file.hpp"

namespace cohort::tool {
namespace {

constexpr std::array crash_signals = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT};

// Reached by signal handlers and by what runs at the process's exit.
// NOLINTBEGIN(cppcoreguidelines-avoid-non-const-global-variables)
std::atomic<ControllerEnds*> ends_now{nullptr};
std::array<struct sigaction, crash_signals.size()> actions_before;
std::atomic<bool> writes_json{false};
std::atomic<bool> clears_progress{false};
std::atomic<bool> is_silent{false};
// NOLINTEND(cppcoreguidelines-avoid-non-const-global-variables)

// Text of limited length for signal handlers, which allocates no memory. Longer text is truncated.
class FixedText {
 public:
  template <class... Values>
  void add(fmt::format_string<Values...> format, const Values&... values) {
    const auto written =
        fmt::format_to_n(text_.data() + size_, room(), fmt::runtime(fmt::string_view(format)), values...);
    size_ += std::min(room(), written.size);
  }
  // Adds text, escaped for a JSON string.
  void add_escaped(std::string_view text) {
    for (const char letter : text) {
      if (static_cast<unsigned char>(letter) < 0x20)
        add("\\u{:04x}", static_cast<unsigned>(letter));
      else if (letter == '"' || letter == '\\')
        add("\\{}", letter);
      else
        add("{}", letter);
    }
  }
  std::string_view text() const { return {text_.data(), size_}; }

 private:
  std::size_t room() const { return text_.size() - size_; }

  std::array<char, 4096> text_;
  std::size_t size_ = 0;
};

// Describes what happened to the process, and in which call.
void describe(FixedText& text, const CallUnderWay& call, std::string_view what) {
  if (call.callee == nullptr)
    text.add("the process {} at tick {}, while no controller was called", what, call.tick);
  else if (!call.is_on_this_thread)
    text.add("a thread {} while {} was in {} at tick {}", what, call.callee->text(), call.what, call.tick);
  else
    text.add("{} {} in {} at tick {}", call.callee->text(), what, call.what, call.tick);
}

void print_error(std::string_view message, std::uint64_t tick) {
  FixedText line;
  if (writes_json) {
    using namespace std::chrono;
    const auto now = floor<milliseconds>(system_clock::now());
    const auto day = floor<days>(now);
    const year_month_day date(day);
    const hh_mm_ss time(now - day);
    line.add(R"({{"time":"{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z","level":"error","message":")",
             static_cast<int>(date.year()), static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
             time.hours().count(), time.minutes().count(), time.seconds().count(), time.subseconds().count());
    line.add_escaped(message);
    line.add("\",\"tick\":{}}}\n", tick);
  } else {
    line.add("{}cohort: error: {}\n", clears_progress ? "\r\033[K" : "", message);
  }
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line.text().data(), line.text().size());
}

void on_crash(int signal, siginfo_t* info, void*) {
  if (!is_silent) {
    FixedText what, message;
    what.add("crashed with signal {} ({})", signal, ::sigdescr_np(signal));
    const CallUnderWay call = call_under_way();
    describe(message, call, what.text());
    print_error(message.text(), call.tick);
  }
  const auto place = std::ranges::find(crash_signals, signal) - crash_signals.begin();
  ::sigaction(signal, &actions_before[static_cast<std::size_t>(place)], nullptr);
  // A fault of the processor recurs when this handler returns; a signal that was sent does not.
  if (info->si_code <= 0) ::raise(signal);
}

}  // namespace

// Signal handlers with a separate stack, because a controller may have used up the thread's stack.
struct ControllerEnds::CrashHandlers {
  CrashHandlers() : stack(std::size_t{64} << 10U) {
    const stack_t own = {.ss_sp = stack.data(), .ss_flags = 0, .ss_size = stack.size()};
    ::sigaltstack(&own, &stack_before);
    struct sigaction action {};
    action.sa_sigaction = on_crash;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    for (std::size_t i = 0; i < crash_signals.size(); ++i) ::sigaction(crash_signals[i], &action, &actions_before[i]);
  }
  CrashHandlers(const CrashHandlers&) = delete;
  CrashHandlers& operator=(const CrashHandlers&) = delete;
  ~CrashHandlers() {
    for (std::size_t i = 0; i < crash_signals.size(); ++i) ::sigaction(crash_signals[i], &actions_before[i], nullptr);
    ::sigaltstack(&stack_before, nullptr);
  }

  std::vector<char> stack;
  stack_t stack_before{};
};

ControllerEnds::ControllerEnds(Log& log, const Options& options) : log_(log), options_(options) {
  writes_json = log.format() == LogFormat::json;
  clears_progress = log.rewrites_progress();
  is_silent = !log.shows(LogLevel::error);
  // Registered as late as possible: objects that were created before are destroyed after this has run.
  [[maybe_unused]] static const bool is_registered = std::atexit(at_exit) == 0 && std::at_quick_exit(at_exit) == 0;
  if (options.crashes) crashes_ = std::make_unique<CrashHandlers>();
  ends_now = this;
}

ControllerEnds::~ControllerEnds() { ends_now = nullptr; }

void ControllerEnds::at_exit() {
  if (ControllerEnds* const ends = ends_now.exchange(nullptr)) ends->end_process();
}

void ControllerEnds::end_process() {
  const CallUnderWay call = call_under_way();
  FixedText why;
  describe(why, call, "ended the process");
  why.add(". A controller that cannot continue should throw an exception");
  int exit_code = options_.exit_code;
  if (finish_ && call.is_on_this_thread)
    exit_code = finish_(std::string(why.text()));
  else
    log_.error(std::string(why.text()), {{"tick", call.tick}});
  std::cout.flush();
  exit_code = code_after_output(exit_code, log_);
  std::fflush(nullptr);
  ::_exit(exit_code);
}

}  // namespace cohort::tool
