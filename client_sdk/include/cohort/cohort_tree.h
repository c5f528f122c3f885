// SPDX-License-Identifier: Apache-2.0
#ifndef COHORT_COHORT_TREE_H
#define COHORT_COHORT_TREE_H

#include <cohort/cohort.h>

/* The links, joints and sensors of a robot for controllers, in C99 (C++ can also include it). It is the C equivalent of
 * <cohort/kinematic_tree.hpp>.
 *
 *   CohortJoint joint;
 *   for (size_t i = 0; cohort_joint(start, i, &joint); ++i) printf("%s\n", joint.name);
 *
 * The tree is empty if the server supports only version 1.3 of the protocol or older ones. Each function fills in the
 * entry with this index, counted from 0. It returns false if there is no such entry, which is not an error. Strings are
 * valid as long as the CohortStart. */

#ifdef __cplusplus
extern "C" {
#endif

/* The pose of a frame B in a frame A: the position of B's origin in A, and the rotation from B to A. */
typedef struct CohortFramePose {
  double position[3];    /* x y z [m] */
  double orientation[4]; /* quaternion x y z w, of length 1 */
} CohortFramePose;

typedef struct CohortLink {
  const char* name;
  double mass;              /* [kg] */
  double center_of_mass[3]; /* in the link's frame [m] */
} CohortLink;

typedef enum CohortJointType {
  cohort_joint_fixed,
  cohort_joint_revolute,
  cohort_joint_prismatic,
  cohort_joint_ball,
  cohort_joint_universal,
  cohort_joint_screw
} CohortJointType;

/* One direction in which a joint turns [rad] or slides [m]. Limits that do not exist are infinite. */
typedef struct CohortAxis {
  double direction[3]; /* unit vector in the joint's frame */
  double lower;        /* lowest position */
  double upper;        /* highest position */
  double max_velocity; /* limit for motors [rad/s] or [m/s] */
  double max_effort;   /* limit for motors [N m] or [N] */
} CohortAxis;

#define COHORT_WORLD 0xffffffffu /* the parent of a link that is attached to the world */

/* At joint position q, the pose of the child link in the parent link is pose * frame * motion(q) * inverse(frame). */
typedef struct CohortJoint {
  const char* name;
  CohortJointType type;
  uint32_t parent;       /* index of a link, or COHORT_WORLD */
  uint32_t child;        /* index of a link */
  CohortFramePose pose;  /* pose of the child link in the parent link, at joint position 0 */
  CohortFramePose frame; /* pose of the joint's frame in the child link */
  size_t axis_count;     /* 0 for fixed and ball joints, 2 for universal joints, otherwise 1 */
  CohortAxis axes[2];
  double thread_pitch; /* for screw joints: travel along the axis per turn [m]; negative if left-handed */
} CohortJoint;

typedef struct CohortSensor {
  const char* name;     /* as in the names of its channels */
  uint32_t link;        /* index of the link */
  CohortFramePose pose; /* pose of the sensor's frame in the link */
} CohortSensor;

bool cohort_link(const CohortStart* start, size_t index, CohortLink* link);
bool cohort_joint(const CohortStart* start, size_t index, CohortJoint* joint);
bool cohort_sensor(const CohortStart* start, size_t index, CohortSensor* sensor);
/* Returns the name of an encoder, motor or drive of a joint, or NULL after the last one. An encoder `wheel` measures
 * the joint's position in the observation channel `wheel/0/position`. */
const char* cohort_joint_device(const CohortStart* start, size_t joint, size_t index);

#ifdef __cplusplus
}
#endif

#endif
