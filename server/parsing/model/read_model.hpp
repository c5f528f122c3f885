// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
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
  bool frames_resolve = false;  ///< no problem was found in the file
  const SdfReport& report;
  ShapeFiles& shape_files;
  std::vector<std::string>& materials;  ///< materials of the world; new names are added
};

/// Reads and checks the model to which the frames belong. If problems are reported, the result must not be used. If
/// joints do not connect all links, each connected group of links becomes a separate model. Models after the first are
/// named after their root links.
std::vector<Model> read_model(const Frames& frames, const ModelReading& reading);

/// Reads a shape; returns nothing, with a report, if it is invalid.
std::optional<Shape> read_shape(const Element& geometry, const ModelReading& reading);

/// Reads the shape of a visual, whose errors are not reported, since visuals are not simulated. Returns nothing if it
/// is not shown.
std::optional<Shape> read_visual_shape(const Element& geometry, const ModelReading& reading);

/// Returns the element with the friction of a collision that applies: <ode>, or else <bullet>; nullptr if it has none.
const Element* friction_of(const Element& collision);

/// Sets the directions of friction that `gz:expressed_in` of <fdir1> defines in another frame, for a body whose links
/// are complete and in their final order. A frame of another link that may move is kept; directions in all other frames
/// are converted to the frame of their collision. `frames`: those of the whole model.
void set_friction_frames(const Frames& frames, const ModelReading& reading, Model& body);

/// Reads a link with its inertial, visuals and collisions.
Link read_link(const Element& element, const Frames& frames, const ModelReading& reading);

/// Reads the lights of a link and its `cohort:` emitters; the caller sets their link index.
std::vector<Emitter> read_emitters(const Element& element, const Frames& frames, const ModelReading& reading);
Emitter read_light(const Element& element, const Frames& frames, const ModelReading& reading);

/// Reads the `cohort:` elements of a link that are GripRings, Fins or Drags; the caller sets their link index.
template <class Part>
std::vector<Part> read_link_parts(const Element& element, const ModelReading& reading);

/// Adds the link parts that plugins define, for a model whose links have been read.
void add_link_parts(const std::vector<Counterpart>& of_plugins, Model& model, const SdfReport& report);

/// Reads the joints of a model between `links`, in document order. For a nested model, `scope` is the prefix of all its
/// names, such as `arm::`.
std::vector<Joint> read_joints(const Frames& frames, const std::vector<Link>& links, const std::string& scope,
                               const ModelReading& reading);

/// Reads the couplings of joints from gearboxes and mimic joints. `scope` as above; links and joints of the model have
/// been read.
std::vector<Coupling> read_couplings(const Frames& frames, const Model& model, const std::string& scope,
                                     const ModelReading& reading);

/// Returns the direction of <axis> or <axis2> in the frame of its joint; nothing if it is written in a frame that does
/// not exist.
std::optional<Eigen::Vector3d> direction_of(const Element& axis, const Frames& frames);

/// Reads the devices of a model whose links and joints have been read: those of `cohort:` elements, then those of
/// plugins.
std::vector<Device> read_devices(const std::vector<DeviceScope>& scopes, const std::vector<Counterpart>& of_plugins,
                                 const Model& model, const SdfReport& report, ShapeFiles& files);

/// Reads the supported `<sensor>` elements of a model whose links, joints and other devices have been read, in the
/// order of the links, then of the joints.
std::vector<Device> read_sdf_sensors(const std::vector<SensorPlace>& places, const Model& model,
                                     const ModelReading& reading);

/// Returns the pose of an element in the frame `in`; by default, in that of its parent element.
inline Pose resolved_pose(const Element& posed, const Frames& frames, const ModelReading& reading,
                          const std::string& in = "") {
  return reading.frames_resolve ? frames.pose(posed, in).value_or(Pose{}) : Pose{};
}

}  // namespace cohort::parsing
