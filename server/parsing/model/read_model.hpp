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

/// The context for reading a model.
struct ModelReading {
  bool is_static = false;
  bool frames_resolve = false;  ///< libsdformat reported no error for the file
  const SdfReport& report;
  ShapeFiles& shape_files;
  std::vector<std::string>& materials;  ///< materials of the world; new names are added
};

/// Reads and checks a model; reports problems, and then the model must not be used. If joints do not connect all links,
/// each group is a separate body: the models after the first, which are named after their root links.
std::vector<Model> read_model(const sdf::Model& sdf_model, const ModelReading& reading);

/// Reads a shape; returns nothing, with a report, if it is invalid.
std::optional<Shape> read_shape(const sdf::Geometry& geometry, const ModelReading& reading);

/// Reads the shape of a visual, whose errors are not reported, since visuals are not simulated. Returns nothing if it
/// is not shown.
std::optional<Shape> read_visual_shape(const sdf::Geometry& geometry, const ModelReading& reading);

/// Reads a link with its inertial, visuals and collisions.
Link read_link(const sdf::Link& sdf_link, const ModelReading& reading);

/// Reads the lights of a link and its `cohort:` emitters, for link 0.
std::vector<Emitter> read_emitters(const sdf::Link& sdf_link, const ModelReading& reading);
Emitter read_light(const sdf::Light& sdf_light, const ModelReading& reading);

/// Reads the `cohort:` elements of a link that are GripRings, Fins or Drags, for link 0.
template <class Part>
std::vector<Part> read_link_parts(const sdf::Link& sdf_link, const ModelReading& reading);

/// Adds the link parts that plugins define, for a model whose links have been read.
void add_link_parts(const std::vector<Counterpart>& of_plugins, Model& model, const SdfReport& report);

/// Reads the joints of a model between `links`, in document order. For a nested model, `scope` is the prefix of all its
/// names, such as `arm::`.
std::vector<Joint> read_joints(const sdf::Model& sdf_model, const std::vector<Link>& links, const std::string& scope,
                               const ModelReading& reading);

/// Reads the couplings of joints from gearboxes and mimic joints. `scope` as above; links and joints of the model have
/// been read.
std::vector<Coupling> read_couplings(const sdf::Model& sdf_model, const Model& model, const std::string& scope,
                                     const ModelReading& reading);

/// Reads the devices of a model whose links and joints have been read: those of `cohort:` elements, then those of
/// plugins.
std::vector<Device> read_devices(const std::vector<DeviceScope>& scopes, const std::vector<Counterpart>& of_plugins,
                                 const Model& model, const SdfReport& report, ShapeFiles& files);

/// Reads the supported `<sensor>` elements of a model whose links, joints and other devices have been read, in the
/// order of the links, then of the joints.
std::vector<Device> read_sdf_sensors(const std::vector<SensorPlace>& places, const Model& model,
                                     const ModelReading& reading);

/// Returns whether the pose is given in the requested frame and needs no resolving.
inline bool is_in_frame_of_parent(const sdf::Model& model) {
  return model.PoseRelativeTo().empty() && model.PlacementFrameName().empty();
}
template <class Posed>
bool is_in_frame_of_parent(const Posed& posed) {
  return posed.PoseRelativeTo().empty();
}

/// Returns the pose of an element in the frame `in`; by default, in that of its parent element.
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
