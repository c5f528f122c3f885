# SPDX-License-Identifier: Apache-2.0

"""The kinematic tree of a robot: its links, the joints between them, and where its sensors are.

Links and joints are those of the model file, without joints that close loops. Values are in SI units. A pose of a frame
in another frame is a tuple of x y z [m] and a quaternion w x y z.
"""

from __future__ import annotations

import dataclasses
from typing import Any

Vector = tuple[float, float, float]
Pose = tuple[float, float, float, float, float, float, float]

JOINT_TYPES = ("fixed", "revolute", "prismatic", "ball", "universal", "screw")


@dataclasses.dataclass(frozen=True)
class Link:
    """A rigid body.

    Attributes:
        name: name in the model.
        mass: mass [kg].
        center_of_mass: its centre of mass in the link's frame [m].
    """

    name: str
    mass: float
    center_of_mass: Vector


@dataclasses.dataclass(frozen=True)
class Axis:
    """One direction in which a joint turns [rad] or slides [m]. Limits that do not exist are infinite.

    Attributes:
        direction: unit vector in the joint's frame.
        lower, upper: limits of the position.
        max_velocity: limit for motors [rad/s] or [m/s].
        max_effort: limit for motors [N m] or [N].
    """

    direction: Vector
    lower: float
    upper: float
    max_velocity: float
    max_effort: float


@dataclasses.dataclass(frozen=True)
class Joint:
    """A joint between two links, or between the world and a link.

    At joint position q, the pose of the child link in the parent link is `pose` * `frame` * motion(q) * inverse of
    `frame`.

    Attributes:
        name: name in the model.
        type: one of `JOINT_TYPES`, as in SDF.
        parent: index of a link, or None for the world.
        child: index of a link, which has no other parent.
        pose: pose of the child link in the parent link, at joint position 0.
        frame: pose of the joint's frame in the child link.
        axes: none for fixed and ball joints, two for universal joints, otherwise one.
        thread_pitch: for screw joints: travel along the axis per turn [m]; negative if left-handed.
        devices: names of the encoders, motors and drives that measure or move it. An encoder `wheel` measures its
            position in the observation channel `wheel/0/position`.
    """

    name: str
    type: str
    parent: int | None
    child: int
    pose: Pose
    frame: Pose
    axes: tuple[Axis, ...]
    thread_pitch: float
    devices: tuple[str, ...]


@dataclasses.dataclass(frozen=True)
class Sensor:
    """The place of a sensor on a link.

    Attributes:
        name: as in the names of its channels.
        link: index of the link.
        pose: pose of the sensor's frame in the link.
    """

    name: str
    link: int
    pose: Pose


class KinematicTree:
    """The links, joints and sensors of a robot; empty if the server does not send them.

    Attributes:
        links: list of `Link`; the first one is the root, and each comes after its parent.
        joints: list of `Joint`.
        sensors: list of `Sensor`: those with a fixed pose on a link.
    """

    def __init__(self, links: list[Any], joints: list[Any], sensors: list[Any]) -> None:
        self.links = [Link(*each) for each in links]
        self.joints = [_joint(*each) for each in joints]
        self.sensors = [Sensor(*each) for each in sensors]


def _joint(name: str, type_: int, parent: int | None, child: int, pose: Pose, frame: Pose, *rest: Any) -> Joint:
    axes, thread_pitch, devices = rest
    axes = tuple(Axis(*each) for each in axes)
    return Joint(name, JOINT_TYPES[type_], parent, child, pose, frame, axes, thread_pitch, tuple(devices))
