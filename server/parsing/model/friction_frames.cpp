// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "server/parsing/model/read_model.hpp"

namespace cohort::parsing {
namespace {

template <class Part>
Part* find_part(std::vector<Part>& parts, const std::string& name) {
  const auto found = std::ranges::find(parts, name, &Part::name);
  return found == parts.end() ? nullptr : &*found;
}

std::string written_frame(const Element& direction) {
  for (const char* const attribute : {"gz:expressed_in", "ignition:expressed_in"})
    if (direction.has_attribute(attribute)) return direction.attribute(attribute);
  return "";
}

class FrictionFrames {
 public:
  FrictionFrames(const ModelReading& reading, Model& body) : reading_(reading), body_(body) {}

  void set(const Frames& frames, const std::string& scope) const;

 private:
  void set_direction(const Element& written, const Element& direction, const Frames& frames, const std::string& scope,
                     Collision& collision) const;

  const ModelReading& reading_;
  Model& body_;
};

void FrictionFrames::set(const Frames& frames, const std::string& scope) const {
  for (const Element* const link_element : children_of(frames.owner(), "link")) {
    Link* const link = find_part(body_.links, scope + name_of(*link_element));
    if (link == nullptr) continue;  // it belongs to another body
    for (const Element* const written : children_of(*link_element, "collision")) {
      const Element* const friction = friction_of(*written);
      const Element* const direction = find(friction, {"fdir1"});
      Collision* const collision = find_part(link->collisions, name_of(*written));
      if (is_written(direction) && collision != nullptr) set_direction(*written, *direction, frames, scope, *collision);
    }
  }
  for (const Element* const inner : children_of(frames.owner(), "model"))
    set(*frames.of(*inner), scope + name_of(*inner) + "::");
}

void FrictionFrames::set_direction(const Element& written, const Element& direction, const Frames& frames,
                                   const std::string& scope, Collision& collision) const {
  const std::string frame = written_frame(direction);
  if (frame.empty()) return;
  const std::string own_link = name_of(*written.parent());
  Eigen::Vector3d& way = collision.surface.friction_direction;
  const auto way_L = frames.direction(way, frame, own_link);
  const auto frame_link = frames.link_of(frame);
  if (!way_L || !frame_link) {
    reading_.report.flaw(&direction, "expressed_in refers to a frame '" + frame + "' that does not exist",
                         "the direction is used in the frame of the collision");
    return;
  }
  const auto of_frame = std::ranges::find(body_.links, scope + *frame_link, &Link::name);
  if (!body_.is_static && *frame_link != own_link && of_frame != body_.links.end()) {
    way = *frames.direction(way, frame, *frame_link);
    collision.surface.friction_link = static_cast<std::size_t>(of_frame - body_.links.begin());
    return;
  }
  if (of_frame == body_.links.end())
    reading_.report.warning(&direction, "the frame '" + frame +
                                            "' belongs to another body; the direction turns with the collision "
                                            "instead");
  way = collision.X_LC.orientation.inverse() * *way_L;
}

}  // namespace

const Element* friction_of(const Element& collision) {
  const Element* const friction = find(&collision, {"surface", "friction"});
  const Element* const ode = find(friction, {"ode"});
  return ode != nullptr ? ode : find(friction, {"bullet"});
}

void set_friction_frames(const Frames& frames, const ModelReading& reading, Model& body) {
  if (reading.frames_resolve) FrictionFrames(reading, body).set(frames, "");
}

}  // namespace cohort::parsing
