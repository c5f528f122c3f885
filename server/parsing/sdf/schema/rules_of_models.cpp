// SPDX-License-Identifier: Apache-2.0
#include "server/parsing/sdf/schema/sdf_rules.hpp"

namespace cohort::parsing {

const char* const rules_of_models = R"(
model * @name! text @namespace text x"; topics have the name of the robot" @canonical_link text @placement_frame text
  static ? flag "false"
  self_collide ? flag "false"
  allow_auto_disable ? flag "true"
  [frame] *
  [pose] ?
  [link] *
  [joint] *
  [plugin] *
  [gripper] * x
  [include] *
  [model] *
  model_state ? ... x
  enable_wind ? flag "false"
link * @name! text
  gravity ? flag "true"
  enable_wind ? flag "false"
  self_collide ? flag "false" x"; <self_collide> of the model applies to all of its links"
  kinematic ? flag "false"
  must_be_base_link ? flag "false" ~
  velocity_decay ? x
    linear ? real "0.0"
    angular ? real "0.0"
  [pose] ?
  [inertial] ?
  [collision] *
  [visual] *
  [sensor] *
  [projector] * x
  [audio_sink] * x
  [audio_source] * x
  [battery] * x
  [light] *
  [particle_emitter] * ~
inertial ? @auto flag "false"
  mass ? real "1.0"
  density ? real "1000.0"
  auto_inertia_params ? ~
  pose ? pose "0 0 0 0 0 0" @rotation_format text "euler_rpy" @degrees flag "false"
  inertia ?
    ixx 1 real "1.0"
    ixy 1 real "0.0"
    ixz 1 real "0.0"
    iyy 1 real "1.0"
    iyz 1 real "0.0"
    izz 1 real "1.0"
  fluid_added_mass ?
    xx ? real "0.0"
    xy ? real "0.0"
    xz ? real "0.0"
    xp ? real "0.0"
    xq ? real "0.0"
    xr ? real "0.0"
    yy ? real "0.0"
    yz ? real "0.0"
    yp ? real "0.0"
    yq ? real "0.0"
    yr ? real "0.0"
    zz ? real "0.0"
    zp ? real "0.0"
    zq ? real "0.0"
    zr ? real "0.0"
    pp ? real "0.0"
    pq ? real "0.0"
    pr ? real "0.0"
    qq ? real "0.0"
    qr ? real "0.0"
    rr ? real "0.0"
joint * @name! text @type! text
  parent 1 text
  child 1 text
  gearbox_ratio ? real "1.0"
  gearbox_reference_body ? text
  thread_pitch - real "1.0"
  screw_thread_pitch ? real "1.0"
  axis ?
    xyz 1 vector3 "0 0 1" @expressed_in text
    dynamics ?
      damping ? real "0"
      friction ? real "0"
      spring_reference 1 real "0"
      spring_stiffness 1 real "0"
    limit 1
      lower 1 real "-inf"
      upper 1 real "inf"
      effort ? real "inf"
      velocity ? real "inf"
      stiffness ? real "1e8"
      dissipation ? real "1.0"
    [mimic] ?
  axis2 ?
    xyz 1 vector3 "0 0 1" @expressed_in text
    dynamics ?
      damping ? real "0"
      friction ? real "0"
      spring_reference 1 real "0"
      spring_stiffness 1 real "0"
    limit 1
      lower ? real "-inf"
      upper ? real "inf"
      effort ? real "inf"
      velocity ? real "inf"
      stiffness ? real "1e8"
      dissipation ? real "1.0"
    [mimic] ?
  physics ? x
    simbody ?
      must_be_loop_joint ? flag "false"
    ode ?
      cfm_damping ? flag "false"
      implicit_spring_damper ? flag "false"
      fudge_factor ? real "0"
      cfm ? real "0"
      erp ? real "0.2"
      bounce ? real "0"
      max_force ? real "0"
      velocity ? real "0"
      limit ?
        cfm 1 real "0.0"
        erp 1 real "0.2"
      suspension ?
        cfm 1 real "0.0"
        erp 1 real "0.2"
    provide_feedback ? flag "false"
  [pose] ?
  [sensor] *
mimic ? @joint! text @axis text "axis"
  multiplier 1 real "1.0"
  offset 1 real "0"
  reference 1 real "0"
collision * @name! text
  laser_retro ? real "0" x"; lidars measure no intensity"
  max_contacts ? integer "10" ~
  density ? real "1000.0"
  auto_inertia_params ? ~
  [pose] ?
  [geometry] 1
  [surface] ?
visual * @name! text -
  cast_shadows ? flag "true" -
  laser_retro ? real "0.0" x"; lidars measure no intensity"
  transparency ? real "0.0"
  visibility_flags ? count "4294967295" -
  meta ? -
    layer ? integer "0"
  [pose] ?
  [material] ?
  [geometry] 1
  [plugin] * -
geometry 1
  empty ?
  [box] ?
  [capsule] ?
  [cone] ?
  [cylinder] ?
  [ellipsoid] ?
  [heightmap] ?
  [image] ? !"a collision with it is an error, and is left out of third-party static models"
  [mesh] ?
  [plane] ?
  [polyline] *
  [sphere] ?
box ?
  size 1 vector3 "1 1 1"
sphere ?
  radius 1 real "1"
cylinder ?
  radius 1 real "1"
  length 1 real "1"
cone ?
  radius 1 real "1"
  length 1 real "1"
capsule ?
  radius 1 real "0.5"
  length 1 real "1"
ellipsoid ?
  radii 1 vector3 "1 1 1"
plane ?
  normal 1 vector3 "0 0 1"
  size 1 vector2 "1 1" -
mesh ? @optimization text x"; a mesh that moves is replaced by its convex hull"
  convex_decomposition ? x"; a mesh that moves is replaced by its convex hull"
    max_convex_hulls ? count "16"
    voxel_resolution ? count "200000"
  uri 1 text
  submesh ?
    name 1 text
    center ? flag "false"
  scale ? vector3 "1 1 1"
heightmap ?
  uri 1 text
  size ? vector3 "1 1 1"
  pos ? vector3 "0 0 0"
  texture * -
    size 1 real "10"
    diffuse 1 text
    normal 1 text
  blend * -
    min_height 1 real "0"
    fade_dist 1 real "0"
  use_terrain_paging ? flag "false" -
  sampling ? count "1" ~
image ?
  uri 1 text
  scale 1 real "1"
  threshold 1 integer "200"
  height 1 real "1"
  granularity 1 integer "1"
polyline *
  point + vector2 "0 0"
  height 1 real "1.0"
surface ?
  bounce ?
    restitution_coefficient ? real >=0 <=1 "0"
    threshold ? real "100000"
  friction ?
    torsional ?
      coefficient ? real >=0 "1.0"
      use_patch_radius ? flag "true" !"`false` causes a warning, and the friction is 0; set <patch_radius>"
      patch_radius ? real >=0 "0"
      surface_radius ? real >=0 "0.0" x
      ode ? x
        slip ? real "0.0"
    ode ?
      mu ? real >=0 "1"
      mu2 ? real >=0 "1"
      fdir1 ? vector3 "0 0 0"
      slip1 ? real "0.0" x
      slip2 ? real "0.0" x
    bullet ?
      friction ? real >=0 "1"
      friction2 ? real >=0 "1"
      fdir1 ? vector3 "0 0 0"
      rolling_friction ? real "1"
  contact ?
    collide_without_contact ? flag "false" x
    collide_without_contact_bitmask ? count "1" x
    collide_bitmask ? count "65535"
    category_bitmask ? count "65535"
    poissons_ratio ? real "0.3" x
    elastic_modulus ? real "-1" x"; <kp> and <kd> define soft contacts"
    ode ?
      soft_cfm ? real "0" x"; <kp> and <kd> define soft contacts"
      soft_erp ? real "0.2" x"; <kp> and <kd> define soft contacts"
      kp ? real "1000000000000.0"
      kd ? real "1.0"
      max_vel ? real "0.01" x
      min_depth ? real "0" x
    bullet ?
      soft_cfm ? real "0" x"; <kp> and <kd> define soft contacts"
      soft_erp ? real "0.2" x"; <kp> and <kd> define soft contacts"
      kp ? real "1000000000000.0"
      kd ? real "1.0"
      split_impulse 1 flag "true" x
      split_impulse_penetration_threshold 1 real "-0.01" x
  soft_contact ? x
    dart ?
      bone_attachment 1 real "100.0"
      stiffness 1 real "100.0"
      damping 1 real "10.0"
      flesh_mass_fraction 1 real "0.05"
gripper * @name! text
  grasp_check ?
    detach_steps ? integer "40"
    attach_steps ? integer "20"
    min_contact_count ? count "2"
  gripper_link + text
  palm_link 1 text
projector ? @name! text
  texture 1 text
  fov ? real "0.785"
  near_clip ? real "0.1"
  far_clip ? real "10.0"
  visibility_flags ? count "4294967295"
  [pose] ?
  [plugin] *
battery * @name! text
  voltage 1 real "0.0"
audio_source *
  uri 1 text
  pitch ? real "1.0"
  gain ? real "1.0"
  contact ?
    collision + text
  loop ? flag "false"
  [pose] ?
audio_sink *
)";

}  // namespace cohort::parsing
