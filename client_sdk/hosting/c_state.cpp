// SPDX-License-Identifier: Apache-2.0
#include <cstring>

#include "client_sdk/hosting/c_handles.hpp"

namespace {

// Reads a value. Returns 0 once the state cannot be read any further.
template <class Value>
Value loaded(CohortStateReader* state) {
  Value value{};
  try {
    if (!state->mistake) state->reader.read(value);
  } catch (const cohort::StateError& error) {
    state->mistake = error.what();
  }
  return value;
}

}  // namespace

void cohort_save_real(CohortStateWriter* state, double value) { state->writer.write(value); }

void cohort_save_whole(CohortStateWriter* state, std::int64_t value) { state->writer.write(value); }

void cohort_save_flag(CohortStateWriter* state, bool value) { state->writer.write(value); }

void cohort_save_bytes(CohortStateWriter* state, const void* bytes, std::size_t size) {
  state->writer.write(std::string_view(static_cast<const char*>(bytes), size));
}

double cohort_load_real(CohortStateReader* state) { return loaded<double>(state); }

std::int64_t cohort_load_whole(CohortStateReader* state) { return loaded<std::int64_t>(state); }

bool cohort_load_flag(CohortStateReader* state) { return loaded<bool>(state); }

void cohort_load_bytes(CohortStateReader* state, void* bytes, std::size_t size) {
  const auto saved = loaded<std::string>(state);
  if (!state->mistake && saved.size() != size)
    state->mistake = "invalid state: expected " + std::to_string(size) + " bytes, not " + std::to_string(saved.size());
  if (size == 0) return;
  std::memset(bytes, 0, size);
  if (!state->mistake) std::memcpy(bytes, saved.data(), size);
}
