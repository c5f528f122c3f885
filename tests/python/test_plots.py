# SPDX-License-Identifier: Apache-2.0

"""Figures of simulations."""

import subprocess
import sys

import cohort
import matplotlib
import numpy
import pytest
from matplotlib.patches import Circle

matplotlib.use("Agg")


def circles(axes):
    return [each for each in axes.patches if isinstance(each, Circle)]


def test_a_plot_has_a_circle_at_each_robot_and_a_line_along_its_heading():
    simulation = cohort.Simulation("obstacle_avoidance")
    simulation.set_pose("explorers/sbot_3", [0.5, -0.25, 0.1], yaw=numpy.pi / 2)
    axes = simulation.plot(radius=0.07)
    numpy.testing.assert_allclose([each.center for each in circles(axes)], simulation.poses[:, :2])
    assert {each.radius for each in circles(axes)} == {0.07}
    heading = axes.collections[3].get_segments()[0]
    numpy.testing.assert_allclose(heading, [[0.5, -0.25], [0.5, -0.18]], atol=1e-9)


def test_a_plot_shows_where_other_objects_are_until_they_are_removed():
    simulation = cohort.Simulation("obstacle_avoidance")
    simulation.remove("block_0")
    simulation.remove("explorers/sbot_0")
    simulation.step()
    axes = simulation.plot()
    squares = axes.lines[0].get_xydata()
    gone = ("block_0", "ground", "explorers/")
    kept = [name for name in simulation.objects if not name.startswith(gone)]
    numpy.testing.assert_allclose(squares, [simulation.pose(name)[:2] for name in kept])
    assert len(circles(axes)) == 15


def test_a_plot_draws_paths_on_the_axes_that_are_given():
    simulation = cohort.Simulation("obstacle_avoidance")
    _, axes = matplotlib.pyplot.subplots()
    paths = numpy.random.default_rng(1).uniform(-1, 1, (5, 16, 7))
    assert simulation.plot(paths, axes=axes) is axes
    numpy.testing.assert_array_equal(axes.lines[3].get_xydata(), paths[:, 2, :2])
    matplotlib.pyplot.close("all")


def test_paths_of_another_shape_are_named():
    simulation = cohort.Simulation("obstacle_avoidance")
    with pytest.raises(ValueError, match=r"paths has shape \(5, 7\), expected \[step, 16, 2 or more\]"):
        simulation.plot(numpy.zeros((5, 7)))


def test_importing_the_package_does_not_import_matplotlib():
    program = "import sys, cohort, cohort.gym; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program]).returncode == 0
