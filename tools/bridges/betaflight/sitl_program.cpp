// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/betaflight/sitl_program.hpp"

#include <fcntl.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "tools/bridges/betaflight/sitl_command_line.hpp"
#include "tools/bridges/betaflight/sitl_packets.hpp"

namespace cohort::betaflight {
namespace {

using bridges::Descriptor;

constexpr std::chrono::seconds patience{20};
constexpr std::chrono::milliseconds asked_every{10};
constexpr int most_starts = 3;

// The functions up to `launch` run between fork and exec, or in a child that only makes sockets: system calls alone.

sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in endpoint{};
  endpoint.sin_family = AF_INET;
  endpoint.sin_port = htons(port);
  endpoint.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return endpoint;
}

bool raise_loopback(int any_socket) {
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  if (::ioctl(any_socket, SIOCGIFFLAGS, &request) != 0) return false;
  request.ifr_flags |= IFF_UP;
  return ::ioctl(any_socket, SIOCSIFFLAGS, &request) == 0;
}

// The child's message: the descriptors of a Network, in their order, and an error number if there are none.
struct HandOver {
  int error = 0;
  std::array<int, 4> descriptors{};
};

HandOver enter_new_network() {
  HandOver made;
  if (::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return {errno, {}};
  const int servo = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const int cli = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  made.descriptors = {::open("/proc/self/ns/user", O_RDONLY | O_CLOEXEC),
                      ::open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC), servo, cli};
  const sockaddr_in endpoint = loopback(servo_port);
  const bool is_made = made.descriptors[0] >= 0 && made.descriptors[1] >= 0 && servo >= 0 && cli >= 0 &&
                       raise_loopback(servo) &&
                       ::bind(servo, reinterpret_cast<const sockaddr*>(&endpoint), sizeof endpoint) == 0;
  if (!is_made) made.error = errno;
  return made;
}

// The buffers of a message that has descriptors beside it.
struct Envelope {
  HandOver handed;
  iovec part{&handed.error, sizeof handed.error};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(HandOver::descriptors))> control{};
  msghdr message{};

  Envelope() {
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
  }
  Envelope(const Envelope&) = delete;
  Envelope& operator=(const Envelope&) = delete;
};

void send(int to, const HandOver& made) {
  Envelope envelope;
  envelope.handed.error = made.error;
  cmsghdr* header = CMSG_FIRSTHDR(&envelope.message);
  header->cmsg_level = SOL_SOCKET;
  header->cmsg_type = SCM_RIGHTS;
  header->cmsg_len = CMSG_LEN(sizeof made.descriptors);
  std::memcpy(CMSG_DATA(header), made.descriptors.data(), sizeof made.descriptors);
  if (made.error != 0) envelope.message.msg_controllen = 0;
  ::sendmsg(to, &envelope.message, MSG_NOSIGNAL);
}

HandOver receive(int from) {
  Envelope envelope;
  if (::recvmsg(from, &envelope.message, MSG_CMSG_CLOEXEC) != sizeof envelope.handed.error) return {EPIPE, {}};
  if (envelope.handed.error != 0) return envelope.handed;
  const cmsghdr* header = CMSG_FIRSTHDR(&envelope.message);
  if (header == nullptr) return {EPIPE, {}};
  std::memcpy(envelope.handed.descriptors.data(), CMSG_DATA(header), sizeof envelope.handed.descriptors);
  return envelope.handed;
}

std::string how_it_ended(int status) {
  if (WIFSIGNALED(status)) {
    const char* text = ::sigdescr_np(WTERMSIG(status));
    return "was terminated by the signal " + (text != nullptr ? text : std::to_string(WTERMSIG(status)));
  }
  return "has ended with the exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

Network make_network() {
  std::array<int, 2> pair{};
  if (::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, pair.data()) != 0)
    throw std::runtime_error("cannot create a network namespace for the program: " + bridges::text_of_error(errno));
  const Descriptor ours(pair[0]);
  Descriptor theirs(pair[1]);
  const pid_t child = ::fork();
  if (child == 0) {
    send(theirs.number(), enter_new_network());
    ::_exit(0);
  }
  theirs = Descriptor();
  const HandOver made = child < 0 ? HandOver{errno, {}} : receive(ours.number());
  if (child > 0) ::waitpid(child, nullptr, 0);
  if (made.error != 0)
    throw std::runtime_error(
        "cannot create a network namespace for the program: " + bridges::text_of_error(made.error) +
        ". This system may not allow user namespaces; start the program yourself, without --run");
  return {Descriptor(made.descriptors[0]), Descriptor(made.descriptors[1]), Descriptor(made.descriptors[2]),
          Descriptor(made.descriptors[3])};
}

Program::Program(Options options) : options_(std::move(options)), network_(make_network()) {
  options_.program = std::filesystem::absolute(options_.program);
  if (::access(options_.program.c_str(), X_OK) != 0)
    throw std::runtime_error("cannot run '" + options_.program.string() + "': " + bridges::text_of_error(errno));
  std::filesystem::create_directories(options_.folder);
}

Program::~Program() { end(); }

void Program::start() {
  end();
  if (!std::filesystem::exists(options_.folder / "eeprom.bin")) configure();
  options_.has_virtual_time ? launch_in_virtual_time() : launch();
}

void Program::listen(std::function<bool()> given_up, std::function<void(const std::string& text)> tell) {
  given_up_ = std::move(given_up);
  tell_ = std::move(tell);
}

bridges::Descriptor Program::servo_socket() const {
  Descriptor another(::fcntl(network_.servo.number(), F_DUPFD_CLOEXEC, 0));
  if (!another.is_open()) throw std::runtime_error("cannot duplicate a socket: " + bridges::text_of_error(errno));
  return another;
}

void Program::launch() {
  const Descriptor log = open_log();
  std::string program = options_.program.string();
  std::string simulator = "127.0.0.1";
  std::array<char*, 3> arguments{program.data(), simulator.data(), nullptr};

  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0) {
    const bool is_ready = enter(log) && ::chdir(options_.folder.c_str()) == 0;
    // After the namespaces, which reset it.
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (is_ready && ::getppid() == parent) ::execv(program.c_str(), arguments.data());
    ::_exit(127);
  }
  if (pid_ < 0) throw std::runtime_error("cannot run '" + program + "': " + bridges::text_of_error(errno));
}

void Program::launch_in_virtual_time() {
  const Descriptor log = open_log();
  exec::VirtualProgram::Options options;
  options.command = {options_.program.string(), "127.0.0.1"};
  options.folder = options_.folder;
  options.prepare = [&] { return enter(log); };
  options.given_up = given_up_;
  options.tell = tell_;
  virtual_.emplace(std::move(options));
}

// Opens a log of the program's output. Drops packets of an earlier program.
Descriptor Program::open_log() const {
  char byte = 0;
  while (::recv(network_.servo.number(), &byte, sizeof byte, MSG_DONTWAIT) >= 0) {
  }
  return Descriptor(
      ::open((options_.folder / "betaflight.log").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644));
}

// In the process that becomes the program.
bool Program::enter(const Descriptor& log) const {
  ::setpgid(0, 0);  // Ctrl-C interrupts only the bridge, which ends the program
  return ::setns(network_.user.number(), CLONE_NEWUSER) == 0 && ::setns(network_.network.number(), CLONE_NEWNET) == 0 &&
         ::dup2(log.number(), STDOUT_FILENO) >= 0 && ::dup2(log.number(), STDERR_FILENO) >= 0;
}

// Uses the machine's clock, with which the program's scheduler may hang at its start (Copter::wait_until_ready).
void Program::configure() {
  for (int starts = 1;; ++starts) {
    launch();
    try {
      return configure_once();
    } catch (const Silent&) {
      if (starts == most_starts) throw;
    }
  }
}

void Program::configure_once() {
  try {
    CommandLine line(network_.cli, patience, [this] {
      if (const auto how = ended()) throw std::runtime_error("'" + options_.program.string() + "' " + *how);
    });
    for (const std::string& command : options_.commands) line.execute(command);
    line.save();
    wait_for_end();
  } catch (...) {
    // Half a configuration is none.
    end();
    std::filesystem::remove(options_.folder / "eeprom.bin");
    throw;
  }
}

void Program::wait_for_end() {
  const auto until = std::chrono::steady_clock::now() + patience;
  while (!ended()) {
    if (std::chrono::steady_clock::now() > until)
      throw std::runtime_error("'" + options_.program.string() + "' does not end after it has saved its configuration");
    std::this_thread::sleep_for(asked_every);
  }
}

std::optional<std::string> Program::ended() {
  if (virtual_) {
    const std::optional<int> code = virtual_->exit_code();
    return code ? std::optional(exec::text_of_end(*code)) : std::nullopt;
  }
  if (pid_ < 0) return "is not running";
  int status = 0;
  if (::waitpid(pid_, &status, WNOHANG) == 0) return std::nullopt;
  pid_ = -1;
  return how_it_ended(status);
}

void Program::end() {
  if (virtual_) virtual_->end(std::chrono::milliseconds(0));
  virtual_.reset();
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, nullptr, 0);
  pid_ = -1;
}

}  // namespace cohort::betaflight
