"""Models as Cohort, PyBullet and MuJoCo read them, and where they lie after some seconds on a plane."""

import argparse
import json
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy
import pybullet_data

from engines import Cohort, MuJoCo, PyBullet, Unreadable

HERE = pathlib.Path(__file__).resolve().parent
SOURCE = HERE.parent.parent
SAME_MASS = 1e-5  # of it
SAME_PLACE = 1e-5  # [m]
SAME_INERTIA = 1e-3  # of the largest moment: Bullet keeps floats
SAME_DIRECTION = 1e-4  # [rad]
SAME_LIMIT = 1e-4  # [rad] or [m]
SAME_HEIGHT = 0.01  # at rest [m]
SLOW = 0.001  # at rest [m/s]


def only_in_one(ours, theirs):
    """Each name that only one of both has, with where it is and where it is not."""
    for name in sorted(set(ours) ^ set(theirs)):
        yield (name, "here", "there") if name in ours else (name, "there", "here")


def differences(ours, theirs):
    """Sentences; none if both have the same model."""
    for name, owner, other in only_in_one(ours.groups, theirs.groups):
        yield f"'{name or 'root'}' is a group of links {owner} and not {other}"
    for name, group in sorted(theirs.groups.items()):
        own = ours.groups.get(name)
        if own is None:
            continue
        at = name or "root"
        if abs(own.mass - group.mass) > SAME_MASS * max(own.mass, group.mass):
            yield f"'{at}' has {own.mass:g} kg, there {group.mass:g} kg"
        elif own.mass > 0.0:
            apart = numpy.linalg.norm(own.centre - group.centre)
            if apart > SAME_PLACE:
                yield f"the centre of mass of '{at}' is {apart:.3g} m elsewhere"
            largest = max(numpy.abs(own.inertia).max(), numpy.abs(group.inertia).max())
            error = numpy.abs(own.inertia - group.inertia).max()
            if error > SAME_INERTIA * largest:
                yield f"the inertia of '{at}' differs by {error:.3g} kg m^2 of {largest:.3g}"
    for name, owner, other in only_in_one(ours.joints, theirs.joints):
        yield f"the joint '{name}' moves {owner} and not {other}"
    for name, joint in sorted(theirs.joints.items()):
        own = ours.joints.get(name)
        if own is None:
            continue
        apart = numpy.linalg.norm(own.anchor - joint.anchor)
        if apart > SAME_PLACE:
            yield f"the joint '{name}' is {apart:.3g} m elsewhere"
        turned = numpy.linalg.norm(own.axis / numpy.linalg.norm(own.axis) - joint.axis / numpy.linalg.norm(joint.axis))
        if turned > SAME_DIRECTION:
            yield f"the axis of '{name}' is turned by {turned:.3g}"
        for limit in ("lower", "upper"):
            mine, other = getattr(own, limit), getattr(joint, limit)
            if mine != other and not abs(mine - other) <= SAME_LIMIT:
                yield f"the {limit} limit of '{name}' is {mine:g}, there {other:g}"


def differences_at_rest(ours, theirs):
    for group, height in sorted(theirs.heights.items()):
        if group in ours.heights and abs(ours.heights[group] - height) > SAME_HEIGHT:
            yield f"'{group or 'root'}' lies at {ours.heights[group]:.3f} m, there at {height:.3f} m"


def expanded(file, folder):
    """The URDF that xacro makes of a file that needs it: PyBullet and MuJoCo have no xacro."""
    if "<xacro:" not in file.read_text(encoding="utf-8", errors="replace"):
        return file
    xacro = pathlib.Path(sys.executable).with_name("xacro")
    out = pathlib.Path(folder) / (file.stem + ".urdf")
    done = subprocess.run([xacro, file, "-o", out], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Unreadable("xacro: " + done.stderr.strip().split("\n")[-1])
    return out


def compare(program, file, seconds):
    """What is to be told of one model: by engine why it is not compared, or its differences."""
    found = {}
    cohort = Cohort(program, file)
    if not cohort.objects:
        raise Unreadable("nothing in it moves")
    ours = cohort.read(seconds)
    found["Cohort"] = {"speed": ours.rest.speed if ours.rest else None}
    with tempfile.TemporaryDirectory() as folder:
        plain = expanded(file, folder)
        pose, frictions, is_held = cohort.pose(), cohort.frictions(), cohort.is_held()
        makers = {"PyBullet": lambda: PyBullet(plain, file.parent, pose, frictions, is_held),
                  "MuJoCo": lambda: MuJoCo(plain, file.parent, pose, frictions, is_held)}
        for name, make in makers.items():
            try:
                engine = make()
            except Unreadable as error:
                found[name] = {"unreadable": str(error)}
                continue
            theirs = engine.read(seconds)
            engine.close()
            found[name] = {"differences": list(differences(ours, theirs))}
            if ours.rest and theirs.rest:
                found[name]["at_rest"] = list(differences_at_rest(ours.rest, theirs.rest))
                found[name]["speed"] = theirs.rest.speed
    return found


def tell(name, found, tolerated):
    """The number of differences that nothing explains."""
    unexplained = 0
    print(name)
    for engine, facts in found.items():
        speed = facts.get("speed")
        text = "" if speed is None else f", fastest centre {1000.0 * speed:.3g} mm/s"
        if "unreadable" in facts:
            print(f"  {engine}: not compared: {facts['unreadable']}")
            continue
        print(f"  {engine}" + text)
        for difference in facts.get("differences", []):
            is_known = any(part in difference for part in tolerated)
            unexplained += not is_known
            print(f"    {difference}" + (" (known)" if is_known else ""))
        for difference in facts.get("at_rest", []):
            print(f"    at rest: {difference}")
    return unexplained


def listed(names, repositories):
    """Of robots.json: name, file, the differences that are known."""
    robots = json.loads((HERE / "robots.json").read_text(encoding="utf-8"))
    known = [robot["name"] for robot in robots]
    for name in names:
        if name not in known:
            sys.exit(f"there is no robot '{name}'; known: {', '.join(known)}")
    for robot in robots:
        if names and robot["name"] not in names:
            continue
        if "package" in robot:
            folder = pathlib.Path(pybullet_data.getDataPath())
        elif repositories:
            folder = repositories / robot["repository"].split("/")[1]
        else:
            print(f"{robot['name']}\n  left out: of https://github.com/{robot['repository']}; --repositories names a "
                  "folder with a clone")
            continue
        yield robot["name"], folder / robot["file"], robot.get("known", [])


def main():
    parser = argparse.ArgumentParser(prog="tools/compare-models", description=__doc__)
    parser.add_argument("robots", nargs="*", metavar="ROBOT", help="of tools/models/robots.json (default: all)")
    parser.add_argument("--file", type=pathlib.Path, help="a model instead of the robots of the list")
    parser.add_argument("--repositories", type=pathlib.Path, metavar="DIR", help="folder with clones of repositories")
    parser.add_argument("--seconds", type=float, default=5.0, help="on a plane (default: 5; 0: none)")
    parser.add_argument("--cohort", default=str(SOURCE / "build/release/bin/cohort"), help="program to ask")
    arguments = parser.parse_args()
    os.environ["VIRTUAL_ENV"] = sys.prefix  # where Cohort looks for xacro
    robots = [(str(arguments.file), arguments.file.resolve(), [])] if arguments.file else \
        listed(arguments.robots, arguments.repositories)
    unexplained = compared = 0
    for name, file, tolerated in robots:
        try:
            found = compare(arguments.cohort, file, arguments.seconds)
        except Unreadable as error:
            print(f"{name}\n  Cohort: {error}")
            unexplained += 1
            continue
        unexplained += tell(name, found, tolerated)
        compared += 1
    print(f"{compared} compared, {unexplained} differences that nothing explains")
    return 1 if unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
