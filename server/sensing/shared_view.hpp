#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "server/core/worker_pool.hpp"

namespace cohort::sensing {

/// What sensors of many robots find out together, before any of them senses: for less than each would on its own.
class SharedView {
 public:
  virtual ~SharedView() = default;
  /// For the sensors that have asked since the last update (Sensor::ask_shared_view). After `Emitters::update`; what is
  /// found holds until the next one. The same for any number of threads.
  virtual void update(WorkerPool& workers) = 0;
};

/// The shared views of one world: one of each kind that its sensors need. One thread calls it.
class SharedViews {
 public:
  /// The one of this kind, which is made of `parts`, references that must outlive this, the first time.
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
