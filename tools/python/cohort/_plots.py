# SPDX-License-Identifier: Apache-2.0

"""Figures with matplotlib, which is imported only when needed."""

import numpy


def _headings(poses):
    """Returns the x axes of poses [n, 7] in the world's x-y plane, an array [n, 2]."""
    w, x, y, z = poses[:, 3:7].T
    return numpy.stack([1 - 2 * (y * y + z * z), 2 * (x * y + w * z)], axis=1)


def _checked_paths(paths, robots):
    paths = numpy.asarray(paths, dtype=numpy.float64)
    if paths.ndim != 3 or paths.shape[1] != robots or paths.shape[2] < 2:
        raise ValueError(f"paths has shape {paths.shape}, expected [step, {robots}, 2 or more]")
    return paths


def plot(simulation, paths, radius, axes):
    """Draws a simulation from above; see `Simulation.plot`."""
    from matplotlib import pyplot
    from matplotlib.collections import LineCollection
    from matplotlib.patches import Circle

    poses = simulation.poses
    if paths is not None:
        paths = _checked_paths(paths, len(poses))
    if axes is None:
        _, axes = pyplot.subplots(figsize=(5, 5), layout="constrained")
    robots = [each.object for each in simulation.robots]
    present = simulation.objects_present.astype(bool)
    others = present & (simulation.object_poses != (0, 0, 0, 1, 0, 0, 0)).any(axis=1)
    others[robots] = False
    objects = simulation.object_poses[others]
    axes.plot(objects[:, 0], objects[:, 1], "s", color="0.6", markersize=5, label="objects")
    colors = pyplot.get_cmap("tab10" if len(poses) <= 10 else "tab20")
    for robot, (pose, heading) in enumerate(zip(poses, _headings(poses))):
        color = colors(robot % colors.N)
        if paths is not None:
            axes.plot(paths[:, robot, 0], paths[:, robot, 1], color=color, linewidth=1)
        if not present[robots[robot]]:
            continue
        axes.add_patch(Circle(pose[:2], radius, facecolor=color, edgecolor="black", linewidth=0.8, zorder=3))
        axes.add_collection(LineCollection([[pose[:2], pose[:2] + radius * heading]], colors="black", zorder=4))
    axes.set_aspect("equal")
    axes.autoscale_view()
    axes.set(xlabel="x [m]", ylabel="y [m]", title=f"{simulation.experiment.name}, {simulation.time:.1f} s")
    return axes
