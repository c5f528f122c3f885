// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/common/terminal/printed_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/cli/common/shown.hpp"
#include "tools/common/data/csv_tables.hpp"

namespace cohort::tool {
namespace {

using description::PrintedQuantity;
using description::Quantity;

// Returns the columns of one object, or of all objects together.
std::vector<std::string> columns_of(Quantity quantity) {
  switch (quantity) {
    case Quantity::position: return {"x", "y", "z"};
    case Quantity::pose: return {"x", "y", "z", "qx", "qy", "qz", "qw"};
    case Quantity::heading: return {"heading"};
    case Quantity::velocity: return {"vx", "vy", "vz"};
    case Quantity::count: return {"count"};
    case Quantity::quarantined: return {"quarantined"};
    case Quantity::joint_force: return {"first_fx", "first_fy", "first_fz", "second_fx", "second_fy", "second_fz"};
    case Quantity::joint_torque: return {"first_tx", "first_ty", "first_tz", "second_tx", "second_ty", "second_tz"};
  }
  return {};
}

bool is_of_all_together(Quantity quantity) { return quantity == Quantity::count || quantity == Quantity::quarantined; }

std::vector<double> values_of(Quantity quantity, const Simulation& simulation, std::uint32_t object) {
  const Pose X_WL = simulation.object_pose(object);
  const Eigen::Vector3d& p = X_WL.position;
  const Eigen::Quaterniond& q = X_WL.orientation;
  switch (quantity) {
    case Quantity::position: return {p.x(), p.y(), p.z()};
    case Quantity::pose: return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
    case Quantity::heading: {
      const Eigen::Vector3d forward_W = q * Eigen::Vector3d::UnitX();
      return {std::atan2(forward_W.y(), forward_W.x())};
    }
    case Quantity::velocity: {
      const Eigen::Vector3d v = simulation.world().link_twist(BodyId{object}, LinkId{0}).linear_W;
      return {v.x(), v.y(), v.z()};
    }
    default: return {};
  }
}

// Returns the values at both ends of the joint.
std::vector<double> values_of_joint(Quantity quantity, const BreakableJoints& joints, std::size_t joint) {
  std::vector<double> values;
  for (const physics::Wrench& wrench : {joints.wrench_on_first(joint), joints.wrench_on_second(joint)}) {
    const Eigen::Vector3d& v = quantity == Quantity::joint_force ? wrench.force_W : wrench.torque_W;
    for (const double component : v) values.push_back(component + 0.0);  // no -0
  }
  return values;
}

double number_of(Quantity quantity, const Objects& objects, const std::vector<std::size_t>& among) {
  return static_cast<double>(std::count_if(among.begin(), among.end(), [&](std::size_t each) {
    const auto object = static_cast<std::uint32_t>(each);
    return quantity == Quantity::count ? objects.is_present(object) : objects.is_quarantined(object);
  }));
}

}  // namespace

PrintedTable::PrintedTable(const description::Experiment& experiment, const Simulation& simulation, bool to_stdout)
    : experiment_(experiment), simulation_(simulation), to_stdout_(to_stdout) {
  std::string header = "time";
  for (const PrintedQuantity& printed : experiment.prints) {
    every_.push_back(ticks_of(printed.every, experiment.world.step));
    for (const std::string& column : columns_of(printed.quantity)) {
      if (is_of_all_together(printed.quantity)) header += "," + data::csv_cell(printed.selector + "/" + column);
    }
    if (is_of_all_together(printed.quantity)) continue;
    for (const std::size_t object : printed.objects)
      for (const std::string& column : columns_of(printed.quantity))
        header += "," + data::csv_cell(experiment.world.instances[object].name + "/" + column);
    for (const std::size_t joint : printed.joints)
      for (const std::string& column : columns_of(printed.quantity))
        header += "," + data::csv_cell(experiment.world.breakable_joints[joint].name + "/" + column);
  }
  add_line(header);
}

void PrintedTable::boundary() {
  const std::uint64_t tick = simulation_.tick();
  const auto is_due = [&](std::uint64_t every) { return tick % every == 0; };
  if (std::none_of(every_.begin(), every_.end(), is_due)) return;
  std::string line = fmt::format("{}", std::chrono::duration<double>(simulation_.time()).count());
  for (std::size_t i = 0; i < every_.size(); ++i) {
    const PrintedQuantity& printed = experiment_.prints[i];
    const bool due = is_due(every_[i]);
    if (is_of_all_together(printed.quantity)) {
      line += due ? fmt::format(",{}", number_of(printed.quantity, simulation_.objects(), printed.objects)) : ",";
      continue;
    }
    for (const std::size_t each : printed.objects) {
      const auto object = static_cast<std::uint32_t>(each);
      if (due && simulation_.objects().is_present(object)) {
        for (const double value : values_of(printed.quantity, simulation_, object)) line += fmt::format(",{}", value);
      } else {
        line.append(columns_of(printed.quantity).size(), ',');
      }
    }
    for (const std::size_t joint : printed.joints) {
      if (due)
        for (const double value : values_of_joint(printed.quantity, simulation_.breakable_joints(), joint))
          line += fmt::format(",{}", value);
      else
        line.append(columns_of(printed.quantity).size(), ',');
    }
  }
  add_line(line);
}

void PrintedTable::add_line(const std::string& line) {
  text_ += line + "\n";
  if (!to_stdout_) return;
  show(line + "\n");
  flush_output();
}

}  // namespace cohort::tool
