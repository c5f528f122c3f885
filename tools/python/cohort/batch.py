# SPDX-License-Identifier: Apache-2.0

"""Many worlds of one experiment in this process."""

from __future__ import annotations

import os

import numpy

from cohort import _native
from cohort.channels import Channels
from cohort.experiment import Experiment


class Batch:
    """Many worlds of one experiment, stepped together by C++ threads, for machine learning.

    Arrays are float64 in SI units and contiguous, and keep their address for the lifetime of the batch. Each world is
    bit-identical to a separate run of the experiment with the same seed, independent of the other worlds and of the
    number of threads. Rows of robots with fewer values are padded with zeros. The program commands all robots; a
    command takes effect at the next tick. Only one Python thread may use a batch at a time; steps release Python's
    global interpreter lock. A batch cannot be used after a fork.

    Args:
        experiment: an `Experiment`, or a file for `Experiment.read`.
        worlds: number of worlds.
        threads: number of threads that step the worlds.
    """

    STOPPED = 1  #: a stop condition of the experiment is met
    TIMED_OUT = 2  #: the duration of the experiment has passed
    QUARANTINED = 4  #: a robot has an invalid state or has left the world; the other robots continue
    FAILED = 8  #: `step` raised an error because of this world

    def __init__(self, experiment: Experiment | str | os.PathLike, worlds: int, threads: int = 1) -> None:
        if not isinstance(experiment, Experiment):
            experiment = Experiment.read(experiment)
        if worlds < 1 or threads < 1:
            raise ValueError(f"worlds is {worlds} and threads is {threads}, expected at least 1 of each")
        self.experiment = experiment
        self._native = _native.Batch(experiment._native, worlds, threads)
        #: Number of worlds.
        self.worlds = worlds
        #: Scoped names of the robots of each world.
        self.robots: list[str] = [self._native.robot_name(robot) for robot in range(self._native.robots)]
        #: Observations of the robots, an array [world, robot, value], read-only.
        self.observations: numpy.ndarray = self._native.observations
        #: Commands of the robots, an array [world, robot, value], writable. A reset sets them to their neutral values.
        self.commands: numpy.ndarray = self._native.commands
        #: Poses of the robots' root links in the world frame, x y z [m] and a quaternion w x y z: an array [world,
        #: robot, 7], read-only.
        self.poses: numpy.ndarray = self._native.poses
        #: Bits of STOPPED, TIMED_OUT, QUARANTINED and FAILED, an array [world] of uint8, read-only. A world with any
        #: bit except QUARANTINED is not stepped until it is reset.
        self.done: numpy.ndarray = self._native.done

    def observation_channels(self, robot: int = 0) -> Channels:
        """Returns the `Channels` of a robot's observation."""
        return Channels(self._native.observation_channels(robot))

    def command_channels(self, robot: int = 0) -> Channels:
        """Returns the `Channels` of a robot's command."""
        return Channels(self._native.command_channels(robot))

    def robot_model(self, robot: int) -> str:
        """Returns the name of a robot's model."""
        return self._native.robot_model(robot)

    def step(self, ticks: int = 1, only: numpy.ndarray | None = None) -> None:
        """Steps all worlds that have not ended.

        Args:
            ticks: number of ticks, at least 1. A world that ends earlier stops there.
            only: an array [world] of bool that selects worlds; the others stay unchanged.

        Raises ValueError if a command is invalid, before any world is stepped; the message names the world, the robot
        and the channel. Raises RuntimeError if a world fails, after all worlds have been stepped; the message names the
        first such world.
        """
        self._native.step(ticks, only)

    def reset(self, seeds: int | numpy.ndarray, only: numpy.ndarray | None = None) -> None:
        """Restarts worlds, each with its own seed, as if the experiment had been read with this seed. Reads no file.

        Args:
            seeds: an array [world] of integers from 0 to 2^64 - 1, or one seed for all worlds.
            only: an array [world] of bool that selects worlds; the others stay unchanged.
        """
        seeds = numpy.ascontiguousarray(numpy.broadcast_to(numpy.asarray(seeds, dtype=numpy.uint64), (self.worlds,)))
        if only is None:
            only = numpy.ones(self.worlds, dtype=bool)
        self._native.reset(only, seeds)

    def render(
        self,
        world: int = 0,
        width: int = 320,
        height: int = 240,
        position: tuple[float, float, float] | None = None,
        target: tuple[float, float, float] | None = None,
    ) -> numpy.ndarray:
        """Draws a world without a window, in a simple way: collision shapes in the colours of their links.

        Args:
            world: index of the world.
            width, height: size of the picture [pixel], from 1 to 4096.
            position, target: place of the camera and the point at which it looks, in the world frame [m]. By default,
                all static objects and the robots' initial places are in the picture.

        Returns an array [row, column, 3] of uint8: red, green and blue.
        """
        return self._native.render(world, width, height, position, target)

    def tick(self, world: int) -> int:
        """Returns the tick of a world."""
        return self._native.tick(world)

    def state_hash(self, world: int) -> int:
        """Returns the state hash of a world, which is the same as in a separate run."""
        return self._native.state_hash(world)
