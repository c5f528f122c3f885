// SPDX-License-Identifier: Apache-2.0
#include "server/actuation/actuator_kinds.hpp"

namespace cohort::actuation {
namespace {

/// Attachment of a joint: it holds if the value is above 0.5.
class DetachableJoint final : public ActuatorOf<description::DetachableJoint> {
 public:
  DetachableJoint(const description::DetachableJoint& joint, const Mount& mount)
      : ActuatorOf(joint, mount), number_(mount.detachable_joints.of_device(mount.body, mount.device)) {}
  std::vector<Channel> channels() const override {
    return {{device_.name + "/0/attached", "1", 1, 0.0, 1.0, device_.is_initially_attached ? 1.0 : 0.0}};
  }
  void apply(std::span<const double> values) override { mount_.detachable_joints.command(number_, values[0]); }

 private:
  std::uint32_t number_;
};

}  // namespace

std::unique_ptr<Actuator> make_actuator(const description::DetachableJoint& joint, const Mount& mount) {
  return std::make_unique<DetachableJoint>(joint, mount);
}

}  // namespace cohort::actuation
