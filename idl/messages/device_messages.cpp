#include "idl/messages/device_messages.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace cohort::messages {
namespace {

using Values = std::span<const double>;

constexpr float unknown = std::numeric_limits<float>::quiet_NaN();
constexpr double zero_celsius = 273.15;  // [K]

ros::Vector3 vector_at(Values values, std::size_t at) { return {values[at], values[at + 1], values[at + 2]}; }

std::array<double, 9> not_measured() { return {-1.0}; }

// Makes the sensors of one model.
class Sensors {
 public:
  Sensors(const description::Model& model, std::span<const Channel> observation)
      : model_(model), observation_(observation) {}

  void operator()(const description::Lidar& lidar) {
    const std::size_t at = offset(lidar.name + "/0/ranges");
    if (lidar.rows == 1)
      add<ros::LaserScan>(lidar, "",
                          [lidar, at](ros::LaserScan& scan, Values values) { fill(scan, lidar, values.subspan(at)); });
    else
      add<ros::PointCloud2>(
          lidar, "", [lidar, at](ros::PointCloud2& cloud, Values values) { fill(cloud, lidar, values.subspan(at)); });
  }
  void operator()(const description::Imu& imu) {
    const std::size_t orientation = imu.has_orientation ? offset(imu.name + "/0/orientation") : 0;
    const std::size_t velocity = offset(imu.name + "/0/angular_velocity");
    const std::size_t acceleration = offset(imu.name + "/0/linear_acceleration");
    add<ros::Imu>(imu, "", [=, has = imu.has_orientation](ros::Imu& message, Values v) {
      if (has)
        message.orientation = {v[orientation], v[orientation + 1], v[orientation + 2], v[orientation + 3]};
      else
        message.orientation_covariance = not_measured();
      message.angular_velocity = vector_at(v, velocity);
      message.linear_acceleration = vector_at(v, acceleration);
    });
  }
  void operator()(const description::Accelerometer& sensor) {
    const std::size_t at = offset(sensor.name + "/0/acceleration");
    add<ros::Imu>(sensor, "", [at](ros::Imu& message, Values values) {
      message.orientation_covariance = message.angular_velocity_covariance = not_measured();
      message.linear_acceleration = vector_at(values, at);
    });
  }
  void operator()(const description::Magnetometer& sensor) {
    const std::size_t at = offset(sensor.name + "/0/magnetic_field");
    add<ros::MagneticField>(sensor, "", [at](ros::MagneticField& message, Values values) {
      message.magnetic_field = vector_at(values, at);
    });
  }
  void operator()(const description::AirPressureSensor& sensor) {
    const std::size_t at = offset(sensor.name + "/0/pressure");
    add<ros::FluidPressure>(sensor, "",
                            [at](ros::FluidPressure& message, Values values) { message.fluid_pressure = values[at]; });
  }
  void operator()(const description::ForceTorqueSensor& sensor) {
    const std::size_t force = offset(sensor.name + "/0/force");
    const std::size_t torque = offset(sensor.name + "/0/torque");
    add_placed<ros::WrenchStamped>(
        sensor.name, "",
        [=](ros::WrenchStamped& message, Values values) {
          message.wrench = {vector_at(values, force), vector_at(values, torque)};
        },
        [sensor, joint = model_.joints[sensor.joint]](const LinkPoses& X_WL) { return place_of(sensor, joint, X_WL); });
  }
  void operator()(const description::ClimateSensor& sensor) {
    const std::size_t temperature = offset(sensor.name + "/0/temperature");
    const std::size_t humidity = offset(sensor.name + "/0/humidity");
    const auto place = [sensor](const LinkPoses& X_WL) {
      const Pose X_WS = X_WL(sensor.link);
      return Pose{X_WS * sensor.p_LS, X_WS.orientation};
    };
    add_placed<ros::Temperature>(
        sensor.name, "temperature",
        [=](ros::Temperature& message, Values values) { message.temperature = values[temperature] - zero_celsius; },
        place);
    add_placed<ros::RelativeHumidity>(
        sensor.name, "humidity",
        [=](ros::RelativeHumidity& message, Values values) { message.relative_humidity = values[humidity]; }, place);
  }
  void operator()(const description::Battery& battery) {
    const std::size_t at = offset(battery.name + "/0/charge");
    add_placed<ros::BatteryState>(battery.name, "", [at](ros::BatteryState& message, Values values) {
      message.voltage = message.temperature = message.current = unknown;
      message.charge = message.capacity = message.design_capacity = unknown;
      message.percentage = static_cast<float>(values[at]);
      message.power_supply_status = ros::BatteryState::discharging;
      message.present = true;
    });
  }
  template <class Other>
  void operator()(const Other&) {}

  std::vector<DeviceMessage> take() { return std::move(sensors_); }

 private:
  std::size_t offset(const std::string& channel) const {
    std::size_t at = 0;
    for (const Channel& each : observation_) {
      if (each.name == channel) return at;
      at += each.size;
    }
    throw std::logic_error("robots of the model " + model_.name + " have no " + channel);
  }

  // Of a sensor with a place S on a link.
  template <RosMessage Message, class Posed, class Fill>
  void add(const Posed& sensor, const std::string& what, const Fill& fill_in) {
    add_placed<Message>(sensor.name, what, fill_in,
                        [sensor](const LinkPoses& X_WL) { return X_WL(sensor.link) * sensor.X_LS; });
  }
  template <RosMessage Message, class Fill>
  void add_placed(const std::string& device, const std::string& what, const Fill& fill_in,
                  decltype(DeviceMessage::place) place = {}) {
    sensors_.push_back({what.empty() ? device : device + "/" + what, device, Message::type,
                        messages::definition<Message>(),
                        [fill_in](CdrWriter& writer, const ros::Header& header, Values observation) {
                          Message message;
                          message.header = header;
                          fill_in(message, observation);
                          writer.add(message);
                        },
                        std::move(place)});
  }

  static double bearing(const description::Lidar& lidar, std::size_t column) {
    if (lidar.columns == 1) return 0.5 * (lidar.min_bearing + lidar.max_bearing);
    return lidar.min_bearing + static_cast<double>(column) * (lidar.max_bearing - lidar.min_bearing) /
                                   static_cast<double>(lidar.columns - 1);
  }
  static double elevation(const description::Lidar& lidar, std::size_t row) {
    return lidar.min_elevation +
           static_cast<double>(row) * (lidar.max_elevation - lidar.min_elevation) / static_cast<double>(lidar.rows - 1);
  }

  // What reads as the end of the range is further away, which ROS calls infinite (its REP 117).
  static void fill(ros::LaserScan& scan, const description::Lidar& lidar, Values ranges) {
    scan.angle_min = static_cast<float>(bearing(lidar, 0));
    scan.angle_max = static_cast<float>(bearing(lidar, lidar.columns - 1));
    scan.angle_increment =
        lidar.columns == 1 ? 0.0F : (scan.angle_max - scan.angle_min) / static_cast<float>(lidar.columns - 1);
    scan.range_min = static_cast<float>(lidar.min_range);
    scan.range_max = static_cast<float>(lidar.max_range);
    scan.ranges.reserve(lidar.columns);
    for (const double range : ranges.first(lidar.columns))
      scan.ranges.push_back(range < lidar.max_range ? static_cast<float>(range)
                                                    : std::numeric_limits<float>::infinity());
  }

  // The points that were hit, in S.
  static void fill(ros::PointCloud2& cloud, const description::Lidar& lidar, Values ranges) {
    std::vector<float> points;
    points.reserve(3 * lidar.rows * lidar.columns);
    for (std::size_t row = 0; row < lidar.rows; ++row) {
      const double up = elevation(lidar, row);
      for (std::size_t column = 0; column < lidar.columns; ++column) {
        const double range = ranges[row * lidar.columns + column];
        if (!(range < lidar.max_range)) continue;
        const double aside = bearing(lidar, column);
        const double level = range * std::cos(up);
        for (const double coordinate : {level * std::cos(aside), level * std::sin(aside), range * std::sin(up)})
          points.push_back(static_cast<float>(coordinate));
      }
    }
    cloud.set_points(points);
  }

  static Pose place_of(const description::ForceTorqueSensor& sensor, const description::Joint& joint,
                       const LinkPoses& X_WL) {
    using Frame = description::ForceTorqueSensor::Frame;
    const Pose X_WJ = X_WL(joint.child) * joint.X_LJ;
    Pose X_WS = X_WJ;
    if (sensor.axes == Frame::sensor) X_WS.orientation = (X_WJ * sensor.X_JS).orientation;
    if (sensor.axes == Frame::child) X_WS.orientation = X_WL(joint.child).orientation;
    if (sensor.axes == Frame::parent)
      X_WS.orientation =
          joint.parent == description::Joint::world ? Eigen::Quaterniond::Identity() : X_WL(joint.parent).orientation;
    return X_WS;
  }

  const description::Model& model_;
  std::span<const Channel> observation_;
  std::vector<DeviceMessage> sensors_;
};

}  // namespace

std::vector<DeviceMessage> device_messages(const description::Model& model, std::span<const Channel> observation) {
  Sensors sensors(model, observation);
  for (const description::Device& device : model.devices) std::visit(sensors, device);
  return sensors.take();
}

}  // namespace cohort::messages
