#include "server/description/devices.hpp"

namespace cohort::description {
namespace {

template <class ReadoutType>
struct FindReadout {
  template <class Kind>
  ReadoutType* operator()(Kind& kind) const {
    if constexpr (requires { kind.readout; })
      return &kind.readout;
    else
      return nullptr;
  }
};

}  // namespace

Readout* readout_of(Device& device) { return std::visit(FindReadout<Readout>{}, device); }
const Readout* readout_of(const Device& device) { return std::visit(FindReadout<const Readout>{}, device); }

const std::string& name_of(const Device& device) {
  return std::visit([](const auto& kind) -> const std::string& { return kind.name; }, device);
}

}  // namespace cohort::description
