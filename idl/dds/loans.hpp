// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <type_traits>

#include "idl/cohort.h"

/// Basic functions for fields.hpp: samples that borrow from messages, and messages read from samples.
namespace cohort::wire {

// Cyclone's structs are not const-correct; writing only reads the data that they point to. `_release` stays false,
// because we own the data.
inline char* loaned(const std::string& text) { return const_cast<char*>(text.c_str()); }

template <class Sequence, class Elements>
void loan(const Elements& elements, Sequence& sequence) {
  using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
  sequence._buffer = const_cast<Element*>(elements.data());
  sequence._length = static_cast<std::uint32_t>(elements.size());
  sequence._maximum = sequence._length;
}

inline std::string to_string(const char* text) { return text == nullptr ? std::string() : std::string(text); }

template <class Sequence>
auto to_span(const Sequence& sequence) {
  using Element = std::remove_pointer_t<decltype(sequence._buffer)>;
  return std::span<const Element>(sequence._buffer, sequence._buffer == nullptr ? 0 : sequence._length);
}

}  // namespace cohort::wire
