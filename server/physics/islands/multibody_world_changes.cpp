// What changes in a world between steps, from outside.

#include "server/physics/islands/multibody_world.hpp"

namespace cohort::physics {

void MultibodyWorld::remove_body(std::uint32_t index) {
  PlacedBody& body = bodies_[index];
  if (!is_active(index)) return;
  if (!is_static(index)) return assembly_.take_out(wake(index).member);
  sleep_.wake_all();
  body.is_out = true;
  assembly_.connections.release_of_body(index);
  for (const std::uint32_t solid : body.solids) {
    assembly_.scene.remove(solid);
    assembly_.collision.remove(solid);
  }
}

void MultibodyWorld::put_back_body(std::uint32_t index) {
  PlacedBody& body = bodies_[index];
  if (is_active(index)) return;
  if (!is_static(index)) return assembly_.put_back(body.member);
  sleep_.wake_all();
  body.is_out = false;
  for (const std::uint32_t solid : body.solids) assembly_.scene.put_back(solid);
}

void MultibodyWorld::place_body(std::uint32_t index, const Pose& X_WM) {
  PlacedBody& body = bodies_[index];
  body.X_WM = X_WM;
  body.is_placed_again = true;
  if (!is_static(index)) return assembly_.place(wake(index).member, X_WM);
  sleep_.wake_all();
  assembly_.connections.release_of_body(index);
  std::size_t next = 0;
  for (const description::Link& link : description_.models[body.model].links)
    for (const description::Collision& collision : link.collisions) {
      assembly_.collision.remove(body.solids[next]);
      assembly_.scene.set_pose(body.solids[next++], X_WM * link.X_ML * collision.X_LC);
    }
  assembly_.scene.build();
}

void MultibodyWorld::push_body(std::uint32_t body, std::size_t link, const Wrench& wrench) {
  wake(body);
  const description::Inertial& inertial = description_.models[bodies_[body].model].links[link].inertial;
  assembly_.pushes.add({bodies_[body].member, multibody(body).mechanism().link(link).segment, link,
                        link_pose(body, link) * inertial.X_LI.position, wrench});
}

}  // namespace cohort::physics
