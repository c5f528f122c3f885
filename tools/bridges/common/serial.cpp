// SPDX-License-Identifier: Apache-2.0
#include "tools/bridges/common/serial.hpp"

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/file.h>
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
  throw std::runtime_error("unsupported rate of " + std::to_string(baud) + " baud: expected one of " + known);
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

class SerialLink : public Link {
 public:
  SerialLink(Descriptor line, std::string name) : line_(std::move(line)), name_(std::move(name)) {}

  std::string place() const override { return name_; }
  std::string peer() const override { return name_; }
  int descriptor() const override { return line_.number(); }

  std::size_t read(std::span<std::uint8_t> bytes) override {
    const ssize_t count = ::read(line_.number(), bytes.data(), bytes.size());
    if (count > 0) return static_cast<std::size_t>(count);
    if (count < 0 && is_for_later(errno)) return 0;
    return lose(count == 0 ? EIO : errno);
  }

  std::size_t write(std::span<const std::uint8_t> bytes) override {
    const ssize_t count = ::write(line_.number(), bytes.data(), bytes.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    return is_for_later(errno) ? 0 : lose(errno);
  }

  void hang_up() override { ::tcflush(line_.number(), TCIOFLUSH); }

 protected:
  // Called where the line gives and takes nothing, with an error number. Returns 0 or throws LinkLost.
  virtual std::size_t lose(int error) = 0;

  Descriptor line_;

 private:
  std::string name_;
};

// The line stays open while its device is there, because opening one resets many boards.
class DeviceLink final : public SerialLink {
 public:
  DeviceLink(const std::string& device, speed_t speed) : SerialLink(open(device, speed), device), speed_(speed) {}

  bool is_connectionless() const override { return false; }
  bool connect() override {
    if (line_.is_open()) return true;
    try {
      line_ = open(place(), speed_);
    } catch (const std::runtime_error&) {
      return false;  // it is not plugged in again, or not set up by the system yet
    }
    return true;
  }

 private:
  static Descriptor open(const std::string& device, speed_t speed) {
    Descriptor line(::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
    if (!line.is_open())
      throw std::runtime_error(
          "cannot open " + device + ": " + text_of_error(errno) +
          (errno == EACCES ? ". Add your user to the group of the device (see 'ls -l'), often dialout" : ""));
    if (::flock(line.number(), LOCK_EX | LOCK_NB) != 0)
      throw std::runtime_error("cannot open " + device + ": another program is using it");
    make_raw(line, device, speed);
    return line;
  }

  std::size_t lose(int error) override {
    line_ = Descriptor();
    throw LinkLost("is lost: " + place() + " is unplugged, or its other end is closed (" + text_of_error(error) + ")");
  }

  speed_t speed_;
};

// Open for good: who is at its other end is not seen.
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
    if (error)
      throw std::runtime_error("cannot create the symbolic link " + symlink_.string() + ": " + error.message());
  }
  bool is_connectionless() const override { return true; }
  bool connect() override { return true; }
  // The kernel hands bytes over to the other end some time later, or when that is looked at.
  std::size_t write(std::span<const std::uint8_t> bytes) override {
    const std::size_t count = SerialLink::write(bytes);
    pollfd other_end{other_end_.number(), POLLIN, 0};
    ::poll(&other_end, 1, 0);
    return count;
  }
  PtyLink(const PtyLink&) = delete;
  PtyLink& operator=(const PtyLink&) = delete;
  ~PtyLink() override {
    std::error_code ignored;
    if (!symlink_.empty()) std::filesystem::remove(symlink_, ignored);
  }

 private:
  std::size_t lose(int error) override {
    if (error == EIO) return 0;  // its other end is not open
    throw LinkLost("is lost: " + text_of_error(error));
  }

  Descriptor other_end_;
  std::filesystem::path symlink_;
};

}  // namespace

std::unique_ptr<Link> open_serial(const std::string& device, unsigned baud) {
  return std::make_unique<DeviceLink>(device, speed_of(baud));
}

std::unique_ptr<Link> make_pty(const std::filesystem::path& symlink) {
  Descriptor line(::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  std::array<char, 128> name{};
  const bool is_made = line.is_open() && ::grantpt(line.number()) == 0 && ::unlockpt(line.number()) == 0 &&
                       ::ptsname_r(line.number(), name.data(), name.size()) == 0;
  Descriptor other_end;
  if (is_made) other_end = Descriptor(::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (!other_end.is_open()) throw std::runtime_error("cannot create a pseudo-terminal: " + text_of_error(errno));
  make_raw(other_end, name.data(), std::nullopt);
  return std::make_unique<PtyLink>(std::move(line), std::move(other_end), name.data(), symlink);
}

}  // namespace cohort::bridges
