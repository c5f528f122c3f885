# SPDX-License-Identifier: Apache-2.0

"""Environments for PettingZoo."""

import functools

import numpy

from cohort.gym.environments import _box
from cohort.gym.worlds import Worlds


def parallel_env(experiment, *, done=None, **arguments):
    """Returns one world as a `pettingzoo.ParallelEnv`: each robot is an agent with its scoped name.

    The arguments are those of `VectorEnv`, except `num_envs` and `autoreset_mode`. `reward` and `done` return an array
    [1, robot] or [robot], or one value for all robots.
    """
    import pettingzoo

    class ParallelEnv(pettingzoo.ParallelEnv):
        metadata = {"name": "cohort", "render_modes": []}

        def __init__(self):
            self._worlds = Worlds(experiment, 1, **arguments)
            self._done = done
            self.possible_agents = list(self._worlds.names)
            self.agents = []
            observed, commanded = self._worlds.observation_bounds, self._worlds.command_bounds
            dtype = self._worlds.dtype
            self._observation_spaces = {
                agent: _box(observed, observed[0].shape, dtype) for agent in self.possible_agents
            }
            self._action_spaces = {agent: _box(commanded, commanded[0].shape, dtype) for agent in self.possible_agents}
            self._is_seeded = False

        def __reduce__(self):
            return functools.partial(parallel_env, experiment, done=done, **arguments), ()

        def observation_space(self, agent):
            return self._observation_spaces[agent]

        def action_space(self, agent):
            return self._action_spaces[agent]

        def reset(self, seed=None, options=None):
            if seed is not None or not self._is_seeded:
                chosen = numpy.random.default_rng().integers(1 << 63) if seed is None else seed
                self._worlds.seed(numpy.array([chosen], dtype=numpy.uint64), [True])
                self._is_seeded = True
            self._worlds.reset(numpy.array([True]))
            self.agents = list(self.possible_agents)
            return self._by_agent(self._worlds.observations()[0]), {agent: {} for agent in self.agents}

        def step(self, actions):
            missing = set(self.agents) - set(actions)
            if missing:
                raise ValueError(f"no action given for {sorted(missing)[0]}, expected one for each of {self.agents}")
            together = numpy.stack([actions[agent] for agent in self.possible_agents])[None]
            rewards, terminations, truncations = self._worlds.step(together)
            agents = self.agents
            rewards = dict(zip(agents, map(float, self._per_robot(rewards, "reward"))))
            ends = numpy.full(len(agents), bool(terminations[0]))
            if self._done is not None:
                ends |= self._per_robot(self._done(self._worlds.state), "done").astype(bool)
            # All agents end together, because a world continues with all of its robots.
            ends[:] = ends.any()
            observations = self._by_agent(self._worlds.observations()[0])
            terminated = dict(zip(agents, map(bool, ends)))
            truncated = {agent: bool(truncations[0]) for agent in agents}
            if ends.any() or truncations[0]:
                self.agents = []
            return observations, rewards, terminated, truncated, {agent: {} for agent in agents}

        def state(self):
            return self._worlds.observations().ravel()

        def _by_agent(self, rows):
            return dict(zip(self.possible_agents, rows))

        def _per_robot(self, values, name):
            values = numpy.asarray(values)
            robots = len(self.possible_agents)
            if values.size not in (1, robots):
                raise ValueError(
                    f"{name}(state) returned shape {values.shape}, expected one value for each of {robots} robots"
                )
            return numpy.broadcast_to(values.ravel(), robots)

    return ParallelEnv()
