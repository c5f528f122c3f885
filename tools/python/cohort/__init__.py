# SPDX-License-Identifier: Apache-2.0

"""Cohort: a bit-reproducible simulator for groups of robots, in lockstep with their controllers.

    import cohort

    cohort.examples()                                  # names of the bundled experiments
    cohort.run("obstacle_avoidance").state_hash        # runs one of them to its end

    simulation = cohort.Simulation("obstacle_avoidance", seed=1)
    simulation.commands[:] = ...                       # [robot, value], SI units
    simulation.step(100)
    simulation.observations, simulation.poses          # arrays

    class Wanderer(cohort.Controller): ...             # drives one robot: help(cohort.Controller)
    cohort.run("obstacle_avoidance", Wanderer)

    recording = cohort.Recording("run.mcap")           # from cohort.run(..., record="run.mcap")
    recording.poses, recording.observations            # xarray arrays
    recording.table("events")                          # pandas table
    print(cohort.compare("run.mcap", "other.mcap"))    # where two runs differ

    cohort.gym.VectorEnv(...)                          # many worlds at once, for learning: help(cohort.gym)

The values of an observation or a command are in the order of its channels, which have names, units and bounds
(`Robot.observation_channels`). A pose is x y z [m] and a quaternion w x y z in the world frame, which has z up. Results
are bit-identical to those of `cohort run`. `cohort.math` has sin, exp and similar functions with these bits.
"""

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
