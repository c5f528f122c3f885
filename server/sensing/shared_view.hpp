// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "server/core/worker_pool.hpp"

namespace cohort::sensing {

/// A computation for the sensors of many robots at once, before any of them senses. This is faster than separate
/// computations.
class SharedView {
 public:
  virtual ~SharedView() = default;
  /// Computes the results for the sensors that have requested them since the last update (Sensor::ask_shared_view).
  /// Must follow `Emitters::update`; the result is valid until the next update. It is the same for any number of
  /// threads.
  virtual void update(WorkerPool& workers) = 0;
};

/// The shared views of one world: one of each kind that its sensors need. For one thread.
class SharedViews {
 public:
  /// Returns the view of this kind. The first call creates it from `parts`, references that must outlive this object.
  template <class View, class... Parts>
  View& get(const Parts&... parts) {
    for (const auto& view : views_)
      if (auto* const known = dynamic_cast<View*>(view.get())) return *known;
    auto made = std::make_unique<View>(parts...);
    View& view = *made;
    views_.push_back(std::move(made));
    return view;
  }
  void update(WorkerPool& workers) {
    for (const auto& view : views_) view->update(workers);
  }

 private:
  std::vector<std::unique_ptr<SharedView>> views_;
};

}  // namespace cohort::sensing
