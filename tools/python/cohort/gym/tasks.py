# SPDX-License-Identifier: Apache-2.0

"""Tasks with an id for `gymnasium.make` and `gymnasium.make_vec`, such as `cohort/ObstacleAvoidance-v0`."""

import gymnasium
import numpy


def _progress_without_obstacles(state):
    """The mean forward velocity of the tracks [m/s], minus the largest proximity reading of any robot [1]."""
    forward = state.commands_of("treel/*/velocity").mean(axis=(1, 2))
    return forward - state["proximity/*/reading"].max(axis=(1, 2))


def _closeness(state):
    """Minus the mean distance of the robots from their centre [m]."""
    places = state.poses[:, :, :2]
    centres = places.mean(axis=1, keepdims=True)
    return -numpy.linalg.norm(places - centres, axis=2).mean(axis=1)


_TASKS = {
    "cohort/ObstacleAvoidance-v0": {
        "experiment": "obstacle_avoidance",
        "reward": _progress_without_obstacles,
        "observe": ["proximity/*/reading"],
    },
    "cohort/Aggregation-v0": {"experiment": "aggregation", "reward": _closeness},
}


def register():
    """Registers the tasks with Gymnasium, unless they are registered."""
    for name, task in _TASKS.items():
        if name not in gymnasium.registry:
            gymnasium.register(
                id=name,
                entry_point="cohort.gym:Env",
                vector_entry_point="cohort.gym:VectorEnv",
                kwargs={"act": ["treel/*/velocity"], "horizon": 200, "ticks_per_step": 10} | task,
            )
