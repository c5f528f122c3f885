// SPDX-License-Identifier: Apache-2.0
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

/// The robots that pages drive: each by one page, which is identified by its visitor number. Thread-safe.
class Drivers {
 public:
  static constexpr std::size_t most = 8;
  /// If a page is silent for this time, another page may take its robot.
  static constexpr std::chrono::seconds longest_silence{5};

  struct Options {
    std::string server = "127.0.0.1";
    std::uint32_t domain = 0;
    std::string secure{};  ///< folder of an identity that may drive; empty: without security
  };
  explicit Drivers(Options options) : options_(std::move(options)) {}
  /// Releases all robots.
  ~Drivers() = default;
  Drivers(const Drivers&) = delete;
  Drivers& operator=(const Drivers&) = delete;

  /// If `request` has no numbers, claims the robot that it names, or sets its neutral command if it is already driven.
  /// Otherwise sets the numbers as its command. Answers at once, except for a claim.
  void drive(const ViewRequest& request, std::function<void(const Answer&)> answer);
  /// Releases the robot that `request` names.
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
