// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/schema/sdf_rules.hpp"

namespace cohort::parsing {

const char* const rules_of_sensors = R"(
sensor ? @name! text @type! text
  always_on ? flag "false" -
  update_rate ? real "0"
  visualize ? flag "false" -
  topic ? text -
  enable_metrics ? flag "false" -
  frame_id ? text x
  [pose] ?
  [plugin] *
  [air_pressure] ?
  [air_speed] ? !"a sensor of this type is left out, with a warning"
  [altimeter] ?
  [camera] ? !"a sensor of this type is left out, with a warning"
  [contact] ?
  [force_torque] ?
  [gps] ?
  [imu] ?
  [lidar] ?
  [logical_camera] ?
  [magnetometer] ?
  [navsat] ?
  [ray] ?
  [rfidtag] ? !"a sensor of this type is left out, with a warning"
  [rfid] ? !"a sensor of this type is left out, with a warning"
  [sonar] ? !"a sensor of this type is left out, with a warning"
  [transceiver] ? !"a sensor of this type is left out, with a warning"
noise 1 @type! text "none"
  mean ? real "0.0"
  stddev ? real >=0 "0.0"
  bias_mean ? real "0.0"
  bias_stddev ? real >=0 "0.0"
  dynamic_bias_stddev ? real >=0 "0.0"
  dynamic_bias_correlation_time ? real "0.0"
  precision ? real "0.0"
altimeter ?
  vertical_position ?
    [noise] ?
  vertical_velocity ?
    [noise] ?
air_pressure ?
  reference_altitude ? real "0.0"
  pressure ?
    [noise] ?
air_speed ?
  pressure ?
    [noise] ?
camera ? @name text
  triggered ? flag "false"
  camera_info_topic ? text
  trigger_topic ? text
  horizontal_fov 1 real >=0.001 <=6.283186 "1.047"
  image 1
    width 1 integer "320"
    height 1 integer "240"
    format ? text "R8G8B8"
    anti_aliasing ? integer "4"
  clip 1
    near 1 real >=0 ".1"
    far 1 real >=0.1 "100"
  save ? @enabled! flag "false"
    path 1 text
  depth_camera ?
    output 1 text "depths"
    clip ?
      near ? real >=0 ".1"
      far ? real >=0.1 "10.0"
  segmentation_type ? text "semantic"
  box_type ? text "2d"
  noise ?
    type 1 text "gaussian"
    mean ? real "0.0"
    stddev ? real "0.0"
  distortion ?
    k1 ? real "0.0"
    k2 ? real "0.0"
    k3 ? real "0.0"
    p1 ? real "0.0"
    p2 ? real "0.0"
    center ? vector2 "0.5 0.5"
  lens ?
    type 1 text "stereographic"
    scale_to_hfov 1 flag "true"
    custom_function ?
      c1 ? real "1"
      c2 ? real "1"
      c3 ? real "0"
      f ? real "1"
      fun 1 text "tan"
    cutoff_angle ? real >=0 <=3.141592653 "1.5707"
    env_texture_size ? integer >=4 <=2048 "256"
    intrinsics ?
      fx 1 real "277"
      fy 1 real "277"
      cx 1 real "160"
      cy 1 real "120"
      s 1 real "0.0"
    projection ?
      p_fx ? real "277"
      p_fy ? real "277"
      p_cx ? real "160"
      p_cy ? real "120"
      tx ? real "0.0"
      ty ? real "0.0"
  visibility_mask ? count "4294967295" x
  optical_frame_id - text
  [pose] ?
contact ?
  collision 1 text
  topic 1 text "__default_topic__" -
force_torque ?
  frame ? text "child"
  measure_direction ? text "child_to_parent"
  force ?
    x ?
      [noise] ?
    y ?
      [noise] ?
    z ?
      [noise] ?
  torque ?
    x ?
      [noise] ?
    y ?
      [noise] ?
    z ?
      [noise] ?
gps ?
  position_sensing ?
    horizontal ?
      [noise] ?
    vertical ?
      [noise] ?
  velocity_sensing ?
    horizontal ?
      [noise] ?
    vertical ?
      [noise] ?
imu ?
  orientation_reference_frame ?
    localization 1 text "CUSTOM"
    custom_rpy ? vector3 "0 0 0" @parent_frame text
    grav_dir_x ? vector3 "1 0 0" x @parent_frame text
  angular_velocity ?
    x ?
      [noise] ?
    y ?
      [noise] ?
    z ?
      [noise] ?
  linear_acceleration ?
    x ?
      [noise] ?
    y ?
      [noise] ?
    z ?
      [noise] ?
  enable_orientation ? flag "true"
lidar ?
  scan 1
    horizontal 1
      samples 1 count "640"
      resolution 1 real "1"
      min_angle 1 real "0"
      max_angle 1 real "0"
    vertical ?
      samples 1 count "1"
      resolution ? real "1"
      min_angle 1 real "0"
      max_angle 1 real "0"
  range 1
    min 1 real "0"
    max 1 real "0"
    resolution ? real "0" -
  noise ?
    type 1 text "gaussian"
    mean ? real "0.0"
    stddev ? real "0.0"
  visibility_mask ? count "4294967295" x
logical_camera ?
  near 1 real "0"
  far 1 real "1"
  aspect_ratio 1 real "1"
  horizontal_fov 1 real "1"
magnetometer ?
  x ?
    [noise] ?
  y ?
    [noise] ?
  z ?
    [noise] ?
navsat ?
  position_sensing ?
    horizontal ?
      [noise] ?
    vertical ?
      [noise] ?
  velocity_sensing ?
    horizontal ?
      [noise] ?
    vertical ?
      [noise] ?
ray ?
  scan 1
    horizontal 1
      samples 1 count "640"
      resolution 1 real "1"
      min_angle 1 real "0"
      max_angle 1 real "0"
    vertical ?
      samples 1 count "1"
      resolution ? real "1"
      min_angle 1 real "0"
      max_angle 1 real "0"
  range 1
    min 1 real "0"
    max 1 real "0"
    resolution ? real "0" -
  noise ?
    type 1 text "gaussian"
    mean ? real "0.0"
    stddev ? real "0.0"
  visibility_mask ? count "4294967295" x
rfidtag ?
rfid ?
sonar ?
  geometry ? text "cone"
  min 1 real "0"
  max 1 real "1.0"
  radius ? real "0.5"
transceiver ?
  essid ? text "wireless"
  frequency ? real "2442"
  min_frequency ? real "2412"
  max_frequency ? real "2484"
  gain 1 real "2.5"
  power 1 real "14.50"
  sensitivity ? real "-90"
)";

}  // namespace cohort::parsing
