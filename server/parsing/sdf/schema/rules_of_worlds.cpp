// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/schema/sdf_rules.hpp"

namespace cohort::parsing {

const char* const rules_of_worlds = R"(
sdf 1 @version! text
  [world] *
  [model] ?
  [actor] ? x
  [light] ?
  [include] *
world * @name! text
  audio ? ~
    device 1 text "default"
  wind ?
    linear_velocity ? vector3 "0 0 0"
  [include] *
  gravity 1 vector3 "0 0 -9.8"
  magnetic_field 1 vector3 "5.5645e-6 22.8758e-6 -42.3884e-6"
  [atmosphere] 1
  [gui] ? -
  [physics] +
  [scene] 1 -
  [light] *
  [frame] *
  [joint] *
  [model] *
  [actor] * x
  [plugin] *
  [road] * ~
  [spherical_coordinates] ? x"; a navsat measures in metres from the origin of the world"
  state * ... x @world_name! text
  [population] * x"; use <cohort:population>"
include * @merge flag "false"
  uri 1 text
  name ? text
  namespace ? text x"; topics have the name of the robot"
  static ? flag "false"
  model_state ? ... x
  [pose] ?
  [plugin] *
  placement_frame ? text
scene 1
  ambient 1 color "0.4 0.4 0.4 1.0"
  background 1 color ".7 .7 .7 1"
  sky ?
    time ? real "10.0"
    sunrise ? real "6.0"
    sunset ? real "20.0"
    clouds ?
      speed ? real >=0 "0.6"
      direction ? real >=0 <=3.1456 "0.0"
      humidity ? real >=0 <=1 "0.5"
      mean_size ? real >=0 <=1 "0.5"
      ambient ? color ".8 .8 .8 1"
    cubemap_uri ? text
  shadows 1 flag "true"
  fog ?
    color ? color "1 1 1 1"
    type ? text "none"
    start ? real >=0 "1.0"
    end ? real >=0 "100.0"
    density ? real >=0 "1.0"
  grid ? flag "true"
  origin_visual ? flag "true"
gui ? @fullscreen flag "false"
  [plugin] *
  camera ? @name! text "user_camera"
    view_controller ? text "orbit"
    projection_type ? text "perspective"
    track_visual ?
      name ? text
      min_dist ? real "0"
      max_dist ? real "0"
      static ? flag "false"
      use_model_frame ? flag "true"
      xyz ? vector3 "-5.0 0.0 3.0"
      inherit_yaw ? flag "false"
    [pose] ?
light * @name! text @type! text "point"
  cast_shadows ? flag "false" -
  light_on ? flag "true" x"; set <intensity> to 0 for a light that is off"
  visualize ? flag "true" -
  intensity ? real "1"
  [pose] ?
  diffuse ? color "1 1 1 1"
  specular ? color ".1 .1 .1 1" -
  attenuation ?
    range 1 real "10"
    linear ? real "1"
    constant ? real "1"
    quadratic ? real "0"
  direction 1 vector3 "0 0 -1"
  spot ?
    inner_angle 1 real "0"
    outer_angle 1 real "0"
    falloff 1 real "0"
actor * @name! text
  [pose] ?
  skin ?
    filename 1 text
    scale ? real "1.0"
  animation * @name! text
    filename 1 text
    scale ? real "1.0"
    interpolate_x ? flag "false"
  script 1
    loop ? flag "true"
    delay_start ? real "0.0"
    auto_start ? flag "true"
    trajectory * @id! integer "0" @type! text @tension real >=0 <=1 "0.0"
      waypoint *
        time 1 real "0.0"
        pose 1 pose "0 0 0 0 0 0"
  [link] +
  [joint] *
  [plugin] *
population * @name! text
  [box] ?
  [cylinder] ?
  model_count 1 integer "1"
  distribution 1
    type 1 text "random"
    rows ? integer "1"
    cols ? integer "1"
    step ? vector3 "0.5 0.5 0"
  [pose] ?
  [model] 1
physics 1 @name text "default_physics" - @default flag "false" @type! text "ode" -
  max_step_size 1 real "0.001"
  real_time_factor 1 real "1.0" ~
  real_time_update_rate 1 real "1000" ~
  max_contacts ? integer "20" ~
  dart ? ~
    solver 1
      solver_type 1 text "dantzig"
    collision_detector ? text "fcl"
  simbody ? ~
    min_step_size ? real "0.0001"
    accuracy ? real "1e-3"
    max_transient_velocity ? real "0.01"
    contact ?
      stiffness ? real "1e8"
      dissipation ? real "100"
      plastic_coef_restitution ? real "0.5"
      plastic_impact_velocity ? real "0.5"
      static_friction ? real "0.9"
      dynamic_friction ? real "0.9"
      viscous_friction ? real "0.0"
      override_impact_capture_velocity ? real "0.001"
      override_stiction_transition_velocity ? real "0.001"
  bullet ? ~
    solver 1
      type 1 text "sequential_impulse"
      min_step_size ? real "0.0001"
      iters 1 integer "50"
      sor 1 real "1.3"
    constraints 1
      cfm 1 real "0"
      erp 1 real "0.2"
      contact_surface_layer 1 real "0.001"
      split_impulse 1 flag "true"
      split_impulse_penetration_threshold 1 real "-0.01"
  ode ? ~
    solver 1
      type 1 text "quick"
      min_step_size ? real "0.0001"
      island_threads ? integer "0"
      iters 1 integer "50"
      precon_iters ? integer "0"
      sor 1 real "1.3"
      thread_position_correction ? flag "false"
      use_dynamic_moi_rescaling 1 flag "false"
      friction_model ? text "pyramid_model"
    constraints 1
      cfm 1 real "0"
      erp 1 real "0.2"
      contact_max_correcting_vel 1 real "100.0"
      contact_surface_layer 1 real "0.001"
atmosphere 1 @type! text "adiabatic" x
  temperature ? real "288.15" x
  pressure ? real "101325" x
  temperature_gradient ? real "-0.0065" x
road * @name! text
  width 1 real "1.0"
  point + vector3 "0 0 0"
  [material] ?
spherical_coordinates ?
  surface_model 1 text "EARTH_WGS84"
  world_frame_orientation ? text "ENU"
  latitude_deg 1 real "0.0"
  longitude_deg 1 real "0.0"
  elevation 1 real "0.0"
  surface_axis_equatorial ? real "0.0"
  surface_axis_polar ? real "0.0"
  heading_deg 1 real "0.0"
particle_emitter * @name! text @type! text "point"
  emitting ? flag "true"
  duration ? real "0"
  size ? vector3 "1 1 1"
  particle_size ? vector3 "1 1 1"
  lifetime ? real "5"
  rate ? real >=0 "10"
  min_velocity ? real >=0 "1"
  max_velocity ? real >=0 "1"
  scale_rate ? real >=0 "0"
  color_start ? color "1 1 1 1"
  color_end ? color "1 1 1 1"
  color_range_image ? text
  topic ? text
  particle_scatter_ratio ? real "0.65"
  [pose] ?
  [material] ?
material ?
  script ? -
    uri + text
    name 1 text
  shader ? - @type! text "pixel"
    normal_map ? text
  render_order ? real "0.0" -
  lighting ? flag "true" -
  ambient ? color "0 0 0 1" -
  diffuse ? color "0 0 0 1"
  specular ? color "0 0 0 1" -
  shininess ? real "0" -
  emissive ? color "0 0 0 1" -
  double_sided ? flag "false" -
  pbr ?
    metal ?
      albedo_map ? text
      roughness_map ? text -
      roughness ? text "0.5" -
      metalness_map ? text -
      metalness ? text "0.5" -
      environment_map ? text -
      ambient_occlusion_map ? text -
      normal_map ? text - @type text "tangent"
      emissive_map ? text -
      light_map ? text - @uv_set count "0"
    specular ? -
      albedo_map ? text
      specular_map ? text
      glossiness_map ? text
      glossiness ? text "0"
      environment_map ? text
      ambient_occlusion_map ? text
      normal_map ? text @type text "tangent"
      emissive_map ? text
      light_map ? text @uv_set count "0"
plugin * ... @name text @filename! text
pose ? pose "0 0 0 0 0 0" @relative_to text @rotation_format text "euler_rpy" @degrees flag "false"
frame * @name! text @attached_to text
  [pose] ?
)";

}  // namespace cohort::parsing
