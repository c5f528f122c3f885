# SPDX-License-Identifier: Apache-2.0

"""The controller of client_sdk/examples/obstacle_avoidance.cpp, operation for operation."""

import cohort

WEIGHTS = (1.0, 0.8, 0.6, 0.3)
FULL_SPEED = 0.2  # of a track [m/s]
TURNING_SPEED = 0.1
TOO_NEAR = 0.5
ALIGNMENT_GAIN = 5.0  # of the turret [1/s]


class ObstacleAvoidance(cohort.Controller):
    def start(self, start):
        self.proximity = start.observations("proximity/*/reading", 15)
        self.turret_position = start.observation("turret/0/position")
        self.turret_velocity = start.command("turret/0/velocity")
        self.left_track = start.command("treel/left/velocity")
        self.right_track = start.command("treel/right/velocity")

    def step(self, observation, command):
        near = observation[self.proximity]
        left = max(0.0, *(weight * near[i] for i, weight in enumerate(WEIGHTS)))
        right = max(0.0, *(weight * near[14 - i] for i, weight in enumerate(WEIGHTS)))
        if max(left, right) > TOO_NEAR:
            command[self.left_track] = -TURNING_SPEED
            command[self.right_track] = TURNING_SPEED
        else:
            command[self.left_track] = FULL_SPEED * (1.0 - right)
            command[self.right_track] = FULL_SPEED * (1.0 - left)
        command[self.turret_velocity] = -ALIGNMENT_GAIN * observation[self.turret_position]

    def save(self):
        return b""


if __name__ == "__main__":
    cohort.main(ObstacleAvoidance)
