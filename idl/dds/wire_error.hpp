#pragma once

#include <stdexcept>

namespace cohort::wire {

/// DDS refused: the message says what was tried and what to do about it.
class WireError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The port of the server's domain is taken by another process.
class DomainTaken : public WireError {
 public:
  using WireError::WireError;
};

}  // namespace cohort::wire
