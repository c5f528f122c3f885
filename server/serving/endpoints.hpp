// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>

#include "idl/dds/survey.hpp"
#include "idl/dds/transport.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort::session {

/// The readers and writers of a server in one DDS domain, or for one identity in it, except the writers for single
/// clients.
struct Endpoints {
  /// Called on threads of DDS; see wire::Reader.
  struct Callbacks {
    wire::Reader<wire::Join>::Callbacks joins;
    wire::Reader<wire::Command>::Callbacks commands;
    wire::Reader<wire::Report>::Callbacks reports;
    wire::Reader<wire::Request>::Callbacks requests;
    wire::Reader<wire::ControllerState>::Callbacks states;
    std::function<void(std::uint32_t)> foreign_version;  ///< major version of the protocol
  };
  Endpoints(wire::Participant& participant, Callbacks callbacks)
      : trees(participant),
        descriptions(participant),
        joins(participant, std::move(callbacks.joins)),
        commands(participant, std::move(callbacks.commands), "", answers_kept),
        reports(participant, std::move(callbacks.reports)),
        requests(participant, std::move(callbacks.requests)),
        states(participant, std::move(callbacks.states)),
        versions(participant, std::move(callbacks.foreign_version)) {}

  static constexpr int answers_kept = 8;  ///< answers of each client that DDS keeps until they are taken

  // Readers come last, so that all other members exist before the first callback. Clients discover writers in this
  // order: one that has discovered `descriptions` knows that there are `trees`.
  wire::Writer<wire::RobotTree> trees;
  wire::Writer<wire::RobotDescription> descriptions;
  wire::Reader<wire::Join> joins;
  wire::Reader<wire::Command> commands;
  wire::Reader<wire::Report> reports;
  wire::Reader<wire::Request> requests;
  wire::Reader<wire::ControllerState> states;
  wire::VersionWatch versions;
};

}  // namespace cohort::session
