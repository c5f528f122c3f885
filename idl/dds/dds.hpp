// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <dds/dds.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "idl/dds/identity.hpp"
#include "idl/dds/wire_error.hpp"

/// Internal to idl/: the only header that includes Cyclone DDS.
namespace cohort::wire {

/// Returns `result` if it is a handle or a count. Otherwise throws WireError with the attempted operation and the error
/// of DDS.
dds_return_t check(dds_return_t result, const char* verb, const char* object);

/// Owns a DDS entity.
class Entity {
 public:
  Entity() = default;
  explicit Entity(dds_entity_t handle) : handle_(handle) {}
  Entity(Entity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  Entity& operator=(Entity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~Entity() {
    if (handle_ != 0) dds_delete(handle_);
  }

  dds_entity_t handle() const { return handle_; }

 private:
  dds_entity_t handle_ = 0;
};

struct ParticipantState {
  std::optional<Identity> identity;
  Entity domain;
  Entity participant;
};

using Qos = std::unique_ptr<dds_qos_t, void (*)(dds_qos_t*)>;

/// Creates a participant in a domain with this configuration of Cyclone DDS and this QoS. Other participants of this
/// process may have other configurations. Throws WireError.
std::unique_ptr<ParticipantState> join_domain(std::uint32_t domain, const std::string& configuration,
                                              const dds_qos_t* qos);

/// Creates a QoS without policies.
Qos make_qos();

/// Adds the identity to the QoS of a participant. Throws WireError if the plugins of DDS Security are not installed.
void secure(dds_qos_t* qos, const Identity& identity);

/// Returns a human-readable text if a log message of Cyclone DDS reports a refused handshake that has not been reported
/// before.
std::optional<std::string> refusal_told_first(std::string_view message);

}  // namespace cohort::wire
