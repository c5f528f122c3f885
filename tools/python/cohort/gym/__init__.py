# SPDX-License-Identifier: Apache-2.0

"""Reinforcement learning environments for Gymnasium (`VectorEnv`, `Env`) and PettingZoo (`parallel_env`).

    import cohort, cohort.gym

    def reward(state):                       # [env]; state.observations is [env, robot, value]
        forward = state.commands_of("treel/*/velocity").mean(axis=(1, 2))
        return forward - state["proximity/*/reading"].max(axis=(1, 2))

    envs = cohort.gym.VectorEnv("obstacle_avoidance", num_envs=256, reward=reward, horizon=500,
                                observe=["proximity/*/reading"], act=["treel/*/velocity"])

Some tasks have an id: `gymnasium.make("cohort/ObstacleAvoidance-v0")`, after `import cohort.gym` or with an installed
package (`cohort.gym.tasks`).

Requires the package gymnasium; `parallel_env` also requires pettingzoo.
"""

from cohort.gym.environments import Env, VectorEnv
from cohort.gym.parallel import parallel_env
from cohort.gym.tasks import register
from cohort.gym.worlds import State

register()

__all__ = ["Env", "State", "VectorEnv", "parallel_env"]
