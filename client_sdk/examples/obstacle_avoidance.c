/* The obstacle avoidance of obstacle_avoidance.cpp in C: the same arithmetic, so the same bits. */

#include <cohort/cohort.h>
#include <stdlib.h>

/* Of the four sensors on each side that look ahead, at 12, 36, 60 and 84 degrees from straight ahead: what is beside
 * the robot matters less than what is in its way. */
static const double weights[] = {1.0, 0.8, 0.6, 0.3};
enum { ahead = sizeof weights / sizeof *weights, sensors = 15 };

static const double full_speed = 0.2;     /* of a track [m/s] */
static const double turning_speed = 0.1;  /* of a track when turning on the spot [m/s] */
static const double too_near = 0.5;       /* halfway between the edge of what the sensors see and touching */
static const double alignment_gain = 5.0; /* of the turret [1/s] */

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
    return cohort_fail("this controller wants the %d proximity sensors of an s-bot", sensors);
  robot->turret_position = cohort_find_observation(start, "turret/0/position");
  robot->turret_velocity = cohort_find_command(start, "turret/0/velocity");
  robot->left_track = cohort_find_command(start, "treel/left/velocity");
  robot->right_track = cohort_find_command(start, "treel/right/velocity");
  return 0;
}

static double greater(double a, double b) { return a < b ? b : a; }

static int step(void* self, const CohortObservation* observation, CohortCommand* command) {
  const ObstacleAvoidance* robot = self;
  /* Sensors are numbered counter-clockwise from the gripper: the first ones look to the left, the last to the right. */
  double left = 0.0;
  double right = 0.0;
  for (int i = 0; i < ahead; ++i) {
    left = greater(left, weights[i] * cohort_read(observation, robot->proximity[i]));
    right = greater(right, weights[i] * cohort_read(observation, robot->proximity[sensors - 1 - i]));
  }

  if (greater(left, right) > too_near) {
    /* On the spot, and always the same way: one that chose the freer side would swing to and fro in a corner for
     * ever. */
    cohort_set(command, robot->left_track, -turning_speed);
    cohort_set(command, robot->right_track, turning_speed);
  } else {
    cohort_set(command, robot->left_track, full_speed * (1.0 - right));
    cohort_set(command, robot->right_track, full_speed * (1.0 - left));
  }
  /* The sensors are on the turret: keep it looking where the tracks go. */
  cohort_set(command, robot->turret_velocity, -alignment_gain * cohort_read(observation, robot->turret_position));
  return 0;
}

/* It remembers nothing. */
static int save(const void* self, CohortStateWriter* state) {
  (void)self, (void)state;
  return 0;
}

COHORT_C_CONTROLLER_WITH_MEMORY(ObstacleAvoidance, create, start, step, free, save, NULL)
