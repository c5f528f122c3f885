// SPDX-License-Identifier: Apache-2.0
#include "server/physics/fluid/fluid_model.hpp"

#include <cmath>

namespace cohort::physics {

FluidModel::FluidModel(const Mechanism& mechanism, const Media& media) {
  const description::Model& model = mechanism.model();
  const auto place = [&](std::size_t link, const Pose& X_LP) {
    const Mechanism::LinkPlace& at = mechanism.link(link);
    return Place{link, at.segment, at.X_SL * X_LP, model.links[link].feels_wind};
  };
  const bool is_windy = media.air.wind != Eigen::Vector3d::Zero() && media.air.wind_force > 0.0;
  for (std::size_t link = 0; link < model.links.size(); ++link) {
    const description::Link& described = model.links[link];
    if (media.water)
      for (const description::Collision& collision : described.collisions)
        if (FloatingShape shape(collision.shape); shape.has_volume())
          floats.push_back({place(link, collision.X_LC), std::move(shape)});
    if (is_windy && described.feels_wind)
      windages.push_back({place(link, described.inertial.X_LI), described.inertial.mass});
  }
  for (const description::Device& device : model.devices)
    if (const description::Thruster* const thruster = description::thruster_of(device))
      rotors.push_back({place(thruster->link, thruster->X_LR), thruster});
  for (const description::Fin& fin : model.fins)
    fins.push_back({place(fin.link, fin.X_LF), &fin, std::tan(fin.alpha0)});
  for (const description::Drag& drag : model.drags) drags.push_back({place(drag.link, drag.X_LD), &drag});
}

}  // namespace cohort::physics
