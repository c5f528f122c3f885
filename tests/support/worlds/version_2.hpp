// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "idl/dds/codec.hpp"
#include "idl/dds/dds.hpp"

namespace cohort::test {

/// A program with the next major version of the protocol, reduced to the part that others see: a writer of
/// `cohort/v2/join`.
class Version2 {
 public:
  explicit Version2(wire::Participant participant)
      : participant_(std::move(participant)),
        topic_(wire::check(
            dds_create_topic(handle(), wire::Codec<wire::Join>::topic.type, "cohort/v2/join", nullptr, nullptr),
            "create", "a topic")),
        writer_(wire::check(dds_create_writer(handle(), topic_.handle(), nullptr, nullptr), "create", "a writer")) {}

 private:
  dds_entity_t handle() const { return participant_.state().participant.handle(); }

  wire::Participant participant_;
  wire::Entity topic_;
  wire::Entity writer_;
};

}  // namespace cohort::test
