// SPDX-License-Identifier: Apache-2.0
#include <cstddef>
#include <stdexcept>
#include <string>

#include "client_sdk/hosting/c_handles.hpp"

namespace cohort {
namespace {

// Drives a robot through the callbacks of a controller in C.
class CallbackController final : public Controller {
 public:
  CallbackController(const CohortController& callbacks, const CohortMemory& memory)
      : callbacks_(callbacks), memory_(memory) {}
  CallbackController(const CallbackController&) = delete;
  CallbackController& operator=(const CallbackController&) = delete;
  ~CallbackController() override {
    if (self_ != nullptr && callbacks_.destroy != nullptr) callbacks_.destroy(self_);
  }

  void start(const Start& start) override {
    last_error().clear();
    if (self_ == nullptr && callbacks_.create != nullptr) {
      self_ = callbacks_.create();
      if (self_ == nullptr) throw failure("create returned NULL");
    }
    const CohortStart handle(start);
    const int result = callbacks_.start(self_, &handle);
    if (handle.mistake) throw std::runtime_error(*handle.mistake);
    check(result);
  }

  void step(const Observation& observation, Command& command) override {
    last_error().clear();
    const CohortObservation observation_handle{observation};
    CohortCommand command_handle{command};
    check(callbacks_.step(self_, &observation_handle, &command_handle));
  }

  void save(StateWriter& state) const override {
    if (memory_.save == nullptr) return state.leave_out();
    last_error().clear();
    CohortStateWriter handle{state};
    check(memory_.save(self_, &handle));
  }

  void load(StateReader& state) override {
    if (memory_.load == nullptr) return;
    last_error().clear();
    CohortStateReader handle{state};
    const int result = memory_.load(self_, &handle);
    if (handle.mistake) throw StateError(*handle.mistake);
    check(result);
  }

 private:
  static std::runtime_error failure(const std::string& otherwise) {
    return std::runtime_error(last_error().empty() ? otherwise + " without an error message" : last_error());
  }
  static void check(int result) {
    if (result != 0) throw failure("the callback returned " + std::to_string(result));
  }

  const CohortController callbacks_;
  const CohortMemory memory_;
  void* self_ = nullptr;
};

// Programs read a C plugin's exported symbol as a Plugin.
static_assert(COHORT_PLUGIN_ABI == Plugin::current_abi);
static_assert(sizeof(CohortPlugin) == sizeof(Plugin));
static_assert(offsetof(CohortPlugin, abi) == offsetof(Plugin, abi));
static_assert(offsetof(CohortPlugin, name) == offsetof(Plugin, name));
static_assert(offsetof(CohortPlugin, create) == offsetof(Plugin, create));
static_assert(offsetof(CohortPlugin, destroy) == offsetof(Plugin, destroy));

}  // namespace
}  // namespace cohort

std::uint64_t cohort_tick(const CohortObservation* observation) { return observation->observation.tick(); }

std::int64_t cohort_time_ns(const CohortObservation* observation) { return observation->observation.time().count(); }

double cohort_read(const CohortObservation* observation, CohortObservationChannel channel) {
  return observation->observation[{channel.offset, channel.size}];
}

const double* cohort_read_all(const CohortObservation* observation, CohortObservationChannel channel) {
  return observation->observation.values({channel.offset, channel.size}).data();
}

void cohort_set(CohortCommand* command, CohortCommandChannel channel, double value) {
  cohort_set_at(command, channel, 0, value);
}

void cohort_set_at(CohortCommand* command, CohortCommandChannel channel, std::size_t index, double value) {
  command->command.set({channel.offset, channel.size, channel.lower, channel.upper}, value, index);
}

void* cohort_make_controller(const CohortController* controller) {
  const CohortMemory none = {nullptr, nullptr};
  return cohort_make_controller_with_memory(controller, &none);
}

void* cohort_make_controller_with_memory(const CohortController* controller, const CohortMemory* memory) {
  return static_cast<cohort::Controller*>(new cohort::CallbackController(*controller, *memory));
}

void cohort_destroy_controller(void* made) { delete static_cast<cohort::Controller*>(made); }
