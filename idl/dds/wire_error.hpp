// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>

namespace cohort::wire {

/// An error of DDS; the message contains the attempted operation and advice.
class WireError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The error thrown if another process uses the port of the server's domain.
class DomainTaken : public WireError {
 public:
  using WireError::WireError;
};

}  // namespace cohort::wire
