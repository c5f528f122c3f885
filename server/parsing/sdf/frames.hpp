// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "server/core/pose.hpp"
#include "server/parsing/sdf/element.hpp"

namespace cohort::parsing {

/// The frames of a world or a model: itself, its links, joints, <frame> elements and nested models, and those in nested
/// models, by names such as `arm::palm` (http://sdformat.org/tutorials?tut=pose_frame_semantics_proposal). Poses are
/// given in the frame of the world or the model. The elements must outlive this. For use by one thread.
class Frames {
 public:
  /// An invalid element, and a description of the problem.
  using Flaw = std::pair<const Element*, std::string>;

  explicit Frames(const Element& owner, const Frames* outer = nullptr);

  const Element& owner() const { return owner_; }

  /// Returns the problems of names and references here and in nested models. Poses and links can be resolved only if
  /// there are none.
  std::vector<Flaw> flaws() const;

  /// Returns the frames of a nested model; nullptr if `model` is not nested in this one.
  const Frames* of(const Element& model) const;

  /// Returns the pose of an element that has a frame here, or that is in a link, such as a collision. It is in the
  /// frame `in`, or else in that of the owner or the link. A pose that is written in that frame is returned as it is
  /// written.
  std::optional<Pose> pose(const Element& posed, const std::string& in = "") const;
  /// Returns the pose of a frame; nothing if there is none.
  std::optional<Pose> pose_of(const std::string& name) const;
  /// Returns the name of the link to which a frame is attached, `world` for the world, and nothing if there is none.
  std::optional<std::string> link_of(const std::string& name) const;
  /// Returns the direction of a vector that is written in the frame `from`, in the frame `in`.
  std::optional<Eigen::Vector3d> direction(const Eigen::Vector3d& vector, const std::string& from,
                                           const std::string& in) const;

 private:
  /// A frame, and the Frames to which it belongs. Without an element, it is the frame of their owner.
  struct Place {
    const Frames* scope;
    const Element* element;
  };
  class Steps;
  /// The step from a frame to the one in which its pose is written.
  struct Step {
    std::optional<Pose> written;
    std::optional<Place> next;
  };

  bool is_world() const { return owner_.name() == "world"; }
  std::optional<Place> find(std::string_view name) const;
  /// Returns the frame in which the pose of a frame is written.
  std::optional<Place> written_in(const Place& place) const;
  /// Returns the pose in the frame in which it is written.
  std::optional<Pose> written_pose_of(const Place& place) const;
  /// Returns the frame in which a pose is written, also of a nested model itself; nothing if there is none.
  std::optional<Place> posed_in(const Place& place) const;
  /// Returns the step, which is found once for each frame.
  const Step& step_from(const Place& place) const;
  std::optional<Place> attached_to(const Place& place) const;
  std::optional<Pose> pose_at(Place place) const;
  /// Returns the name of a place in nested models, as seen from here.
  std::string name_from_here(const Place& place) const;

  void check_names(std::vector<Flaw>& flaws) const;
  void check_references(std::vector<Flaw>& flaws) const;
  void check_reference(const Element& element, const std::string& attribute, const std::string& name,
                       std::vector<Flaw>& flaws) const;
  void check_joint(const Element& joint, std::vector<Flaw>& flaws) const;
  /// Checks names and references here and in nested models.
  void check(std::vector<Flaw>& flaws) const;
  void check_resolution(std::vector<Flaw>& flaws) const;

  const Element& owner_;
  const Frames* outer_;
  std::vector<const Element*> elements_;  // that have a frame, in document order
  std::map<std::string, const Element*, std::less<>> by_name_;
  std::map<const Element*, std::unique_ptr<Frames>> nested_;
  mutable std::unordered_map<const Element*, Step> steps_;
};

/// Returns `relative_to` of the pose of an element; empty if it has none.
std::string relative_to(const Element& posed);

}  // namespace cohort::parsing
