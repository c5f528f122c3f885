#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "tools/view/driving/driver.hpp"
#include "tools/view/source.hpp"

namespace cohort::view {

/// The robots that pages drive: each by one page, which is called by its visitor's number. Any thread.
class Drivers {
 public:
  static constexpr std::size_t most = 8;
  /// After such a silence of a page another one may take its robot.
  static constexpr std::chrono::seconds longest_silence{5};

  struct Options {
    std::string server = "127.0.0.1";
    std::uint32_t domain = 0;
    std::string secure{};  ///< folder of an identity that may drive; empty: without security
  };
  explicit Drivers(Options options) : options_(std::move(options)) {}
  /// Leaves all robots.
  ~Drivers() = default;
  Drivers(const Drivers&) = delete;
  Drivers& operator=(const Drivers&) = delete;

  /// Without numbers claims the robot that `request` names, or keeps it at its neutral values; otherwise tells it
  /// these. Answered at once, but for a claim.
  void drive(const ViewRequest& request, std::function<void(const Answer&)> answer);
  /// Releases it.
  Answer release(const ViewRequest& request);
  /// Releases all robots that this visitor drives.
  void leave(std::uint64_t visitor);

 private:
  struct Driven {
    std::uint64_t visitor = 0;
    std::unique_ptr<Driver> driver;
  };

  Answer tell(const ViewRequest& request, Driven& driven);
  void claim(const ViewRequest& request, std::function<void(const Answer&)> answer);
  void release_at(std::map<std::string, Driven>::iterator place);
  void forget_the_gone();

  const Options options_;
  std::mutex mutex_;
  std::map<std::string, Driven> driven_;  // by the robot's name
  struct Leaving {
    std::string robot;
    std::unique_ptr<Driver> driver;
  };
  std::vector<Leaving> leaving_;  // in the order of their release
};

}  // namespace cohort::view
