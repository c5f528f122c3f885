# SPDX-License-Identifier: Apache-2.0

"""Compares models as Cohort, PyBullet and MuJoCo read them, and their rest poses on a plane after some seconds."""

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
SAME_MASS = 1e-5  # relative
SAME_PLACE = 1e-5  # [m]
SAME_INERTIA = 1e-3  # relative to the largest moment: Bullet stores floats
SAME_DIRECTION = 1e-4  # [rad]
SAME_LIMIT = 1e-4  # [rad] or [m]
SAME_HEIGHT = 0.01  # at rest [m]
SLOW = 0.001  # at rest [m/s]


def only_in_one(ours, theirs):
    """Yields each name that only one side has, with the side that has it and the side that does not."""
    for name in sorted(set(ours) ^ set(theirs)):
        yield (name, "in Cohort", "here") if name in ours else (name, "here", "in Cohort")


def differences(ours, theirs):
    """Yields a sentence for each difference of two models; none if they are equal."""
    for name, owner, other in only_in_one(ours.groups, theirs.groups):
        yield f"'{name or 'root'}' is a group of links {owner} and not {other}"
    for name, group in sorted(theirs.groups.items()):
        own = ours.groups.get(name)
        if own is None:
            continue
        at = name or "root"
        if abs(own.mass - group.mass) > SAME_MASS * max(own.mass, group.mass):
            yield f"'{at}' has a mass of {own.mass:g} kg in Cohort, {group.mass:g} kg here"
        elif own.mass > 0.0:
            apart = numpy.linalg.norm(own.centre - group.centre)
            if apart > SAME_PLACE:
                yield f"the centres of mass of '{at}' are {apart:.3g} m apart"
            largest = max(numpy.abs(own.inertia).max(), numpy.abs(group.inertia).max())
            error = numpy.abs(own.inertia - group.inertia).max()
            if error > SAME_INERTIA * largest:
                yield f"the inertia of '{at}' differs by {error:.3g} kg m^2, largest moment {largest:.3g} kg m^2"
    for name, owner, other in only_in_one(ours.joints, theirs.joints):
        yield f"the joint '{name}' moves {owner} and not {other}"
    for name, joint in sorted(theirs.joints.items()):
        own = ours.joints.get(name)
        if own is None:
            continue
        apart = numpy.linalg.norm(own.anchor - joint.anchor)
        if apart > SAME_PLACE:
            yield f"the anchors of joint '{name}' are {apart:.3g} m apart"
        turned = numpy.linalg.norm(own.axis / numpy.linalg.norm(own.axis) - joint.axis / numpy.linalg.norm(joint.axis))
        if turned > SAME_DIRECTION:
            yield f"the axes of joint '{name}' differ by {turned:.3g} rad"
        for limit in ("lower", "upper"):
            mine, other = getattr(own, limit), getattr(joint, limit)
            if mine != other and not abs(mine - other) <= SAME_LIMIT:
                yield f"the {limit} limit of joint '{name}' is {mine:g} in Cohort, {other:g} here"


def differences_at_rest(ours, theirs):
    for group, height in sorted(theirs.heights.items()):
        if group in ours.heights and abs(ours.heights[group] - height) > SAME_HEIGHT:
            yield f"'{group or 'root'}' is at height {ours.heights[group]:.3f} m in Cohort, {height:.3f} m here"


def expanded(file, folder):
    """Returns the file, expanded by xacro if necessary: PyBullet and MuJoCo do not support xacro."""
    if "<xacro:" not in file.read_text(encoding="utf-8", errors="replace"):
        return file
    xacro = pathlib.Path(sys.executable).with_name("xacro")
    out = pathlib.Path(folder) / (file.stem + ".urdf")
    done = subprocess.run([xacro, file, "-o", out], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise Unreadable("xacro: " + done.stderr.strip().split("\n")[-1])
    return out


def compare(program, file, seconds):
    """Returns for each engine the differences of a model, or why it is not compared."""
    found = {}
    cohort = Cohort(program, file)
    if not cohort.objects:
        raise Unreadable("the model has no moving link")
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
    """Prints the differences of a model, and returns the number of unexplained ones."""
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
    """Yields name, file and known differences of the robots in robots.json."""
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
            print(f"{robot['name']}\n  skipped: requires a clone of https://github.com/{robot['repository']} in the "
                  "folder of --repositories")
            continue
        yield robot["name"], folder / robot["file"], robot.get("known", [])


def main():
    parser = argparse.ArgumentParser(prog="tools/dev/compare-models", description=__doc__)
    parser.add_argument("robots", nargs="*", metavar="ROBOT", help="robot of tools/dev/models/robots.json (default: all)")
    parser.add_argument("--file", type=pathlib.Path, help="compare this model instead")
    parser.add_argument("--repositories", type=pathlib.Path, metavar="DIR", help="folder of the cloned repositories")
    parser.add_argument("--seconds", type=float, default=5.0, help="simulated time (default: 5; 0: none)")
    parser.add_argument("--cohort", default=str(SOURCE / "build/release/bin/cohort"), help="path of the program cohort")
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
    print(f"{compared} compared, {unexplained} unexplained differences")
    return 1 if unexplained else 0


if __name__ == "__main__":
    sys.exit(main())
