#pragma once

#include <cstdint>
#include <functional>

#include "idl/dds/survey.hpp"
#include "idl/dds/transport.hpp"
#include "idl/wire/control_messages.hpp"

namespace cohort::session {

/// What a server reads and writes in one DDS domain, or by one identity's way into it; not what it writes to one
/// client.
struct Endpoints {
  /// On threads of DDS: see wire::Reader.
  struct Callbacks {
    wire::Reader<wire::Join>::Callbacks joins;
    wire::Reader<wire::Command>::Callbacks commands;
    wire::Reader<wire::Report>::Callbacks reports;
    wire::Reader<wire::Request>::Callbacks requests;
    wire::Reader<wire::ControllerState>::Callbacks states;
    std::function<void(std::uint32_t)> foreign_version;  ///< major, of the protocol
  };
  Endpoints(wire::Participant& participant, Callbacks callbacks)
      : descriptions(participant),
        joins(participant, std::move(callbacks.joins)),
        commands(participant, std::move(callbacks.commands), "", answers_kept),
        reports(participant, std::move(callbacks.reports)),
        requests(participant, std::move(callbacks.requests)),
        states(participant, std::move(callbacks.states)),
        versions(participant, std::move(callbacks.foreign_version)) {}

  static constexpr int answers_kept = 8;  ///< of each client, by DDS, until they are taken

  // Readers last, so that no callback comes before all else is there.
  wire::Writer<wire::RobotDescription> descriptions;
  wire::Reader<wire::Join> joins;
  wire::Reader<wire::Command> commands;
  wire::Reader<wire::Report> reports;
  wire::Reader<wire::Request> requests;
  wire::Reader<wire::ControllerState> states;
  wire::VersionWatch versions;
};

}  // namespace cohort::session
