// Changes from outside to a world between steps.

#include "server/physics/islands/multibody_world.hpp"

namespace cohort::physics {

void MultibodyWorld::set_present(BodyId body, bool is_present) {
  if (is_present)
    put_back_body(body);
  else
    remove_body(body);
}

void MultibodyWorld::remove_body(BodyId index) {
  PlacedBody& body = bodies_[index.value];
  if (!is_active(index)) return;
  if (!is_static(index)) return assembly_.take_out(wake(index).member);
  sleep_.wake_all();
  body.is_out = true;
  assembly_.connections.release_of_body(index.value);
  for (std::uint32_t solid = body.first_solid; solid < body.end_of_solids; ++solid) {
    assembly_.scene.remove(solid);
    assembly_.collision.remove(solid);
  }
}

void MultibodyWorld::put_back_body(BodyId index) {
  PlacedBody& body = bodies_[index.value];
  if (is_active(index)) return;
  if (!is_static(index)) return assembly_.put_back(body.member);
  sleep_.wake_all();
  body.is_out = false;
  for (std::uint32_t solid = body.first_solid; solid < body.end_of_solids; ++solid) assembly_.scene.put_back(solid);
}

void MultibodyWorld::release_body(BodyId index) {
  is_lowest_known_ = false;
  slots_.release(bodies_[index.value], link_pose(index, LinkId{0}), description_);
}

void MultibodyWorld::place_body(BodyId index, const Pose& X_WM) {
  PlacedBody& body = bodies_[index.value];
  body.X_WM = X_WM;
  body.is_placed_again = true;
  is_lowest_known_ = false;
  if (!is_static(index)) return assembly_.place(wake(index).member, X_WM);
  sleep_.wake_all();
  assembly_.connections.release_of_body(index.value);
  std::uint32_t next = body.first_solid;
  for (const description::Link& link : description_.models[body.model].links)
    for (const description::Collision& collision : link.collisions) {
      assembly_.collision.remove(next);
      assembly_.scene.set_pose(next++, X_WM * link.X_ML * collision.X_LC);
    }
  assembly_.scene.build();
}

void MultibodyWorld::push_body(BodyId body, LinkId link, const Wrench& wrench) {
  wake(body);
  const description::Inertial& inertial = description_.models[bodies_[body.value].model].links[link.value].inertial;
  assembly_.pushes.add({bodies_[body.value].member, multibody(body).mechanism().link(link.value).segment, link.value,
                        link_pose(body, link) * inertial.X_LI.position, wrench});
}

}  // namespace cohort::physics
