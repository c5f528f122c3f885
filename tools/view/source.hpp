// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/view/value_history.hpp"

namespace cohort::view {

/// A viewer's request: an operation and its arguments. docs/view.md lists the operations.
struct ViewRequest {
  std::string operation;
  double number = 0.0;
  std::string name{};  ///< name of an object
  std::string text{};
  std::vector<double> numbers{};
  std::vector<std::string> names{};  ///< names of channels
  std::optional<double> from{};      ///< [s]
  std::optional<double> to{};        ///< [s]
  std::uint64_t visitor = 0;         ///< id of the viewer
};

struct Answer {
  bool is_done = false;
  std::string text;  ///< a sentence for the user: the result, or the error
  std::shared_ptr<const ValueHistory> history{};
};

/// A source of scenes. It publishes to Topics on a separate thread, from its construction to its destruction.
class Source {
 public:
  virtual ~Source() = default;
  Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;

  /// Executes a request. `answer` is called once, on any thread, possibly before this returns. Any thread.
  virtual void ask(const ViewRequest& request, std::function<void(const Answer&)> answer) = 0;
  /// Sets the ids of the robots whose channels are published from now on. Any thread.
  virtual void watch(const std::vector<std::uint32_t>& robots) = 0;
  /// Called when a visitor has left. Any thread.
  virtual void leave(std::uint64_t /*visitor*/) {}
};

}  // namespace cohort::view
