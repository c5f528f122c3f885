// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "server/description/readout.hpp"
#include "server/parsing/keys/extension.hpp"

/// The spelling of a struct of a description in files is defined once, by its table in device_keys.hpp:
///
///     template <>
///     inline constexpr auto table_of<GroundSensors> = KeyTable{
///         sensor("ground_sensors", "Infrared sensors that point down."),
///         link_key(&GroundSensors::link, "link that carries the sensors; the rays point along its -z axis"),
///         key("place", &GroundSensors::places_L, vector, "m", "",
///             "origin of the ray of one sensor in the link frame; may be repeated"),
///         key("range", &GroundSensors::range, positive, "m", "", "length of the rays"),
///     };
///
/// Each row is a key, which is used to check files and to make manuals (`extension_of`), and the member for its value.
/// Readers and writers visit the rows of a struct with `for_keys_of`. The type of a row defines the source of the
/// value: the file itself (MemberKey), an object that the file names (ReferenceKey), or the readout (NoiseKey). The
/// type of the member defines how it is read and written. Only checks across keys need code.
///
/// A table may hold keys of several structs; each struct is read and written with its own keys. Every sensor also has
/// the keys of its Readout and of the Noise in it; a Sound has some of its Emitter.
namespace cohort::parsing::keys {

template <class Type>
concept List = requires(Type list) {
  list.emplace_back();
};
template <class Kind>
concept Senses = requires(Kind kind) {
  kind.readout;
};

/// Selects whether the default value of a member is written. It is never written if its key has no fallback.
enum class Written { always, unless_default };

/// A key for numbers, flags, vectors, poses and lists of these. Also for an enum, whose values are the `choices` in
/// their order, or for a time, written in seconds, or as its rate if the unit is Hz.
template <class Owner, class Member>
struct MemberKey : ExtensionKey {
  using Struct = Owner;
  Member Struct::*member;
  bool omits_default = false;
  bool (*is_needed)(const Struct&) = nullptr;  ///< not written where this is false

  constexpr MemberKey only_if(bool (*condition)(const Struct&)) const {
    MemberKey result = *this;
    result.is_needed = condition;
    return result;
  }
};

/// The target of a name or a path in a file.
enum class Referent {
  link,
  root_link,
  belt_link,  ///< one whose surface no other device drives
  joint,
  moving_joint,  ///< one that moves; refers to its first axis
  driven_joint,  ///< a moving one without another motor
  wheel_joint,   ///< between the root link and a wheel without another drive
  drive,         ///< a device, a TreelDrive
  samples        ///< a file
};

struct Reference : ExtensionKey {
  Referent to = Referent::link;
};

/// A key for an index, several indices, or the content of a file.
template <class Owner, class Member>
struct ReferenceKey : Reference {
  using Struct = Owner;
  Member Struct::*member;
};

/// A key for the standard deviation of the noise on some quantities of a sensor.
template <class Owner>
struct NoiseKey : ExtensionKey {
  using Struct = Owner;
  std::array<std::string_view, 2> quantities;  ///< the second may be empty
};

template <class Struct, class Member>
constexpr MemberKey<Struct, Member> key(std::string_view name, Member Struct::*member, ExtensionValue value,
                                        std::string_view unit, std::string_view fallback, std::string_view doc,
                                        Written written = Written::always) {
  const bool omits_default = written == Written::unless_default || fallback == no_value;
  return {{name, value, unit, fallback, doc, List<Member>}, member, omits_default};
}

template <class Struct>
constexpr MemberKey<Struct, Pose> pose_key(Pose Struct::*member, std::string_view doc) {
  return key("pose", member, ExtensionValue::pose, "m, rad", "0 0 0 0 0 0", doc);
}

template <class Struct, class Choice>
constexpr MemberKey<Struct, Choice> choice_key(std::string_view name, Choice Struct::*member,
                                               std::span<const std::string_view> choices, std::string_view fallback,
                                               std::string_view doc) {
  return {{name, ExtensionValue::choice, "", fallback, doc, false, choices}, member};
}

template <class Struct, class Member>
constexpr ReferenceKey<Struct, Member> reference(std::string_view name, Member Struct::*member, Referent to,
                                                 std::string_view fallback, std::string_view doc) {
  const ExtensionValue value = to == Referent::samples ? ExtensionValue::uri : ExtensionValue::name;
  return {{{name, value, "", fallback, doc, List<Member>}, to}, member};
}

template <class Struct>
constexpr ReferenceKey<Struct, std::size_t> link_key(std::size_t Struct::*member, std::string_view doc) {
  return reference("link", member, Referent::link, "", doc);
}

template <class Struct>
constexpr NoiseKey<Struct> noise_key(std::string_view name, Readout Struct::*,
                                     const std::array<std::string_view, 2>& quantities, std::string_view unit,
                                     std::string_view doc) {
  return {{name, ExtensionValue::non_negative, unit, "0", doc}, quantities};
}

/// The head of a table, which describes the element as a whole.
constexpr Extension sensor(std::string_view name, std::string_view doc) {
  return {name, "model", true, doc, {}, "sensors"};
}
constexpr Extension actuator(std::string_view name, std::string_view doc) {
  return {name, "model", true, doc, {}, "actuators"};
}
constexpr Extension emitter(std::string_view name, std::string_view doc) {
  return {name, "link", true, doc, {}, "emitters"};
}

template <class... Keys>
struct KeyTable {
  Extension head;  ///< without its keys
  std::tuple<Keys...> keys;

  constexpr KeyTable(const Extension& element, Keys... all) : head(element), keys(all...) {}
};

/// The table of a struct that `cohort:` elements describe.
template <class Kind>
inline constexpr std::nullptr_t table_of{};
template <class Kind>
concept HasTable = requires {
  table_of<Kind>.keys;
};

/// Calls `visit` with each key whose value is in `Struct`.
template <class Struct, class Keys, class Visit>
constexpr void for_keys_of(const Keys& keys, const Visit& visit) {
  const auto visit_own = [&]<class Key>(const Key& each) {
    if constexpr (std::is_base_of_v<typename Key::Struct, Struct>) visit(each);
  };
  std::apply([&](const auto&... each) { (visit_own(each), ...); }, keys);
}

}  // namespace cohort::parsing::keys
