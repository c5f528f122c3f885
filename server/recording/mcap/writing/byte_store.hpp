// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "server/recording/mcap/format/mcap.hpp"

namespace cohort::recording {

/// The destination of a recording's bytes, in sequence. On failure, the functions throw FileError. `sync` may be called
/// on a different thread from the others.
class ByteStore {
 public:
  ByteStore() = default;
  ByteStore(const ByteStore&) = delete;
  ByteStore& operator=(const ByteStore&) = delete;
  virtual ~ByteStore() = default;

  /// Returns a name for messages.
  virtual std::string name() const { return "the recording"; }
  /// Writes all bytes; after an exception, some of them may have been written.
  virtual void write(ByteView bytes) = 0;
  /// Removes the bytes that were written after the first `size` bytes.
  virtual void cut_off(std::uint64_t size) = 0;
  /// Returns when all written data survives a crash of this machine, as far as the store can tell.
  virtual void sync() = 0;
  /// Ends the writing.
  virtual void finish() = 0;
};

}  // namespace cohort::recording
