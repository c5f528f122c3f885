#pragma once

#include "server/recording/mcap/format/mcap.hpp"

namespace cohort::recording {

/// Where the bytes of a recording go, from its first to its last. What fails throws FileError. `sync` may be called by
/// another thread than the rest.
class ByteStore {
 public:
  ByteStore() = default;
  ByteStore(const ByteStore&) = delete;
  ByteStore& operator=(const ByteStore&) = delete;
  virtual ~ByteStore() = default;

  /// For messages.
  virtual std::string name() const { return "the recording"; }
  /// All of them; if it throws, maybe some.
  virtual void write(ByteView bytes) = 0;
  /// Forgets what was written after the first `size` bytes.
  virtual void cut_off(std::uint64_t size) = 0;
  /// Returns when everything that was written is safe from the end of this machine, as far as the store can tell.
  virtual void sync() = 0;
  /// Nothing will be written any more.
  virtual void finish() = 0;
};

}  // namespace cohort::recording
