#pragma once

#include <type_traits>

#include "idl/dds/control_fields.hpp"
#include "idl/dds/fields.hpp"
#include "idl/dds/message_fields.hpp"
#include "idl/dds/topic.hpp"

/// From the messages to the structs that idlc generates from cohort.idl, and back. Hot messages (Observation, Command,
/// WorldState) are neither copied nor allocated for.
namespace cohort::wire {

template <class Message>
struct Codec {
  static_assert(lists_all_members<Message>(), "a member of the message is missing in its list of fields, or twice");
  static_assert(lists_all_fields<Message>(), "a field of cohort.idl is missing in the list of fields");

  using Sample = typename OnWire<Message>::S;
  static constexpr const Topic& topic = OnWire<Message>::topic;

  /// A sample that borrows from the message it is made of.
  struct Outgoing {
    explicit Outgoing(const Message& message) { lend_fields(message, sample, room); }
    Sample sample{};
    [[no_unique_address]] std::conditional_t<fields_need_room<Message>(), Room, NoRoom> room{};
  };

  /// Spans of the message, if any, borrow from the sample.
  static Message decode(const Sample& sample) {
    Message message;
    read_fields(sample, message);
    return message;
  }
};

}  // namespace cohort::wire
