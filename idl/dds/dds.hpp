#pragma once

#include <dds/dds.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "idl/dds/identity.hpp"
#include "idl/dds/wire_error.hpp"

/// What the files of idl/ share. Not for others: the only header that includes Cyclone's.
namespace cohort::wire {

/// `result` if it is a handle or a count. Throws WireError: what was tried on what, and what DDS says.
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

/// No policies yet.
Qos make_qos();

/// Makes a participant this identity. Throws WireError if the plugins of DDS Security are not installed.
void secure(dds_qos_t* qos, const Identity& identity);

/// Of a message of Cyclone's log that tells of a refused handshake, the text for people the first time that it comes.
std::optional<std::string> refusal_told_first(std::string_view message);

}  // namespace cohort::wire
