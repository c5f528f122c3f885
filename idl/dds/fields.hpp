// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <memory_resource>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "idl/dds/loans.hpp"

/// The list of fields of each message. It serves to convert messages to and from samples, the structs that idlc
/// generates from cohort.idl. To lend a message means that its sample points to the data of the message. At compile
/// time, the list is checked to contain every field of both.
namespace cohort::wire {

/// The fields of a message, or of a struct in a message. Specializations in message_fields.hpp and control_fields.hpp
/// use `Between` and define `fields`, a tuple of results of `field` and similar functions, and for messages `topic`.
template <class Message>
struct OnWire {
  static constexpr std::tuple<> fields{};
};

/// Names for lists of fields: a message as `M`, and its sample as `S`.
template <class Message, class ItsSample>
struct Between {
  using M = Message;
  using S = ItsSample;
};

/// Storage for data that a sample needs in addition to the message that it borrows from: arrays of pointers to texts,
/// and arrays of samples.
class Room {
 public:
  template <class Element>
  std::span<Element> array(std::size_t count) {
    static_assert(std::is_trivially_destructible_v<Element>);
    auto* const begin = static_cast<Element*>(arena_.allocate(count * sizeof(Element), alignof(Element)));
    std::uninitialized_value_construct_n(begin, count);
    return {begin, count};
  }

 private:
  std::pmr::monotonic_buffer_resource arena_;
};
/// For messages that need no storage.
struct NoRoom {};

template <class Value>
inline constexpr bool is_scalar = std::is_arithmetic_v<Value> || std::is_enum_v<Value>;
/// Vectors and spans, but not texts.
template <class Value>
concept List = !std::is_same_v<Value, std::string> && requires(const Value& value) {
  value.size(), value.data();
};

template <class Message>
constexpr bool fields_need_room() {
  return std::apply([]<class... Each>(const Each&...) { return (Each::needs_room || ...); }, OnWire<Message>::fields);
}
template <class Value>
constexpr bool value_needs_room() {
  if constexpr (List<Value>)
    return !std::is_arithmetic_v<typename Value::value_type>;
  else if constexpr (is_scalar<Value> || std::is_same_v<Value, std::string>)
    return false;
  else
    return fields_need_room<Value>();
}

template <class Message, class Sample, class AnyRoom>
void lend_fields(const Message& message, Sample& sample, AnyRoom& room) {
  std::apply([&](const auto&... each) { (each.lend(message, sample, room), ...); }, OnWire<Message>::fields);
}
template <class Message, class Sample>
void read_fields(const Sample& sample, Message& message) {
  std::apply([&](const auto&... each) { (each.read(sample, message), ...); }, OnWire<Message>::fields);
}

/// Converts to the type of any member.
struct Anything {
  template <class Value>
  operator Value() const noexcept;  // NOLINT(google-explicit-constructor)
};
template <class Struct, std::size_t... index>
constexpr bool has_members(std::index_sequence<index...>) {
  return requires { Struct{(static_cast<void>(index), Anything{})...}; };
}
/// Returns the number of members of a plain struct.
template <class Struct, std::size_t count = 0>
constexpr std::size_t member_count() {
  if constexpr (has_members<Struct>(std::make_index_sequence<count + 1>{}))
    return member_count<Struct, count + 1>();
  else
    return count;
}

template <class First, class Second>
constexpr bool is_same_member(First first, Second second) {
  if constexpr (std::is_same_v<First, Second>)
    return first == second;
  else
    return false;
}
/// Returns the number of distinct pointers to members in a tuple.
template <class... Members>
constexpr std::size_t distinct_count(const std::tuple<Members...>& members) {
  return [&]<std::size_t... index>(std::index_sequence<index...>) {
    [[maybe_unused]] const auto is_new = [&]<std::size_t at>(std::integral_constant<std::size_t, at>) {
      return [&]<std::size_t... before>(std::index_sequence<before...>) {
        return !(is_same_member(std::get<before>(members), std::get<at>(members)) || ...);
      }
      (std::make_index_sequence<at>{});
    };
    return (std::size_t{0} + ... + (is_new(std::integral_constant<std::size_t, index>{}) ? 1 : 0));
  }
  (std::index_sequence_for<Members...>{});
}

/// The pointers to members of a message, or of a sample, in a list.
template <class Fields>
constexpr auto members_in(const Fields& fields) {
  return std::apply([](const auto&... each) { return std::tuple_cat(each.members()...); }, fields);
}
template <class Fields>
constexpr auto samples_in(const Fields& fields) {
  return std::apply([](const auto&... each) { return std::tuple_cat(each.samples()...); }, fields);
}

/// True if the list of `Message` contains each of its members once.
template <class Message>
constexpr bool lists_all_members() {
  constexpr auto listed = members_in(OnWire<Message>::fields);
  return distinct_count(listed) == std::tuple_size_v<decltype(listed)> &&
         distinct_count(listed) == member_count<Message>();
}
/// True if the list of `Message` contains every field of its sample.
template <class Message>
constexpr bool lists_all_fields() {
  return distinct_count(samples_in(OnWire<Message>::fields)) == member_count<typename OnWire<Message>::S>();
}

/// Lends a value. Texts and lists of numbers are lent directly; values with another layout in the sample are copied to
/// `room`.
template <class Value, class Sampled, class AnyRoom>
void lend_value(const Value& value, Sampled& sampled, AnyRoom& room) {
  if constexpr (std::is_enum_v<Value>) {
    static_assert(std::is_same_v<std::underlying_type_t<Value>, Sampled>);
    sampled = static_cast<Sampled>(value);
  } else if constexpr (std::is_arithmetic_v<Value>) {
    static_assert(std::is_same_v<Value, Sampled>);
    sampled = value;
  } else if constexpr (std::is_same_v<Value, std::string>) {
    sampled = loaned(value);
  } else if constexpr (List<Value>) {
    using Element = std::remove_pointer_t<decltype(sampled._buffer)>;
    if constexpr (std::is_arithmetic_v<typename Value::value_type>) {
      static_assert(std::is_same_v<typename Value::value_type, Element>);
      loan(value, sampled);
    } else {
      const std::span<Element> elements = room.template array<Element>(value.size());
      for (std::size_t i = 0; i < value.size(); ++i) lend_value(value[i], elements[i], room);
      loan(elements, sampled);
    }
  } else {
    static_assert(std::is_same_v<typename OnWire<Value>::S, Sampled>);
    static_assert(lists_all_members<Value>() && lists_all_fields<Value>(), "a field is missing from the list");
    lend_fields(value, sampled, room);
  }
}

/// Reads a value. Spans borrow from the sample.
template <class Value, class Sampled>
void read_value(const Sampled& sampled, Value& value) {
  if constexpr (std::is_enum_v<Value>) {
    value = static_cast<Value>(sampled);
  } else if constexpr (std::is_arithmetic_v<Value>) {
    value = sampled;
  } else if constexpr (std::is_same_v<Value, std::string>) {
    value = to_string(sampled);
  } else if constexpr (List<Value>) {
    const auto elements = to_span(sampled);
    if constexpr (requires { value = elements; }) {
      value = elements;
    } else if constexpr (std::is_arithmetic_v<typename Value::value_type>) {
      value.assign(elements.begin(), elements.end());
    } else {
      value.resize(elements.size());
      for (std::size_t i = 0; i < elements.size(); ++i) read_value(elements[i], value[i]);
    }
  } else {
    read_fields(sampled, value);
  }
}

template <class Message, class Value, class Sample, class Sampled>
struct Field {
  static constexpr bool needs_room = value_needs_room<Value>();
  Value Message::*member;
  Sampled Sample::*sampled;

  template <class AnyRoom>
  void lend(const Message& message, Sample& sample, AnyRoom& room) const {
    lend_value(message.*member, sample.*sampled, room);
  }
  void read(const Sample& sample, Message& message) const { read_value(sample.*sampled, message.*member); }
  constexpr auto members() const { return std::tuple(member); }
  constexpr auto samples() const { return std::tuple(sampled); }
};

/// A member of a message and the field of its sample.
template <class Message, class Value, class Sample, class Sampled>
constexpr Field<Message, Value, Sample, Sampled> field(Value Message::*member, Sampled Sample::*sampled) {
  return {member, sampled};
}

/// A field of the sample that is always 0: the key of a topic with one instance.
template <class Sample>
struct Zero {
  static constexpr bool needs_room = false;
  std::uint32_t Sample::*sampled;

  template <class Message, class AnyRoom>
  void lend(const Message&, Sample&, AnyRoom&) const {}
  template <class Message>
  void read(const Sample&, Message&) const {}
  constexpr auto members() const { return std::tuple(); }
  constexpr auto samples() const { return std::tuple(sampled); }
};
template <class Sample>
constexpr Zero<Sample> zero(std::uint32_t Sample::*sampled) {
  return {sampled};
}

/// A member of a message that is not in its sample, because another message carries it.
template <class Message, class Value>
struct Apart {
  static constexpr bool needs_room = false;
  Value Message::*member;

  template <class Sample, class AnyRoom>
  void lend(const Message&, Sample&, AnyRoom&) const {}
  template <class Sample>
  void read(const Sample&, Message&) const {}
  constexpr auto members() const { return std::tuple(member); }
  constexpr auto samples() const { return std::tuple(); }
};
template <class Message, class Value>
constexpr Apart<Message, Value> apart(Value Message::*member) {
  return {member};
}

template <class Message, class Value, class Sample, class Sampled>
struct OptionalField {
  static constexpr bool needs_room = value_needs_room<Value>();
  std::optional<Value> Message::*member;
  bool Sample::*is_set;
  Sampled Sample::*sampled;

  template <class AnyRoom>
  void lend(const Message& message, Sample& sample, AnyRoom& room) const {
    sample.*is_set = (message.*member).has_value();
    if (message.*member) lend_value(*(message.*member), sample.*sampled, room);
  }
  void read(const Sample& sample, Message& message) const {
    if (sample.*is_set) read_value(sample.*sampled, (message.*member).emplace());
  }
  constexpr auto members() const { return std::tuple(member); }
  constexpr auto samples() const { return std::tuple(is_set, sampled); }
};

/// An optional member, with a flag in the sample that says whether it is set.
template <class Message, class Value, class Sample, class Sampled>
constexpr OptionalField<Message, Value, Sample, Sampled> optional_field(std::optional<Value> Message::*member,
                                                                        bool Sample::*is_set,
                                                                        Sampled Sample::*sampled) {
  return {member, is_set, sampled};
}

}  // namespace cohort::wire
