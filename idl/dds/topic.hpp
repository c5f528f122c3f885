#pragma once

#include <chrono>

#include "idl/dds/dds.hpp"

namespace cohort::wire {

/// How a message travels: docs/protocol.md, "Topics".
struct Topic {
  const char* name = nullptr;
  const dds_topic_descriptor_t* type = nullptr;
  /// Observations and commands are not: the protocol itself repairs losses, and sooner. Reliable, what is sent again
  /// would be held back until DDS had repaired what nobody needs any more.
  bool reliable = true;
  bool transient_local = false;
  int depth = 0;                       ///< 0: the endpoint chooses
  std::chrono::milliseconds lease{0};  ///< 0: no lease but the participant's
};

}  // namespace cohort::wire
