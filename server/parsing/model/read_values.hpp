// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <type_traits>

#include "server/parsing/keys/choices.hpp"
#include "server/parsing/keys/device_keys.hpp"
#include "server/parsing/sdf/extension_values.hpp"

/// Functions that assign the values of an element to members.
namespace cohort::parsing {

/// Converts seconds to a time, rounded to the nearest nanosecond and clipped at 285 years.
std::chrono::nanoseconds to_time(double seconds);

/// Reports a colour that is not red, green and blue from 0 to 1.
void check_color(const ExtensionValues& values, std::string_view key, const SdfReport& report);

/// Reads a member, which stays unchanged if its key has no value.
template <class Struct, class Member>
void read_value(const KeyValues& values, const keys::MemberKey<Struct, Member>& key, Struct& into) {
  if (!values.has(key.name)) return;
  Member& member = into.*key.member;
  if constexpr (keys::List<Member>)
    member = values.all<typename Member::value_type>(key.name);
  else if constexpr (std::is_enum_v<Member>)
    member = choice_of<Member>(key.choices, values.text(key.name));
  else if constexpr (std::is_same_v<Member, std::chrono::nanoseconds>)
    member = to_time(key.unit == "Hz" ? 1.0 / values.real(key.name) : values.real(key.name));
  else
    member = values.get<Member>(key.name);
}

template <class Struct>
void read_value(const KeyValues& values, const keys::NoiseKey<Struct>& key, Struct& into) {
  if (values.real(key.name) == 0.0) return;
  for (const std::string_view quantity : key.quantities) {
    if (quantity.empty()) continue;
    Noise& noise = into.readout.noises.emplace_back();
    noise.quantity = quantity;
    noise.deviation = values.real(key.name);
  }
}

/// References are resolved by code that knows the model.
template <class Struct, class Member>
void read_value(const KeyValues&, const keys::ReferenceKey<Struct, Member>&, Struct&) {}

/// Reads the members of a struct from the keys of a kind.
template <class Kind, class Struct>
void read_values(const KeyValues& values, Struct& into) {
  keys::for_keys_of<Struct>(keys::keys_of<Kind>, [&]<class Key>(const Key& key) {
    read_value(values, key, static_cast<typename Key::Struct&>(into));
  });
}

/// Reads a child of a link; returns nothing if it is of another kind, or, with a report, if it is invalid.
template <class Kind>
std::optional<ExtensionValues> read_as(const Element* child, const SdfReport& report) {
  const Extension& extension = keys::extension_of<Kind>;
  if (child->name() != std::string(extension_prefix) + ":" + std::string(extension.name)) return std::nullopt;
  return ExtensionValues::read(child, extension, report);
}

}  // namespace cohort::parsing
