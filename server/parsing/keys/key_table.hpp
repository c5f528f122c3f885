#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>
#include <type_traits>

#include "server/description/readout.hpp"
#include "server/parsing/keys/extension.hpp"

/// How a struct of a description is spelled in files is said once, by its table in device_keys.hpp:
///
///     template <>
///     inline constexpr auto table_of<GroundSensors> = KeyTable{
///         sensor("ground_sensors", "Infrared sensors that look down."),
///         link_key(&GroundSensors::link, "the link that carries them; the rays go along its -z axis"),
///         key("place", &GroundSensors::places_L, vector, "m", "", "where a ray starts, in the link; any number"),
///         key("range", &GroundSensors::range, positive, "m", "", "length of the rays"),
///     };
///
/// Each row is a key, as files are checked against and manuals are made from (`extension_of`), and the member that has
/// its value. Readers and writers go through the rows of a struct with `for_keys_of`. The type of a row says where the
/// value is: in the file itself (MemberKey), in what the file names (ReferenceKey), or in the readout (NoiseKey); the
/// type of the member says how it is read and written. Code is left for what no row can say: checks across keys.
///
/// A table may hold keys of several structs, and each struct is read and written with its own: those of any sensor are
/// joined by those of its Readout and of the Noise in it; a Sound has some of its Emitter.
namespace cohort::parsing::keys {

template <class Type>
concept List = requires(Type list) {
  list.emplace_back();
};
template <class Kind>
concept Senses = requires(Kind kind) {
  kind.readout;
};

/// Whether a value is written that the struct has by default. One whose key has no fallback is not.
enum class Written { always, unless_default };

/// Numbers, flags, vectors, poses, lists of these; an enum, whose values are the `choices` in their order; a time,
/// written in seconds, or as its rate if the unit is Hz.
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

/// What a name or a path in a file stands for.
enum class Referent {
  link,
  root_link,
  belt_link,  ///< one whose surface nothing else drives
  joint,
  moving_joint,  ///< one that has an angle or a way: its first axis is meant
  driven_joint,  ///< a moving one that has no other motor
  wheel_joint,   ///< between the root link and a wheel that nothing else drives
  drive,         ///< a device, a TreelDrive
  samples        ///< a file
};

struct Reference : ExtensionKey {
  Referent to = Referent::link;
};

/// An index or several, or what a file holds.
template <class Owner, class Member>
struct ReferenceKey : Reference {
  using Struct = Owner;
  Member Struct::*member;
};

/// The deviation of the noise on some quantities of a sensor.
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

/// What a table says of the element as a whole.
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

/// Of a struct that `cohort:` elements describe.
template <class Kind>
inline constexpr std::nullptr_t table_of{};
template <class Kind>
concept HasTable = requires {
  table_of<Kind>.keys;
};

/// Calls `visit` with each key whose value `Struct` has.
template <class Struct, class Keys, class Visit>
constexpr void for_keys_of(const Keys& keys, const Visit& visit) {
  const auto visit_own = [&]<class Key>(const Key& each) {
    if constexpr (std::is_base_of_v<typename Key::Struct, Struct>) visit(each);
  };
  std::apply([&](const auto&... each) { (visit_own(each), ...); }, keys);
}

}  // namespace cohort::parsing::keys
