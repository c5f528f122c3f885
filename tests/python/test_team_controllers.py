# SPDX-License-Identifier: Apache-2.0

"""One controller in Python that drives all robots of a process together."""

import cohort
import numpy
import pytest
from obstacle_avoidance_in_python import ALIGNMENT_GAIN, FULL_SPEED, TOO_NEAR, TURNING_SPEED, WEIGHTS, ObstacleAvoidance


class Together(cohort.TeamController):
    """The same arithmetic as ObstacleAvoidance, for all robots at once."""

    def start(self, robots):
        first = robots[0]
        self.proximity = first.observations("proximity/*/reading", 15)
        self.turret_position = first.observation("turret/0/position")
        self.turret_velocity = first.command("turret/0/velocity")
        self.left_track = first.command("treel/left/velocity")
        self.right_track = first.command("treel/right/velocity")
        self.steps = 0

    def step(self, observations, commands):
        self.steps += 1
        near = observations[:, self.proximity]
        left = (near[:, :4] * WEIGHTS).max(axis=1).clip(min=0.0)
        right = (near[:, ::-1][:, :4] * WEIGHTS).max(axis=1).clip(min=0.0)
        turns = numpy.maximum(left, right) > TOO_NEAR
        commands[:, self.left_track] = numpy.where(turns, -TURNING_SPEED, FULL_SPEED * (1.0 - right))
        commands[:, self.right_track] = numpy.where(turns, TURNING_SPEED, FULL_SPEED * (1.0 - left))
        commands[:, self.turret_velocity] = -ALIGNMENT_GAIN * observations[:, self.turret_position]

    def save(self):
        return self.steps.to_bytes(8, "little")

    def load(self, state):
        self.steps = int.from_bytes(state, "little")


def test_it_gives_the_hash_of_a_controller_for_each_robot():
    alone = cohort.run("obstacle_avoidance", ObstacleAvoidance, duration=10)
    assert cohort.run("obstacle_avoidance", Together, duration=10).state_hash == alone.state_hash


def test_it_gives_the_same_hash_as_a_client(serve, domain):
    finish = serve("obstacle_avoidance", "--duration", "5")
    cohort.host(Together, domain=domain)
    assert finish().state_hash == cohort.run("obstacle_avoidance", ObstacleAvoidance, duration=5).state_hash


def test_it_is_called_for_the_robots_that_are_due():
    seen = []

    class Some(cohort.TeamController):
        def step(self, observations, commands):
            seen.append((self.tick, observations.shape, commands.shape, self.robots[0].name))

    experiment = cohort.Experiment(
        world=cohort._files.worlds_folder() / "arenas/obstacles.sdf",
        duration=0.04,
        teams=[
            {
                "name": "even",
                "robots": [f"explorers/sbot_{i}" for i in range(0, 16, 2)],
                "period": 2,
                "controller": Some,
            },
            {"name": "odd", "robots": [f"explorers/sbot_{i}" for i in range(1, 16, 2)], "controller": Some},
        ],
    )
    experiment.run()
    assert [each[0] for each in seen if each[3] == "explorers/sbot_0"] == [0, 2]
    assert [each[0] for each in seen if each[3] == "explorers/sbot_1"] == [0, 1, 2, 3]
    assert {each[1][0] for each in seen} == {8}


def test_an_exception_ends_the_run_with_its_line():
    class Fails(cohort.TeamController):
        def step(self, observations, commands):
            raise LookupError("no such thing")

    with pytest.raises(
        RuntimeError, match="the team controller 'Fails' failed in step at tick 0.*in step: LookupError"
    ):
        cohort.run("obstacle_avoidance", Fails, duration=1)


def test_a_command_that_is_not_finite_is_refused_by_channel():
    class Nan(cohort.TeamController):
        def step(self, observations, commands):
            commands[3] = numpy.nan

    with pytest.raises(RuntimeError, match="sbot_3.*treel/left/velocity"):
        cohort.run("obstacle_avoidance", Nan, duration=1)
