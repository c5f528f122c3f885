# SPDX-License-Identifier: Apache-2.0

"""Environments for Gymnasium."""

import gymnasium
import numpy
from gymnasium.vector import AutoresetMode

from cohort.gym.worlds import Worlds


def _box(bounds, shape, dtype):
    lower, upper = (numpy.broadcast_to(each, shape).ravel().astype(dtype) for each in bounds)
    return gymnasium.spaces.Box(lower, upper, dtype=dtype)


class VectorEnv(gymnasium.utils.EzPickle, gymnasium.vector.VectorEnv):
    """Many worlds of one experiment as a `gymnasium.vector.VectorEnv`. Worlds are stepped in C++.

    In each world, one agent observes and commands all selected robots. Observations and actions are arrays [env,
    robots * values], and their spaces have the bounds of the channels. The same seeds give the same trajectories,
    regardless of the number of threads and environments. After `reset(seed=s)`, the first episode of environment i is
    the experiment with seed s + i.

    Args:
        experiment: an `Experiment`, or a file for `Experiment.read`.
        num_envs: number of worlds.
        reward: function that is called after each step with a `State` and returns an array [env].
        done: function that is called after each step with a `State` and returns an array [env] of bool, True to
            terminate the episode. An episode also terminates if a stop condition of the experiment is met, or if a
            robot has an invalid state.
        horizon: number of steps after which an episode is truncated. An episode is also truncated at the end of the
            experiment's duration.
        observe, act: patterns of channel names, such as `["proximity/*/reading"]`; by default all channels.
        robots: names or patterns of robots with consecutive ids; by default all. Other robots keep neutral commands.
        ticks_per_step: number of ticks per step.
        threads: number of threads that step the worlds.
        autoreset_mode: a `gymnasium.vector.AutoresetMode`.
        dtype: type of observations and actions.
        render_mode: "rgb_array" if `render` is called.
    """

    render_modes = ["rgb_array"]

    def __init__(
        self,
        experiment,
        num_envs,
        *,
        reward,
        done=None,
        horizon=None,
        observe=None,
        act=None,
        robots=None,
        ticks_per_step=1,
        threads=1,
        autoreset_mode=AutoresetMode.NEXT_STEP,
        dtype=numpy.float32,
        render_mode=None,
    ):
        arguments = {
            "reward": reward,
            "done": done,
            "horizon": horizon,
            "observe": observe,
            "act": act,
            "robots": robots,
            "ticks_per_step": ticks_per_step,
            "threads": threads,
            "dtype": dtype,
        }
        # A pickled or copied environment is made from the same arguments, and begins with a reset.
        gymnasium.utils.EzPickle.__init__(
            self, experiment, num_envs, autoreset_mode=autoreset_mode, render_mode=render_mode, **arguments
        )
        if render_mode not in (None, *self.render_modes):
            raise ValueError(f"render_mode is {render_mode!r}, expected None or one of {self.render_modes}")
        self.render_mode = render_mode
        self.worlds = Worlds(experiment, num_envs, **arguments)
        self.num_envs = num_envs
        self._autoreset_mode = AutoresetMode(autoreset_mode)
        self.metadata = {
            "autoreset_mode": self._autoreset_mode,
            "render_modes": self.render_modes,
            "render_fps": self.worlds.steps_per_second,
        }
        robot_count = len(self.worlds.robots)
        self._action_shape = (num_envs, robot_count, len(self.worlds.command_bounds[0]))
        shape_of = lambda bounds: (robot_count, len(bounds[0]))
        self.single_observation_space = _box(
            self.worlds.observation_bounds, shape_of(self.worlds.observation_bounds), self.worlds.dtype
        )
        self.single_action_space = _box(
            self.worlds.command_bounds, shape_of(self.worlds.command_bounds), self.worlds.dtype
        )
        self.observation_space = gymnasium.vector.utils.batch_space(self.single_observation_space, num_envs)
        self.action_space = gymnasium.vector.utils.batch_space(self.single_action_space, num_envs)
        self._to_reset = numpy.zeros(num_envs, dtype=bool)
        self._is_seeded = False

    def reset(self, *, seed=None, options=None):
        """Starts the next episodes.

        Args:
            seed: an int, so that environment i gets seed + i, or a list with one seed per environment. By default, the
                seeds are derived from those of the previous episodes.
            options: `{"reset_mask": array [env] of bool}` selects the environments to reset.
        """
        which = numpy.ones(self.num_envs, dtype=bool)
        if options is not None and "reset_mask" in options:
            which = self._checked_mask(options["reset_mask"])
        if isinstance(seed, (int, numpy.integer)):
            super().reset(seed=int(seed))
            self._seed([int(seed) + env for env in range(self.num_envs)], which)
        elif seed is not None:
            self._seed(seed, which)
        elif not self._is_seeded:
            self._seed([None] * self.num_envs, numpy.ones(self.num_envs, dtype=bool))
        self.worlds.reset(which)
        self._to_reset[which] = False
        return self._observations(), {}

    def _checked_mask(self, mask):
        if not isinstance(mask, numpy.ndarray) or mask.dtype != numpy.bool_:
            raise TypeError(f"options['reset_mask'] is a {type(mask).__name__}, expected a numpy array of bool")
        if mask.shape != (self.num_envs,) or not mask.any():
            raise ValueError(
                f"options['reset_mask'] has shape {mask.shape}, expected {(self.num_envs,)} with at least one True"
            )
        return mask

    def _seed(self, seeds, which):
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed has {len(seeds)} values, expected {self.num_envs}")
        drawn = [self.np_random.integers(1 << 63) if each is None else each for each in seeds]
        self.worlds.seed(numpy.array(drawn, dtype=numpy.uint64), which)
        self._is_seeded = True

    def step(self, actions):
        """Steps all environments with actions [env, robots * values], which are clamped to their bounds."""
        actions = numpy.asarray(actions)
        if actions.shape != self.action_space.shape:
            raise ValueError(f"actions has shape {actions.shape}, expected {self.action_space.shape}")
        actions = actions.reshape(self._action_shape)
        next_step = self._autoreset_mode == AutoresetMode.NEXT_STEP
        begins = self._to_reset if next_step and self._to_reset.any() else None
        rewards, terminations, truncations = self.worlds.step(actions, None if begins is None else ~begins)
        rewards = self.worlds.rewards_per_env(rewards)
        if begins is not None:
            self.worlds.reset(begins)
            rewards[begins] = 0.0
            terminations[begins] = truncations[begins] = False
        ended = terminations | truncations
        infos = {}
        observations = self._observations()
        if next_step:
            self._to_reset = ended
        elif self._autoreset_mode == AutoresetMode.SAME_STEP and ended.any():
            final = numpy.full(self.num_envs, None, dtype=object)
            for env in numpy.flatnonzero(ended):
                final[env] = observations[env]
            infos = {"final_obs": final, "_final_obs": ended.copy(), "final_info": {}, "_final_info": ended.copy()}
            self.worlds.reset(ended)
            observations = self._observations()
        return observations, rewards, terminations, truncations, infos

    def _observations(self):
        return self.worlds.observations().reshape(self.num_envs, -1)

    def render(self):
        """Returns a tuple of pictures [row, column, 3] of uint8, one of each world, drawn by `cohort.Batch.render`."""
        if self.render_mode is None:
            return None
        return tuple(self.worlds.batch.render(world) for world in range(self.num_envs))


class Env(gymnasium.utils.EzPickle, gymnasium.Env):
    """One world as a `gymnasium.Env`: one agent observes and commands all selected robots.

    Its arguments are those of `VectorEnv`. `reward` and `done` may also return a single value.
    """

    metadata = {"render_modes": VectorEnv.render_modes, "render_fps": 30}

    def __init__(self, experiment, *, autoreset_mode=AutoresetMode.DISABLED, **arguments):
        gymnasium.utils.EzPickle.__init__(self, experiment, autoreset_mode=autoreset_mode, **arguments)
        self._envs = VectorEnv(experiment, 1, autoreset_mode=autoreset_mode, **arguments)
        self.render_mode = self._envs.render_mode
        self.metadata = self.metadata | {"render_fps": self._envs.worlds.steps_per_second}
        self.observation_space = self._envs.single_observation_space
        self.action_space = self._envs.single_action_space

    def reset(self, *, seed=None, options=None):
        """Starts the next episode, as the experiment with `seed` if one is given."""
        super().reset(seed=seed)
        observations, _ = self._envs.reset(seed=seed)
        return observations[0], {}

    def step(self, action):
        """Steps the world with an action, an array [robots * values]."""
        observations, rewards, terminations, truncations, _ = self._envs.step(numpy.asarray(action)[None])
        return observations[0], float(rewards[0]), bool(terminations[0]), bool(truncations[0]), {}

    def render(self):
        """Returns a picture [row, column, 3] of uint8, drawn by `cohort.Batch.render`; None without a render mode."""
        pictures = self._envs.render()
        return None if pictures is None else pictures[0]
