# SPDX-License-Identifier: Apache-2.0

"""Models as each engine reads them: joints, and groups of links that are connected by fixed joints.

A group has the name of its parent joint; the name of the root group is ''. Values are in world axes, with every joint
at zero, in SI units. A value that an engine does not provide is None.
"""

import dataclasses
import json
import re
import subprocess

import mujoco
import numpy
import pybullet


@dataclasses.dataclass
class Group:
    mass: float
    centre: numpy.ndarray  # of mass
    inertia: numpy.ndarray  # about the centre, 3x3


@dataclasses.dataclass
class Joint:
    anchor: numpy.ndarray
    axis: numpy.ndarray
    lower: float  # infinite: no limit
    upper: float


@dataclasses.dataclass
class Rest:
    """The state of a model after some seconds on a plane."""

    heights: dict  # of the groups' centres
    speed: float  # of the fastest centre


@dataclasses.dataclass
class Reading:
    groups: dict
    joints: dict
    rest: Rest | None = None

    def __post_init__(self):
        # Cohort adds this suffix to a joint that has the same name as a link.
        self.groups = {name.removesuffix("_joint"): group for name, group in self.groups.items()}
        self.joints = {name.removesuffix("_joint"): joint for name, joint in self.joints.items()}


class Unreadable(Exception):
    """The engine cannot read the file, for this reason."""


STEP = 1e-3  # of the others [s]
LIMITLESS = 1e15


def rotation(quaternion):
    """Returns the rotation matrix of a quaternion x y z w."""
    x, y, z, w = quaternion
    return numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])


def welded(parts):
    """Merges several parts (mass, centre, inertia about the centre) into one group."""
    mass = sum(part[0] for part in parts)
    if mass == 0.0:
        return Group(0.0, numpy.zeros(3), numpy.zeros((3, 3)))
    centre = sum(part[0] * part[1] for part in parts) / mass
    inertia = numpy.zeros((3, 3))
    for own, at, about in parts:
        arm = at - centre
        inertia += about + own * (arm @ arm * numpy.eye(3) - numpy.outer(arm, arm))
    return Group(mass, centre, inertia)


def limits(lower, upper):
    if lower is None or lower <= -LIMITLESS:
        lower = -numpy.inf
    if upper is None or upper >= LIMITLESS:
        upper = numpy.inf
    return lower, upper


def groups_of(tops, parts):
    """tops: for each link, the parent joint of its group; parts: for each link, (mass, centre, inertia)."""
    return {top: welded([parts[link] for link in parts if tops[link] == top]) for top in set(tops.values())}


def top_of(link, above):
    """above: for each link, (joint, whether the joint moves, parent)."""
    while link in above:
        joint, moves, parent = above[link]
        if moves:
            return joint
        link = parent
    return ""


def rest_of(before, now):
    """now: for each group, position and velocity of its centre of mass."""
    speeds = [float(numpy.linalg.norm(velocity)) for group, (_, velocity) in now.items() if before[group].mass > 0.0]
    heights = {group.removesuffix("_joint"): float(at[2]) for group, (at, _) in now.items() if before[group].mass > 0.0}
    return Rest(heights, max(speeds, default=0.0))


def motion_of(parts):
    """Returns position and velocity of the centre of mass of several (mass, position, velocity)."""
    mass = sum(part[0] for part in parts) or 1.0
    return sum(part[0] * part[1] for part in parts) / mass, sum(part[0] * part[2] for part in parts) / mass


class Cohort:
    """Cohort, through `cohort models show FILE --json`."""

    def __init__(self, program, file):
        self.program, self.file = program, file
        self.facts = self.run(0.0)
        self.objects = [each for each in self.facts["objects"] if not each["static"]]

    def run(self, seconds):
        command = [self.program, "models", "show", str(self.file), "--xacro", "--json", "--after", str(seconds)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise Unreadable(done.stderr.strip().split("\n")[-1])
        return json.loads(done.stdout)

    def pose(self):
        """Returns position and quaternion x y z w of the first model that moves."""
        link = self.objects[0]["links"][0]
        turn = rotation(link["pose_in_world"][3:]) @ rotation(link["pose"][3:]).T
        return numpy.array(link["pose_in_world"][:3]) - turn @ numpy.array(link["pose"][:3]), turn

    def is_held(self):
        """Returns whether the root link is fixed to the world."""
        return any(joint["parent"] == "world" for joint in self.objects[0]["joints"])

    def frictions(self):
        return {link["name"]: max(collision["friction"] for collision in link["collisions"])
                for each in self.objects for link in each["links"] if link["collisions"]}

    @staticmethod
    def tops(model):
        above = {joint["child"]: (joint["name"], joint["type"] != "fixed", joint["parent"])
                 for joint in model["joints"]}
        return {link["name"]: top_of(link["name"], above) for link in model["links"]}

    @staticmethod
    def part(link):
        turn = rotation(link["pose_in_world"][3:])
        centre = numpy.array(link["pose_in_world"][:3]) + turn @ numpy.array(link["centre"])
        return link["mass"], centre, turn @ numpy.array(link["inertia"]) @ turn.T

    def read(self, seconds):
        groups, joints = {}, {}
        for model in self.objects:
            tops = self.tops(model)
            groups |= groups_of(tops, {link["name"]: self.part(link) for link in model["links"]})
            for joint in model["joints"]:
                if "axis" in joint:
                    axis = joint["axis"]
                    joints[joint["name"]] = Joint(numpy.array(joint["pose_in_world"][:3]),
                                                  numpy.array(axis["direction_in_world"]),
                                                  *limits(axis["lower"], axis["upper"]))
        return Reading(groups, joints, self.rest(groups, seconds) if seconds > 0.0 else None)

    def rest(self, before, seconds):
        now = {}
        for model in self.run(seconds)["objects"]:
            if model["static"]:
                continue
            tops, moving = self.tops(model), {}
            for link in model["links"]:
                mass, centre, _ = self.part(link)
                arm = centre - numpy.array(link["pose_in_world"][:3])
                velocity = numpy.array(link["velocity"]) + numpy.cross(link["angular_velocity"], arm)
                moving.setdefault(tops[link["name"]], []).append((mass, centre, velocity))
            now |= {top: motion_of(parts) for top, parts in moving.items()}
        return rest_of(before, now)


class PyBullet:
    """Bullet through its Python package."""

    MOVING = (pybullet.JOINT_REVOLUTE, pybullet.JOINT_PRISMATIC, pybullet.JOINT_SPHERICAL, pybullet.JOINT_PLANAR)

    def __init__(self, file, folder, pose, frictions, is_held):
        self.client = pybullet.connect(pybullet.DIRECT)
        try:
            self.load(file, folder, pose, frictions, is_held)
        except pybullet.error as error:
            self.close()
            raise Unreadable(str(error)) from error

    def load(self, file, folder, pose, frictions, is_held):
        own = {"physicsClientId": self.client}
        pybullet.setTimeStep(STEP, **own)
        pybullet.setGravity(0.0, 0.0, -9.81, **own)
        self.plane = pybullet.createMultiBody(
            0.0, pybullet.createCollisionShape(pybullet.GEOM_PLANE, planeNormal=[0, 0, 1], **own), **own)
        pybullet.changeDynamics(self.plane, -1, lateralFriction=1.0, **own)
        pybullet.setAdditionalSearchPath(str(folder), **own)
        position, turn = pose
        if file.suffix == ".sdf":
            bodies = pybullet.loadSDF(str(file), **own)
            self.bodies = [body for body in bodies if pybullet.getNumJoints(body, **own) > 0 or
                           pybullet.getDynamicsInfo(body, -1, **own)[0] > 0.0]
        else:
            flags = pybullet.URDF_USE_INERTIA_FROM_FILE
            quaternion = numpy.empty(4)
            mujoco.mju_mat2Quat(quaternion, turn.flatten())
            self.bodies = [pybullet.loadURDF(str(file), position, [*quaternion[1:], quaternion[0]],
                                             useFixedBase=is_held, flags=flags, **own)]
        if not self.bodies:
            raise pybullet.error("the engine has read no moving link")
        for body in self.bodies:
            for link in range(-1, pybullet.getNumJoints(body, **own)):
                name = self.name(body, link)
                if name in frictions:
                    pybullet.changeDynamics(body, link, lateralFriction=frictions[name], **own)
                # By default, PyBullet damps motion; Cohort and MuJoCo do not.
                pybullet.changeDynamics(body, link, linearDamping=0.0, angularDamping=0.0, **own)

    def close(self):
        pybullet.disconnect(self.client)

    def name(self, body, link):
        if link < 0:
            return pybullet.getBodyInfo(body, physicsClientId=self.client)[0].decode()
        return pybullet.getJointInfo(body, link, physicsClientId=self.client)[12].decode()

    def joints(self, body):
        count = pybullet.getNumJoints(body, physicsClientId=self.client)
        return [pybullet.getJointInfo(body, joint, physicsClientId=self.client) for joint in range(count)]

    def centre(self, body, link):
        """Returns position, orientation and velocity of a link's centre of mass."""
        own = {"physicsClientId": self.client}
        if link < 0:
            at, turn = pybullet.getBasePositionAndOrientation(body, **own)
            return at, turn, pybullet.getBaseVelocity(body, **own)[0]
        state = pybullet.getLinkState(body, link, computeLinkVelocity=1, computeForwardKinematics=1, **own)
        return state[0], state[1], state[6]

    def tops(self, body):
        above = {info[0]: (info[1].decode(), info[2] in self.MOVING, info[16]) for info in self.joints(body)}
        return {link: top_of(link, above) for link in [-1, *above]}

    def read(self, seconds):
        own = {"physicsClientId": self.client}
        groups, joints = {}, {}
        for body in self.bodies:
            infos = self.joints(body)
            for info in infos:
                if info[2] in (pybullet.JOINT_REVOLUTE, pybullet.JOINT_PRISMATIC):
                    pybullet.resetJointState(body, info[0], 0.0, **own)
                    pybullet.setJointMotorControl2(body, info[0], pybullet.VELOCITY_CONTROL, force=0.0, **own)
                elif info[2] == pybullet.JOINT_SPHERICAL:
                    pybullet.setJointMotorControlMultiDof(body, info[0], pybullet.POSITION_CONTROL,
                                                          targetPosition=[0, 0, 0, 1], positionGain=0, velocityGain=0,
                                                          force=[0, 0, 0], **own)
            parts = {}
            for link in range(-1, len(infos)):
                dynamics = pybullet.getDynamicsInfo(body, link, **own)
                at, turn, _ = self.centre(body, link)
                turn = rotation(turn)
                parts[link] = (dynamics[0], numpy.array(at), turn @ numpy.diag(dynamics[2]) @ turn.T)
            groups |= groups_of(self.tops(body), parts)
            for info in infos:
                if info[2] in (pybullet.JOINT_REVOLUTE, pybullet.JOINT_PRISMATIC):
                    state = pybullet.getLinkState(body, info[0], computeForwardKinematics=1, **own)
                    lower, upper = (info[8], info[9]) if info[8] <= info[9] else (None, None)  # so it says "none"
                    joints[info[1].decode()] = Joint(numpy.array(state[4]), rotation(state[1]) @ numpy.array(info[13]),
                                                     *limits(lower, upper))
        return Reading(groups, joints, self.rest(groups, seconds) if seconds > 0.0 else None)

    def rest(self, before, seconds):
        own = {"physicsClientId": self.client}
        for _ in range(round(seconds / STEP)):
            pybullet.stepSimulation(**own)
        now = {}
        for body in self.bodies:
            tops, moving = self.tops(body), {}
            for link, top in tops.items():
                at, _, velocity = self.centre(body, link)
                mass = pybullet.getDynamicsInfo(body, link, **own)[0]
                moving.setdefault(top, []).append((mass, numpy.array(at), numpy.array(velocity)))
            now |= {top: motion_of(parts) for top, parts in moving.items()}
        return rest_of(before, now)


class MuJoCo:
    """MuJoCo, which reads URDF but not SDF, and no COLLADA meshes."""

    def __init__(self, file, folder, pose, frictions, is_held):
        if file.suffix != ".urdf":
            raise Unreadable("MuJoCo reads URDF only")
        try:
            self.load(file, folder, pose, frictions, is_held)
        except (ValueError, mujoco.FatalError) as error:
            raise Unreadable(str(error).split("\n")[0]) from error

    def load(self, file, folder, pose, frictions, is_held):
        text = re.sub(r"<\?xml.*?\?>|<!--.*?-->", "", file.read_text(encoding="utf-8", errors="replace"), flags=re.S)
        text = re.sub(r"<visual.*?</visual>", "", text, flags=re.S)
        options = ('<mujoco><compiler fusestatic="false" strippath="false" balanceinertia="true" boundmass="0"/>'
                   '<option timestep="%g"/></mujoco>' % STEP)
        text = re.sub(r"(<robot\b[^>]*>)", lambda found: found.group(1) + options, text, count=1)
        assets = {}

        def asset(found):
            path = folder / found.group(1).removeprefix("package://").removeprefix("file://")
            if path.suffix.lower() == ".dae":
                raise ValueError("MuJoCo does not read COLLADA meshes")
            if path.is_file():
                assets[found.group(1)] = path.read_bytes()
            return found.group(0)

        re.sub(r'filename="([^"]*)"', asset, text)
        spec = mujoco.MjSpec.from_string(text, assets=assets)
        for body in spec.worldbody.bodies:
            position, turn = pose
            body.pos = position
            mujoco.mju_mat2Quat(body.quat, turn.flatten())
            if not is_held:
                body.add_freejoint()
        for geom in spec.geoms:
            geom.friction[0] = frictions.get(geom.parent.name, geom.friction[0])
            geom.contype, geom.conaffinity = 1, 2  # not with its own links, as Cohort
        plane = spec.worldbody.add_geom()
        plane.type, plane.size = mujoco.mjtGeom.mjGEOM_PLANE, [0, 0, 1]
        plane.contype, plane.conaffinity, plane.friction[0] = 2, 1, 0.0
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)
        mujoco.mj_forward(self.model, self.data)

    def close(self):
        pass

    def tops(self):
        above = {}
        for body in range(1, self.model.nbody):
            first, count = self.model.body_jntadr[body], self.model.body_jntnum[body]
            moves = count > 0 and self.model.jnt_type[first] != mujoco.mjtJoint.mjJNT_FREE
            above[body] = (self.model.joint(first).name if moves else "", moves, self.model.body_parentid[body])
        return {body: top_of(body, above) for body in above}

    def read(self, seconds):
        model, data = self.model, self.data
        parts = {}
        for body in range(1, model.nbody):
            turn = data.ximat[body].reshape(3, 3)
            parts[body] = (model.body_mass[body], data.xipos[body].copy(),
                           turn @ numpy.diag(model.body_inertia[body]) @ turn.T)
        groups = groups_of(self.tops(), parts)
        joints = {}
        for joint in range(model.njnt):
            if model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_FREE:
                continue
            lower, upper = model.jnt_range[joint] if model.jnt_limited[joint] else (None, None)
            joints[model.joint(joint).name] = Joint(data.xanchor[joint].copy(), data.xaxis[joint].copy(),
                                                    *limits(lower, upper))
        return Reading(groups, joints, self.rest(groups, seconds) if seconds > 0.0 else None)

    def rest(self, before, seconds):
        for _ in range(round(seconds / STEP)):
            mujoco.mj_step(self.model, self.data)
        if not numpy.isfinite(self.data.qpos).all():
            return None
        moving, now = {}, {}
        velocity = numpy.empty(6)
        for body, top in self.tops().items():
            mujoco.mj_objectVelocity(self.model, self.data, mujoco.mjtObj.mjOBJ_BODY, body, velocity, 0)
            moving.setdefault(top, []).append((self.model.body_mass[body], self.data.xipos[body].copy(),
                                               velocity[3:].copy()))
        for top, parts in moving.items():
            mass = sum(part[0] for part in parts) or 1.0
            now[top] = (sum(part[0] * part[1] for part in parts) / mass, sum(part[0] * part[2] for part in parts) / mass)
        return rest_of(before, now)
