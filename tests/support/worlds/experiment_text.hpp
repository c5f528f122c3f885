// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <sstream>
#include <string>

#include "server/core/overloaded.hpp"
#include "server/description/experiment.hpp"

namespace cohort::test {

/// Writes all parts of an experiment that may depend on its seed as text, with numbers as their bits.
class ExperimentText {
 public:
  explicit ExperimentText(const description::Experiment& experiment) {
    text_ << std::hex << "seed " << experiment.seed << "\n";
    add(experiment.world);
    for (const description::Team& team : experiment.teams) {
      text_ << "team " << team.name << " " << team.controller;
      list(team.robots);
    }
    for (const description::Event& event : experiment.events) add(event);
    for (const description::Reaction& reaction : experiment.reactions) {
      text_ << "reaction " << reaction.action;
      list(reaction.robots);
      for (const description::Event& event : reaction.events) add(event);
    }
    for (const description::StopCondition& stop : experiment.stops) {
      text_ << "stop " << stop.name << " " << stop.what.index() << " " << stop.holds_for.count();
      list(stop.objects);
    }
    for (const description::PrintedQuantity& print : experiment.prints) {
      text_ << "print " << print.selector << " " << static_cast<int>(print.quantity) << " " << print.every.count();
      list(print.objects);
      list(print.joints);
    }
    text_ << "history " << experiment.history.length << " " << experiment.history.every.count();
    list(experiment.history.objects);
    text_ << "recorded " << experiment.recorded.snapshot_interval.count();
    number(experiment.recorded.pose_rate);
    number(experiment.recorded.joint_rate);
    number(experiment.recorded.observation_rate);
    list(experiment.recorded.observed);
  }

  std::string text() const { return text_.str(); }

 private:
  void add(const description::World& world) {
    text_ << "world " << world.name << " " << world.step.count() << "\n";
    for (const description::Model& model : world.models) text_ << "model " << model.name << "\n";
    for (const description::Instance& instance : world.instances) {
      text_ << "instance " << instance.name << " " << instance.model << " " << instance.is_present;
      add(instance.X_WM);
      text_ << "\n";
    }
    text_ << "robots";
    list(world.robots);
    for (const description::BreakableJoint& joint : world.breakable_joints) {
      text_ << "joint " << joint.name << " " << joint.first << " " << joint.first_link << " " << joint.second << " "
            << joint.second_link;
      if (joint.X_LP) add(*joint.X_LP);
      text_ << "\n";
    }
    for (const description::Problem& warning : world.warnings) text_ << "warning " << warning.text() << "\n";
  }

  void add(const description::Event& event) {
    text_ << "event " << event.kind << " " << event.time.count() << " " << event.object;
    std::visit(Overloaded{[&](const description::SetPresence& set) { text_ << " " << set.present << set.once; },
                          [&](const description::PlaceAt& place) { add(place.X_WM); },
                          [&](const description::SetVelocity& set) { add(set.linear_W), add(set.angular_W); },
                          [&](const description::ApplyForce& apply) {
                            text_ << " " << apply.link << " " << apply.duration.count();
                            add(apply.force_W), add(apply.torque_W);
                          },
                          [&](const description::SetEmitters& set) { list(set.emitters); },
                          [&](const description::SpawnNew& spawn) { text_ << " " << spawn.spawner; }},
               event.effect);
    text_ << "\n";
  }

  void add(const Pose& pose) {
    add(pose.position);
    for (const double each : pose.orientation.coeffs()) number(each);
  }
  void add(const Eigen::Vector3d& vector) {
    for (const double each : vector) number(each);
  }
  void number(double value) { text_ << " " << std::bit_cast<std::uint64_t>(value); }
  template <class Items>
  void list(const Items& items) {
    for (const auto& item : items) text_ << " " << item;
    text_ << "\n";
  }

  std::ostringstream text_;
};

inline std::string text_of(const description::Experiment& experiment) { return ExperimentText(experiment).text(); }

}  // namespace cohort::test
