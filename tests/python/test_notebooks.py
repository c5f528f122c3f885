# SPDX-License-Identifier: Apache-2.0

"""The notebooks: each runs from top to bottom, shortened by COHORT_QUICK, and shows what it says."""

import json
import pathlib
import sys

import nbformat
import pytest
from nbclient import NotebookClient

folder = pathlib.Path(__file__).parents[2] / "tools/python/notebooks"


@pytest.fixture
def run(monkeypatch, tmp_path):
    """Runs a notebook in a kernel of this environment, and returns the values of expressions at its end."""
    monkeypatch.setenv("COHORT_QUICK", "1")
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    monkeypatch.setenv("JUPYTER_DATA_DIR", str(tmp_path / "jupyter"))

    def run_notebook(name, expressions="{}"):
        notebook = nbformat.read(folder / f"{name}.ipynb", as_version=4)
        notebook.cells.append(
            nbformat.v4.new_code_cell(f"import json, sys; print(json.dumps([sys.prefix, {expressions}]))")
        )
        NotebookClient(
            notebook, timeout=600, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}
        ).execute()
        prefix, values = json.loads(notebook.cells[-1].outputs[0].text)
        assert prefix == sys.prefix, "the kernel is of another environment"
        return values

    return run_notebook


def test_the_first_controller_runs(run):
    lengths = "numpy.linalg.norm(numpy.diff(paths, axis=0)[:, :, :2], axis=2).sum(axis=0).tolist()"
    values = run(
        "first_controller", f"{{'touching': result.touching_obstacles / result.robot_ticks, 'lengths': {lengths}}}"
    )
    assert values["touching"] < 0.05
    assert min(values["lengths"]) > 0.5  # m in 20 s: no robot turns on the spot all the time


def test_the_statistics_distinguish_two_swarms(run):
    values = run("statistics_of_a_swarm", "{'low': low, 'high': high, 'runs': len(runs)}")
    assert values["runs"] == 12
    assert 0 < values["low"] < values["high"]


def test_a_policy_learns_to_avoid_obstacles(run):
    returns = run("learning_obstacle_avoidance", "returns")
    # At most 200. A policy that does not learn stays at the return of the random one, which is about -40.
    assert returns["seed 1"] > returns["random"] + 100


def test_a_controller_evolves(run):
    values = run("an_evolved_controller", "{'before': before, 'after': after}")
    assert values["after"] > values["before"] + 0.5


@pytest.mark.parametrize("notebook", sorted(folder.glob("*.ipynb")), ids=lambda each: each.stem)
def test_notebooks_are_stored_without_outputs(notebook):
    cells = [each for each in nbformat.read(notebook, as_version=4).cells if each.cell_type == "code"]
    assert all(not each.outputs and each.execution_count is None for each in cells)
