// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <type_traits>

#include "idl/dds/control_fields.hpp"
#include "idl/dds/fields.hpp"
#include "idl/dds/message_fields.hpp"
#include "idl/dds/topic.hpp"

/// Converts messages to and from the structs that idlc generates from cohort.idl. Frequent messages (Observation,
/// Command, WorldState) are not copied and need no allocation.
namespace cohort::wire {

template <class Message>
struct Codec {
  static_assert(lists_all_members<Message>(),
                "a member of the message is missing from its list of fields, or listed twice");
  static_assert(lists_all_fields<Message>(), "a field of cohort.idl is missing from the list of fields");

  using Sample = typename OnWire<Message>::S;
  static constexpr const Topic& topic = OnWire<Message>::topic;

  /// A sample that borrows from its message.
  struct Outgoing {
    explicit Outgoing(const Message& message) { lend_fields(message, sample, room); }
    Sample sample{};
    [[no_unique_address]] std::conditional_t<fields_need_room<Message>(), Room, NoRoom> room{};
  };

  /// Decodes a sample. Spans of the message, if any, borrow from it.
  static Message decode(const Sample& sample) {
    Message message;
    read_fields(sample, message);
    return message;
  }
};

}  // namespace cohort::wire
