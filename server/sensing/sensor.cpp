#include "server/sensing/sensor.hpp"

#include "server/sensing/joint_encoder.hpp"
#include "server/sensing/proximity_ring.hpp"
#include "server/sensing/treel_encoder.hpp"

namespace cohort::sensing {
namespace {

// The register of sensors: a new kind is one more line here.
struct Make {
  const description::Model& model;
  Mount& mount;

  template <class ActuatorOnly>
  std::unique_ptr<Sensor> operator()(const ActuatorOnly&) const {
    return nullptr;
  }
  std::unique_ptr<Sensor> operator()(const description::ProximityRing& d) const {
    return std::make_unique<ProximityRing>(d, std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::JointEncoder& d) const {
    return std::make_unique<JointEncoder>(d, model.joints[d.joint], std::move(mount));
  }
  std::unique_ptr<Sensor> operator()(const description::TreelEncoder& d) const {
    return std::make_unique<TreelEncoder>(d, std::move(mount));
  }
};

}  // namespace

std::unique_ptr<Sensor> make_sensor(const description::Device& device, const description::Model& model, Mount mount) {
  return std::visit(Make{model, mount}, device);
}

}  // namespace cohort::sensing
