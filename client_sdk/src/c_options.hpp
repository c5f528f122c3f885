// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <exception>
#include <string>

#include "client_sdk/hosting/c_handles.hpp"
#include "client_sdk/include/cohort/cohort_control.h"
#include "idl/include/cohort/types.hpp"

struct CohortRunEvent {
  cohort::RunEvent event;
};

namespace cohort {

/// Converts the options of C, which override those of the environment.
template <class Options>
Options options_in_c(const CohortOptions* given, const std::string& label) {
  Options options;
  options.label = label;
  take_environment(options);
  if (given == nullptr) return options;
  options.domain = given->domain;
  if (given->server != nullptr) options.server = given->server;
  if (given->name != nullptr) options.label = given->name;
  if (given->secure != nullptr) options.secure = given->secure;
  return options;
}

/// Creates a handle, or stores the error.
template <class Handle, class Options>
Handle* make_handle(const CohortOptions* given, const std::string& label) {
  try {
    return new Handle(options_in_c<Options>(given, label));
  } catch (const std::exception& error) {
    last_error() = error.what();
    return nullptr;
  }
}

inline CohortPose pose_in_c(const WorldPose& pose) {
  const Vector3& p = pose.position;
  const Quaternion& q = pose.orientation;
  return {{p.x, p.y, p.z}, {q.x, q.y, q.z, q.w}};
}

/// Returns an element of a list, or NULL beyond the last.
template <class List>
auto at(const List& list, std::size_t index) {
  return index < list.size() ? &list[index] : nullptr;
}

}  // namespace cohort
