"""Cohort: a simulator for groups of robots, bit-reproducible and in lockstep with its controllers.

    import cohort

    cohort.examples()                                  # experiments that come with it
    cohort.run("obstacle_avoidance").state_hash        # one of them, to its end

    simulation = cohort.Simulation("obstacle_avoidance", seed=1)
    simulation.commands[:] = ...                       # [robot, value], SI units
    simulation.step(100)
    simulation.observations, simulation.poses          # arrays

    class Wanderer(cohort.Controller): ...             # drives one robot: help(cohort.Controller)
    cohort.run("obstacle_avoidance", Wanderer)

    recording = cohort.Recording("run.mcap")           # of cohort.run(..., record="run.mcap")
    recording.poses, recording.observations            # arrays of xarray
    recording.table("events")                          # of pandas
    print(cohort.compare("run.mcap", "other.mcap"))    # where two runs part

    cohort.gym.VectorEnv(...)                          # many worlds at once, for learning: help(cohort.gym)

The order of values is that of channels, which have names, units and bounds (`Robot.observation_channels`). Poses are
x y z [m] and a quaternion w x y z in the world frame, which has z up. Runs have the same bits as those of `cohort run`.
To that end `math.sin`, `math.exp` and their like are functions of Cohort once this package is imported; they are within
2 units of the last place of the C library's.
"""

import numpy  # its functions are bound to portable ones too, so it has to be there first

from cohort import _native, math
from cohort._files import examples
from cohort._native import InputError, SnapshotError
from cohort.batch import Batch
from cohort.channels import Channel, ChannelError, Channels
from cohort.client import ClientError, host, main
from cohort.controller import Controller, ParameterError, Parameters, Start, TeamController
from cohort.experiment import Experiment, Result, Team, run, run_seeds
from cohort.findings import Comparison, Difference, Verification
from cohort.recording import Recording, RecordingError, World, compare
from cohort.simulation import Robot, Simulation
from cohort.view import View

__version__ = _native.version
del numpy

__all__ = [
    "Batch",
    "Channel",
    "ChannelError",
    "Channels",
    "ClientError",
    "Comparison",
    "Controller",
    "Difference",
    "Experiment",
    "InputError",
    "ParameterError",
    "Parameters",
    "Recording",
    "RecordingError",
    "Result",
    "Robot",
    "Simulation",
    "SnapshotError",
    "Start",
    "Team",
    "TeamController",
    "Verification",
    "View",
    "World",
    "compare",
    "examples",
    "host",
    "main",
    "math",
    "run",
    "run_seeds",
]
