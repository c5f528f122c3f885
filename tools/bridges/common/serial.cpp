#include "tools/bridges/common/serial.hpp"

#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>

#include <array>
#include <utility>

#include "tools/bridges/common/descriptor.hpp"

namespace cohort::bridges {
namespace {

constexpr std::array<std::pair<unsigned, speed_t>, 12> speeds = {{{9600, B9600},
                                                                  {19200, B19200},
                                                                  {38400, B38400},
                                                                  {57600, B57600},
                                                                  {115200, B115200},
                                                                  {230400, B230400},
                                                                  {460800, B460800},
                                                                  {500000, B500000},
                                                                  {921600, B921600},
                                                                  {1000000, B1000000},
                                                                  {2000000, B2000000},
                                                                  {3000000, B3000000}}};

speed_t speed_of(unsigned baud) {
  std::string known;
  for (const auto& [rate, speed] : speeds) {
    if (rate == baud) return speed;
    known += (known.empty() ? "" : ", ") + std::to_string(rate);
  }
  throw std::runtime_error("a serial line has no rate of " + std::to_string(baud) + " baud: expected one of " + known);
}

void make_raw(const Descriptor& line, const std::string& name, std::optional<speed_t> speed) {
  termios settings{};
  const bool is_line = ::tcgetattr(line.number(), &settings) == 0;
  ::cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  if (speed) ::cfsetspeed(&settings, *speed);
  if (!is_line || ::tcsetattr(line.number(), TCSANOW, &settings) != 0)
    throw std::runtime_error(name + " cannot be set up as a serial line: " + text_of_error(errno));
}

// A line that is open for good: who is at its other end is not seen.
class SerialLink : public Link {
 public:
  SerialLink(Descriptor line, std::string name) : line_(std::move(line)), name_(std::move(name)) {}

  std::string place() const override { return name_; }
  std::string peer() const override { return name_; }
  bool is_connectionless() const override { return true; }
  int descriptor() const override { return line_.number(); }
  bool connect() override { return true; }

  std::size_t read(std::span<std::uint8_t> bytes) override {
    const ssize_t count = ::read(line_.number(), bytes.data(), bytes.size());
    if (count > 0) return static_cast<std::size_t>(count);
    // EIO of a pseudo-terminal: nobody has its other end open.
    if (count == 0 || is_for_later(errno) || errno == EIO) return 0;
    throw LinkLost("is lost: " + text_of_error(errno));
  }

  std::size_t write(std::span<const std::uint8_t> bytes) override {
    const ssize_t count = ::write(line_.number(), bytes.data(), bytes.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    if (is_for_later(errno)) return 0;
    throw LinkLost("does not take its answer: " + text_of_error(errno));
  }

  void hang_up() override { ::tcflush(line_.number(), TCIOFLUSH); }

 private:
  Descriptor line_;
  std::string name_;
};

class PtyLink final : public SerialLink {
 public:
  // `other_end` stays open, so that bytes are kept while the firmware opens and closes it.
  PtyLink(Descriptor line, Descriptor other_end, const std::string& name, std::filesystem::path symlink)
      : SerialLink(std::move(line), symlink.empty() ? name : symlink.string()),
        other_end_(std::move(other_end)),
        symlink_(std::move(symlink)) {
    if (symlink_.empty()) return;
    std::error_code error;
    std::filesystem::create_symlink(name, symlink_, error);
    if (error) throw std::runtime_error("cannot make the symbolic link " + symlink_.string() + ": " + error.message());
  }
  PtyLink(const PtyLink&) = delete;
  PtyLink& operator=(const PtyLink&) = delete;
  ~PtyLink() override {
    std::error_code ignored;
    if (!symlink_.empty()) std::filesystem::remove(symlink_, ignored);
  }

 private:
  Descriptor other_end_;
  std::filesystem::path symlink_;
};

}  // namespace

std::unique_ptr<Link> open_serial(const std::string& device, unsigned baud) {
  const speed_t speed = speed_of(baud);
  Descriptor line(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!line.is_open()) throw std::runtime_error("cannot open " + device + ": " + text_of_error(errno));
  make_raw(line, device, speed);
  return std::make_unique<SerialLink>(std::move(line), device);
}

std::unique_ptr<Link> make_pty(const std::filesystem::path& symlink) {
  Descriptor line(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 128> name{};
  const bool is_made = line.is_open() && ::grantpt(line.number()) == 0 && ::unlockpt(line.number()) == 0 &&
                       ::ptsname_r(line.number(), name.data(), name.size()) == 0;
  Descriptor other_end;
  if (is_made) other_end = Descriptor(::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!other_end.is_open()) throw std::runtime_error("cannot make a pseudo-terminal: " + text_of_error(errno));
  make_raw(other_end, name.data(), std::nullopt);
  return std::make_unique<PtyLink>(std::move(line), std::move(other_end), name.data(), symlink);
}

}  // namespace cohort::bridges
