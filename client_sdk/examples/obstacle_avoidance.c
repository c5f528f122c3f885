// SPDX-License-Identifier: Apache-2.0

/* Obstacle avoidance in C, with the same arithmetic as obstacle_avoidance.cpp and so the same bits. */

#include <cohort/cohort.h>
#include <stdlib.h>

/* Weights of the four front sensors on each side, at 12, 36, 60 and 84 degrees from straight ahead. Obstacles beside
 * the robot have lower weights. */
static const double weights[] = {1.0, 0.8, 0.6, 0.3};
enum { ahead = sizeof weights / sizeof *weights, sensors = 15 };

static const double full_speed = 0.2;     /* speed of a track [m/s] */
static const double turning_speed = 0.1;  /* speed of a track when turning on the spot [m/s] */
static const double too_near = 0.5;       /* halfway between the edge of the sensors' range and contact */
static const double alignment_gain = 5.0; /* gain of the turret [1/s] */

typedef struct ObstacleAvoidance {
  CohortObservationChannel proximity[sensors];
  CohortObservationChannel turret_position;
  CohortCommandChannel turret_velocity;
  CohortCommandChannel left_track;
  CohortCommandChannel right_track;
} ObstacleAvoidance;

static void* create(void) { return calloc(1, sizeof(ObstacleAvoidance)); }

static int start(void* self, const CohortStart* start) {
  ObstacleAvoidance* robot = self;
  if (cohort_find_observations(start, "proximity/*/reading", robot->proximity, sensors) != sensors)
    return cohort_fail("expected the %d proximity sensors of an s-bot", sensors);
  robot->turret_position = cohort_find_observation(start, "turret/0/position");
  robot->turret_velocity = cohort_find_command(start, "turret/0/velocity");
  robot->left_track = cohort_find_command(start, "treel/left/velocity");
  robot->right_track = cohort_find_command(start, "treel/right/velocity");
  return 0;
}

static double greater(double a, double b) { return a < b ? b : a; }

static int step(void* self, const CohortObservation* observation, CohortCommand* command) {
  const ObstacleAvoidance* robot = self;
  /* Sensors are numbered counter-clockwise from the gripper: the first ones face left, the last ones face right. */
  double left = 0.0;
  double right = 0.0;
  for (int i = 0; i < ahead; ++i) {
    left = greater(left, weights[i] * cohort_read(observation, robot->proximity[i]));
    right = greater(right, weights[i] * cohort_read(observation, robot->proximity[sensors - 1 - i]));
  }

  if (greater(left, right) > too_near) {
    /* Turn on the spot, always in the same direction. A robot that chose the freer side would oscillate in a corner. */
    cohort_set(command, robot->left_track, -turning_speed);
    cohort_set(command, robot->right_track, turning_speed);
  } else {
    cohort_set(command, robot->left_track, full_speed * (1.0 - right));
    cohort_set(command, robot->right_track, full_speed * (1.0 - left));
  }
  /* The sensors are on the turret: keep it aligned with the tracks. */
  cohort_set(command, robot->turret_velocity, -alignment_gain * cohort_read(observation, robot->turret_position));
  return 0;
}

COHORT_C_STATELESS_CONTROLLER(ObstacleAvoidance, create, start, step, free)
