// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tuple>

#include "idl/messages/cohort_device_messages.hpp"
#include "idl/messages/ros_discovery_messages.hpp"
#include "idl/messages/ros_messages.hpp"
#include "idl/messages/ros_navigation_messages.hpp"
#include "idl/messages/ros_sensor_messages.hpp"
#include "idl/messages/ros_simulation_queries.hpp"
#include "idl/messages/ros_simulation_services.hpp"

/// The structs of idl/messages that correspond to ROS 2 messages, for tests of each of them.
namespace cohort::test {

namespace ros = messages::ros;

/// The messages that all ROS 2 distributions have.
using StandardMessages =
    std::tuple<ros::Time, ros::Duration, ros::Header, ros::Empty, ros::Bool, ros::Int32, ros::Float32, ros::Float64,
               ros::String, ros::ColorRGBA, ros::Float32MultiArray, ros::Float64MultiArray, ros::Clock, ros::Pose,
               ros::PoseStamped, ros::PoseArray, ros::PoseWithCovariance, ros::Transform, ros::TransformStamped,
               ros::Twist, ros::TwistStamped, ros::TwistWithCovariance, ros::Accel, ros::WrenchStamped, ros::TFMessage,
               ros::Odometry, ros::JointTrajectory, ros::LaserScan, ros::PointCloud2, ros::Imu, ros::MagneticField,
               ros::FluidPressure, ros::Temperature, ros::RelativeHumidity, ros::JointState, ros::Range,
               ros::BatteryState, ros::NavSatFix, ros::Image>;

template <class... Services>
using RequestsAndResponses =
    decltype(std::tuple_cat(std::declval<std::tuple<typename Services::Request, typename Services::Response>>()...));

namespace simulation = ros::simulation;

/// simulation_interfaces 2.1.
using SimulationServices = std::tuple<
    simulation::GetSimulatorFeatures, simulation::GetSimulationState, simulation::SetSimulationState,
    simulation::ResetSimulation, simulation::StepSimulation, simulation::SpawnEntity, simulation::SpawnEntities,
    simulation::DeleteEntity, simulation::GetEntities, simulation::GetEntitiesStates, simulation::GetEntityState,
    simulation::SetEntityState, simulation::GetEntityInfo, simulation::SetEntityInfo, simulation::GetEntityBounds,
    simulation::GetNamedPoses, simulation::GetNamedPoseBounds, simulation::GetSpawnables, simulation::LoadWorld,
    simulation::UnloadWorld, simulation::GetCurrentWorld, simulation::GetAvailableWorlds>;

template <class Services>
struct MessagesOf;
template <class... Services>
struct MessagesOf<std::tuple<Services...>> {
  using type = RequestsAndResponses<Services...>;
};
using SimulationMessages = MessagesOf<SimulationServices>::type;

namespace cohort_msgs = messages::cohort_msgs;

/// The package cohort_msgs.
using CohortMessages =
    std::tuple<cohort_msgs::RingReadings, cohort_msgs::Sounds, cohort_msgs::NeighborMessage,
               cohort_msgs::RangeAndBearing, cohort_msgs::Spot, cohort_msgs::Spots, cohort_msgs::GripperState,
               cohort_msgs::Inclination, cohort_msgs::Traction, cohort_msgs::TrackEncoders, cohort_msgs::Contact,
               cohort_msgs::Effort, cohort_msgs::RotorVelocity, cohort_msgs::Altitude, cohort_msgs::LocalFix,
               cohort_msgs::VisibleObject, cohort_msgs::VisibleObjects, cohort_msgs::Sound>;

}  // namespace cohort::test
