#pragma once

#include <optional>
#include <sdf/Error.hh>
#include <sdf/Geometry.hh>
#include <sdf/Joint.hh>
#include <sdf/Link.hh>
#include <sdf/Model.hh>
#include <sdf/SemanticPose.hh>
#include <sdf/Sensor.hh>
#include <set>
#include <string>
#include <vector>

#include "server/description/model.hpp"
#include "server/parsing/model/model_places.hpp"
#include "server/parsing/model/shape_files.hpp"
#include "server/parsing/plugins/plugin.hpp"
#include "server/parsing/sdf/sdf_report.hpp"
#include "server/parsing/sdf/sdf_values.hpp"

namespace cohort::parsing {

/// How a model is read.
struct ModelReading {
  bool is_static = false;
  bool frames_resolve = false;  ///< libsdformat found no fault with the file; if it did, it has said why
  const SdfReport& report;
  ShapeFiles& shape_files;
  std::vector<std::string>& materials;  ///< of the world; a new name is added
};

/// A model, checked; what is wrong goes to the report, and the model is then not to be used. Of links that no joint
/// connects, each is the root of a body of its own: the models after the first, which are called after their roots.
std::vector<Model> read_model(const sdf::Model& sdf_model, const ModelReading& reading);

/// Nothing if there is no such shape; the report then has it.
std::optional<Shape> read_shape(const sdf::Geometry& geometry, const ModelReading& reading);

/// The same of a visual, whose mistakes are nobody's: nothing is simulated of it. Nothing for what is not shown.
std::optional<Shape> read_visual_shape(const sdf::Geometry& geometry, const ModelReading& reading);

/// A link with its inertial, its visuals and its collisions.
Link read_link(const sdf::Link& sdf_link, const ModelReading& reading);

/// Its lights, and its `cohort:` elements that emit; of link 0.
std::vector<Emitter> read_emitters(const sdf::Link& sdf_link, const ModelReading& reading);
Emitter read_light(const sdf::Light& sdf_light, const ModelReading& reading);

/// Its `cohort:` elements that are GripRings, Fins or Drags; of link 0.
template <class Part>
std::vector<Part> read_link_parts(const sdf::Link& sdf_link, const ModelReading& reading);

/// Adds what plugins of a model whose links are read put into its links.
void add_link_parts(const std::vector<Counterpart>& of_plugins, Model& model, const SdfReport& report);

/// The joints of a model between `links`, in document order. Of a model inside of the one that is read, `scope` is the
/// prefix of all names in it, such as `arm::`.
std::vector<Joint> read_joints(const sdf::Model& sdf_model, const std::vector<Link>& links, const std::string& scope,
                               const ModelReading& reading);

/// How joints of the model follow others, by its gearboxes and mimic joints. `scope` as above; the model's links and
/// joints are read.
std::vector<Coupling> read_couplings(const sdf::Model& sdf_model, const Model& model, const std::string& scope,
                                     const ModelReading& reading);

/// The devices of a model whose links and joints are read: those of `cohort:` elements, then those of plugins.
std::vector<Device> read_devices(const std::vector<DeviceScope>& scopes, const std::vector<Counterpart>& of_plugins,
                                 const Model& model, const SdfReport& report, ShapeFiles& files);

/// Those that are simulated, of a model whose links, joints and other devices are read: in the order of the links, then
/// of the joints.
std::vector<Device> read_sdf_sensors(const std::vector<SensorPlace>& places, const Model& model,
                                     const ModelReading& reading);

/// Whether the pose is given in the frame that it is to be in, and needs no resolving.
inline bool is_in_frame_of_parent(const sdf::Model& model) {
  return model.PoseRelativeTo().empty() && model.PlacementFrameName().empty();
}
template <class Posed>
bool is_in_frame_of_parent(const Posed& posed) {
  return posed.PoseRelativeTo().empty();
}

/// The pose of anything that has one, in the frame `in`; by default, in that of the element that it stands in.
template <class Posed>
Pose resolved_pose(const Posed& posed, const ModelReading& reading, const std::string& in = "") {
  if (!reading.frames_resolve) return {};
  if (in.empty() && is_in_frame_of_parent(posed)) return written_pose(posed.RawPose(), posed.Element());
  ignition::math::Pose3d X;
  for (const sdf::Error& error : posed.SemanticPose().Resolve(X, in))
    reading.report.problem(posed.Element(), error.Message());
  return to_pose(X);
}

}  // namespace cohort::parsing
