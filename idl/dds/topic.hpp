// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

#include "idl/dds/dds.hpp"

namespace cohort::wire {

/// Transport of a message: docs/protocol.md, "Topics".
struct Topic {
  const char* name = nullptr;
  const dds_topic_descriptor_t* type = nullptr;
  /// False for observations and commands: the protocol itself repairs losses, and does so sooner. With reliable
  /// transport, later messages would be held back until DDS has repaired a message that is no longer needed.
  bool reliable = true;
  bool transient_local = false;
  int depth = 0;                       ///< 0: the endpoint chooses
  std::chrono::milliseconds lease{0};  ///< 0: only the participant's lease
};

}  // namespace cohort::wire
