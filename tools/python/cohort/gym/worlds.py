# SPDX-License-Identifier: Apache-2.0

"""Common parts of the environments: worlds, observed and commanded channels, rewards and seeds."""

import numpy

from cohort.batch import Batch
from cohort.experiment import Experiment


class State:
    """The argument of `reward` and `done`: the state of all worlds after a step.

    Attributes:
        observations: [env, robot, value], observations of all channels, not only the observed ones; read-only.
        commands: [env, robot, value], commands of the step.
        poses: [env, robot, 7], x y z [m] and a quaternion w x y z in the world frame; read-only.
        last_poses: [env, robot, 7], poses before the step.
        steps: [env], number of steps in the episode so far, including this one.
        seconds: simulated time of a step [s].
    """

    def __init__(self, batch, rows, seconds):
        self._observation_channels = batch.observation_channels(rows.start)
        self._command_channels = batch.command_channels(rows.start)
        self._places = {}
        # Views, which show the new values after each step.
        self.observations = batch.observations[:, rows]
        self.commands = batch.commands[:, rows]
        self.poses = batch.poses[:, rows]
        self.last_poses = self.poses.copy()
        self.steps = numpy.zeros(batch.worlds, dtype=numpy.int64)
        self.seconds = seconds

    def __getitem__(self, pattern):
        """Returns the observations of the channels that match a pattern: an array [env, robot, value]."""
        places = self._places.get(pattern)
        if places is None:
            places = self._places[pattern] = self._observation_channels.indices(pattern)
        return self.observations[:, :, places]

    def commands_of(self, pattern):
        """Returns the commands of the channels that match a pattern: an array [env, robot, value]."""
        places = self._places.get((pattern,))
        if places is None:
            places = self._places[(pattern,)] = self._command_channels.indices(pattern)
        return self.commands[:, :, places]


def _places(channels, patterns):
    """Returns the indices of the values of all channels that match one of the patterns; a slice if they are
    consecutive.
    """
    numbers = numpy.arange(channels.size)
    if patterns is not None:
        if isinstance(patterns, str):
            patterns = [patterns]
        numbers = numpy.concatenate([numbers[channels.indices(pattern)].ravel() for pattern in patterns])
    if len(numbers) == 0:
        raise ValueError("`observe` and `act` must each match at least one channel")
    if (numpy.diff(numbers) == 1).all():
        return slice(int(numbers[0]), int(numbers[-1]) + 1)
    return numbers


def _seeds_of_episode(seeds, episodes):
    """Returns `seeds` for episode 0, and distinct seeds for other episodes (SplitMix64, Steele et al., 2014)."""
    with numpy.errstate(over="ignore"):
        mixed = seeds + episodes * numpy.uint64(0x9E3779B97F4A7C15)
        mixed = (mixed ^ (mixed >> numpy.uint64(30))) * numpy.uint64(0xBF58476D1CE4E5B9)
        mixed = (mixed ^ (mixed >> numpy.uint64(27))) * numpy.uint64(0x94D049BB133111EB)
        mixed ^= mixed >> numpy.uint64(31)
    return numpy.where(episodes == 0, seeds, mixed)


class Worlds:
    """A batch of worlds for environments. All participating robots have the same channels."""

    def __init__(
        self,
        experiment,
        count,
        *,
        reward,
        done=None,
        horizon=None,
        observe=None,
        act=None,
        robots=None,
        ticks_per_step=1,
        threads=1,
        dtype=numpy.float32,
    ):
        if not isinstance(experiment, Experiment):
            # `done` and `horizon` end episodes; so does the duration of the experiment.
            experiment = Experiment.read(experiment)
        if ticks_per_step < 1 or (horizon is not None and horizon < 1):
            raise ValueError(
                f"ticks_per_step is {ticks_per_step} and horizon is {horizon}, expected at least 1 of each"
            )
        self.batch = Batch(experiment, count, threads)
        self.robots = self._chosen(robots)
        self.names = [self.batch.robots[robot] for robot in self.robots]
        if self.robots != list(range(self.robots[0], self.robots[-1] + 1)):
            raise ValueError(
                f"the ids of the robots {self.names} are not consecutive; choose robots with consecutive ids"
            )
        rows = slice(self.robots[0], self.robots[-1] + 1)
        if len({self.batch.robot_model(robot) for robot in self.robots}) != 1:
            raise ValueError(
                "robots of different models have different channels; select the robots of one model with `robots`"
            )
        observed, commanded = (
            self.batch.observation_channels(self.robots[0]),
            self.batch.command_channels(self.robots[0]),
        )
        observation_places, command_places = _places(observed, observe), _places(commanded, act)
        self.observation_bounds = observed.lower[observation_places], observed.upper[observation_places]
        self.command_bounds = commanded.lower[command_places], commanded.upper[command_places]
        self._observation_places = observation_places
        self._command_places = command_places
        self.steps_per_second = 1.0 / (ticks_per_step * experiment.step)
        self.dtype = numpy.dtype(dtype)
        self.state = State(self.batch, rows, ticks_per_step * experiment.step)
        self._reward, self._done, self._horizon = reward, done, horizon
        self._ticks = ticks_per_step
        self._seeds = numpy.zeros(count, dtype=numpy.uint64)
        self._episodes = numpy.zeros(count, dtype=numpy.uint64)

    def _chosen(self, robots):
        names = self.batch.robots
        if robots is None:
            chosen = list(range(len(names)))
        else:
            chosen = sorted(
                {place for each in ([robots] if isinstance(robots, str) else robots) for place in self._matching(each)}
            )
        if not chosen:
            raise ValueError("the experiment has no robots")
        return chosen

    def _matching(self, pattern):
        prefix, star, suffix = pattern.partition("*")
        found = [
            place
            for place, name in enumerate(self.batch.robots)
            if (
                name == pattern
                if not star
                else name.startswith(prefix) and name.endswith(suffix) and len(name) >= len(prefix + suffix)
            )
        ]
        if not found:
            raise ValueError(f"no robot matches '{pattern}', expected some of {self.batch.robots}")
        return found

    def seed(self, seeds, which):
        """Sets the seeds of the worlds `which`. The next episode of each uses this seed itself."""
        self._seeds[which] = seeds[which]
        self._episodes[which] = 0

    def reset(self, which):
        """Starts the next episode of the worlds `which`, an array [env] of bool."""
        self.batch.reset(_seeds_of_episode(self._seeds, self._episodes), which)
        self._episodes[which] += numpy.uint64(1)
        self.state.steps[which] = 0
        self.state.last_poses[which] = self.state.poses[which]

    def step(self, actions, which=None):
        """Steps worlds with actions [env, robot, value].

        Returns rewards, terminations and truncations. Updates `state`.
        """
        lower, upper = self.command_bounds
        if not numpy.isfinite(actions).all():
            env, robot, value = (int(each[0]) for each in numpy.nonzero(~numpy.isfinite(actions)))
            raise ValueError(f"the action of environment {env}, robot {self.names[robot]}, value {value} is not finite")
        state = self.state
        if isinstance(self._command_places, slice):  # without a copy
            numpy.clip(actions, lower, upper, out=state.commands[:, :, self._command_places])
        else:
            state.commands[:, :, self._command_places] = numpy.clip(actions, lower, upper)
        numpy.copyto(state.last_poses, state.poses)
        self.batch.step(self._ticks, which)
        state.steps += 1 if which is None else which
        done = self.batch.done
        terminations = (done & (Batch.STOPPED | Batch.QUARANTINED)) != 0
        if self._done is not None:
            terminations |= self._per_env(self._done(state), "done").astype(bool)
        truncations = (done & Batch.TIMED_OUT) != 0
        if self._horizon is not None:
            truncations |= state.steps >= self._horizon
        return self._reward(state), terminations, truncations

    def _per_env(self, values, name):
        values = numpy.asarray(values)
        if values.size == self.batch.worlds == 1:
            values = values.reshape(1)
        if values.shape != (self.batch.worlds,):
            raise ValueError(f"{name}(state) returned shape {values.shape}, expected {(self.batch.worlds,)}")
        return values

    def rewards_per_env(self, rewards):
        """Returns rewards as an array [env] of float64. Raises ValueError if they have another shape or contain NaN."""
        rewards = self._per_env(rewards, "reward").astype(numpy.float64)
        if numpy.isnan(rewards).any():
            raise ValueError(f"reward(state) is NaN for environment {int(numpy.argmax(numpy.isnan(rewards)))}")
        return rewards

    def observations(self):
        """Returns the values of the observed channels of all worlds: a new array [env, robot, value]."""
        return self.state.observations[:, :, self._observation_places].astype(self.dtype)
