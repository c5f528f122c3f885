# SPDX-License-Identifier: Apache-2.0

"""`cohort` runs controllers that are written in Python."""

import json
import os
import pathlib
import re
import shutil
import signal
import sys

import cohort
import pytest
import yaml_fields
from conftest import PATIENCE, end_of

HERE = pathlib.Path(__file__).parent
SECONDS = 3

FORWARD = """import cohort
class Forward(cohort.Controller):
    def start(self, start):
        self.tracks = start.commands("treel/*/velocity", 2)
        self.speed = start.parameters.real("speed", 0.1)
    def step(self, observation, command):
        command[self.tracks] = self.speed
"""

# Turns after so many of its own steps: with another count a run has another hash.
COUNTING = """import cohort
class Counting(cohort.Controller):
    def start(self, start):
        self.left = start.command("treel/left/velocity")
        self.steps = 0
    def step(self, observation, command):
        self.steps += 1
        command[self.left] = 0.001 * self.steps
    def save(self):
        return str(self.steps).encode()
    def load(self, state):
        self.steps = int(state)
"""

COUNTING_TOGETHER = (
    COUNTING.replace("Controller", "TeamController")
    .replace("def start(self, start):", "def start(self, robots):")
    .replace("start.command(", "robots[0].command(")
    .replace("command[self.left]", "command[:, self.left]")
)


@pytest.fixture
def write(tmp_path):
    """Writes an experiment whose controller is a file of Python beside it, and returns the experiment's path."""

    def write(source, seconds=SECONDS, **fields):
        if source is not None:
            (tmp_path / "wanderer.py").write_text(source)
        team = {"name": "explorers", "robots": "explorers/*", "controller": "wanderer.py"} | fields
        file = tmp_path / "experiment.yaml"
        file.write_text(yaml_fields.of_example("obstacle_avoidance", duration=seconds, teams=[team]))
        return file

    return write


TREE = """import cohort
class Looker(cohort.Controller):
    def start(self, start):
        tree = start.tree
        names = [link.name for link in tree.links]
        turret = next(joint for joint in tree.joints if joint.devices.count("turret") > 0)
        proximity = next(sensor for sensor in tree.sensors if sensor.name == "proximity")
        axis = turret.axes[0]
        found = [names[0], turret.type, names[turret.parent], names[turret.child], axis.direction, proximity.pose[3:]]
        assert found == EXPECTED, found
        assert axis.lower < 0 < axis.upper and tree.links[0].mass > 0
    def step(self, observation, command):
        pass
"""


@pytest.mark.parametrize("how", ["process", "inprocess"])
def test_a_controller_receives_the_kinematic_tree_of_its_robot(cohort_program, write, how):
    expected = ["chassis", "revolute", "chassis", "turret", (0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 0.0)]
    experiment = write(TREE.replace("EXPECTED", repr(expected)), seconds=0.1)
    assert hash_of(cohort_program, experiment, "--controllers", how) != 0


def hash_of(cohort_program, experiment, *more):
    summary = experiment.with_suffix(".json")
    cohort_program("run", experiment, "--quiet", "--summary", summary, *more)
    return hash_in(summary)


def hash_in(summary):
    return int(json.loads(summary.read_text())["state_hash"], 16)


def test_a_run_has_the_hash_of_its_twin_in_cpp_in_every_program(cohort_program, write):
    experiment = write((HERE / "obstacle_avoidance_in_python.py").read_text())
    twin = cohort.run("obstacle_avoidance", duration=SECONDS).state_hash
    assert cohort.run(experiment).state_hash == twin
    assert hash_of(cohort_program, experiment) == twin
    assert hash_of(cohort_program, experiment, "--controllers", "inprocess") == twin
    assert hash_of(cohort_program, experiment, "--controllers", "inprocess", "--threads", "2") == twin


def test_the_controllers_of_the_tutorial_are_twins(cohort_program, tmp_path):
    tutorial = (HERE.parent.parent / "docs/tutorial.md").read_text()
    for text, name in re.findall(r"```\w+\n((?:#|<!--) ([\w.]+)[\s\S]*?)```", tutorial):
        (tmp_path / name).write_text(text)
    experiment = tmp_path / "walls.yaml"
    experiment.write_text(experiment.read_text().replace("build/wall_follower.so", "wall_follower.py"))
    stated = re.search(r"state hash +([0-9a-f]{16})", tutorial)[1]
    assert hash_of(cohort_program, experiment) == int(stated, 16)
    assert hash_of(cohort_program, experiment, "--controllers", "inprocess") == int(stated, 16)


def test_a_host_runs_a_file_for_some_robots(cohort_program, write, domain):
    experiment = write((HERE / "obstacle_avoidance_in_python.py").read_text())
    summary = experiment.with_suffix(".json")
    host = ["host", experiment.with_name("wanderer.py"), "--domain", domain, "--robots"]
    with (
        cohort_program.running("serve", experiment, "--quiet", "--domain", domain, "--summary", summary) as server,
        cohort_program.running(*host, "0..7") as one,
        cohort_program.running(*host, "8..15") as other,
    ):
        assert [end_of(one), end_of(other), end_of(server)] == [(0, "")] * 3
    assert hash_in(summary) == cohort.run("obstacle_avoidance", duration=SECONDS).state_hash


# Python loads DDS for itself alone: what replaces its calls cannot find them among all symbols.
def test_a_controller_runs_in_virtual_time(cohort_program, write, domain):
    source = FORWARD + 'cohort.main(Forward, ["--robots", "all"])\n'
    experiment = write(source.replace("self.speed = start", "print('has started', flush=True); self.speed = start"))
    summary = experiment.with_suffix(".json")
    program = [sys.executable, experiment.with_name("wanderer.py")]
    with (
        cohort_program.running("serve", experiment, "--quiet", "--domain", domain, "--summary", summary) as server,
        cohort_program.running("exec", "--domain", domain, "--", *program) as controllers,
    ):
        output, errors = controllers.communicate(timeout=PATIENCE)
        assert (controllers.returncode, errors) == (0, "")
        assert "has started" in output
        assert end_of(server) == (0, "")
    assert hash_in(summary) == cohort.run(write(FORWARD)).state_hash


def test_sine_and_similar_functions_are_those_of_cohort_everywhere(cohort_program, write):
    values = "[math.sin(0.1 * i) * math.exp(-0.01 * i) + float(numpy.float64(i)) ** 0.3 for i in range(200)]"
    experiment = write(
        "import cohort, math, numpy\n"
        "class Numbers(cohort.Controller):\n"
        "    def start(self, start):\n"
        "        self.left = start.command('treel/left/velocity')\n"
        f"        self.values = {values}\n"
        "        assert cohort._native.functions_not_portable() == []\n"
        "    def step(self, observation, command):\n"
        "        command[self.left] = 0.01 * self.values[self.tick % 200]\n"
    )
    here = cohort.run(experiment).state_hash
    assert hash_of(cohort_program, experiment) == here
    assert hash_of(cohort_program, experiment, "--controllers", "inprocess") == here


@pytest.mark.parametrize("place", ["process", "inprocess"])
def test_one_object_in_a_file_drives_all_robots(cohort_program, write, place):
    together = FORWARD.replace("cohort.Controller", "cohort.TeamController")
    together = together.replace("start.", "start[0].").replace("command[self", "command[:, self")
    assert hash_of(cohort_program, write(together), "--controllers", place) == cohort.run(write(FORWARD)).state_hash


def test_check_loads_it_on_request(cohort_program, write):
    experiment = write("print('I am here')\n" + FORWARD)
    assert "I am here" not in cohort_program("check", experiment)
    assert "I am here" in cohort_program("check", experiment, "--load-controllers")


def test_parameters_of_the_experiment_reach_it(cohort_program, write):
    slow = hash_of(cohort_program, write(FORWARD, parameters={"speed": 0.05}))
    assert slow != hash_of(cohort_program, write(FORWARD))
    assert slow == cohort.run(write(FORWARD, parameters={"speed": 0.05})).state_hash


@pytest.mark.parametrize(
    ("parameters", "said"),
    [({"sped": 0.1}, "parameter 'sped'"), ({"speed": "much"}, "parameter 'speed': expected a number, not 'much'")],
)
def test_a_wrong_parameter_is_an_error_with_its_line(cohort_program, write, parameters, said):
    experiment = write(FORWARD, parameters=parameters)
    name = next(iter(parameters))
    line = next(i for i, each in enumerate(experiment.read_text().splitlines(), 1) if f'"{name}"' in each)
    for command in (["run"], ["check", "--load-controllers"]):
        end = cohort_program.end_of(*command, experiment)
        assert end.returncode == 2
        assert f"experiment.yaml:{line}: teams[0].parameters: " in end.stderr
        assert said in end.stderr


@pytest.mark.parametrize("place", ["process", "inprocess"])
@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ("raise ValueError('too dark')", "ValueError: too dark"),
        ("exit()", "SystemExit"),
        ("import sys; sys.exit(0)", "SystemExit: 0"),
        ("raise KeyboardInterrupt", "KeyboardInterrupt"),
    ],
)
def test_an_exception_ends_the_run_with_the_line_of_the_script(cohort_program, write, place, statement, said):
    experiment = write(FORWARD + f"        if self.tick == 7:\n            {statement}\n")
    end = cohort_program.end_of("run", experiment, "--quiet", "--controllers", place)
    assert end.returncode == 1
    assert "failed in step at tick 7: wanderer.py:9 in step" in end.stderr
    assert said in end.stderr


@pytest.mark.parametrize(
    ("source", "said"),
    [
        (None, "no controller file at "),
        ("x = 1\n", "expected one class derived from cohort.Controller, found: none"),
        (FORWARD + FORWARD.replace("Forward", "Back"), "derived from cohort.Controller, found: Back, Forward"),
        ("import cohort\nx = (1\n", "wanderer.py:2: SyntaxError"),
        ("import cohort\n1 / 0\n", "wanderer.py:2 in <module>: ZeroDivisionError: division by zero"),
        ("import cohort\nexit()\n", "wanderer.py:2 in <module>: SystemExit"),
        (FORWARD.replace("treel/*", "trel/*"), "wanderer.py:4 in start"),
    ],
)
def test_a_file_that_cannot_be_used_is_an_error_of_the_experiment(cohort_program, write, source, said):
    experiment = write(source)
    end = cohort_program.end_of("check", "--load-controllers", experiment)
    assert end.returncode == 2
    assert "teams[0].controller: " in end.stderr
    assert said in end.stderr


def test_a_host_reports_an_invalid_file_before_there_is_a_server(cohort_program, tmp_path):
    file = tmp_path / "wanderer.py"
    end = cohort_program.end_of("host", file, "--robots", "all")
    assert end.returncode == 2
    assert f"no controller file at {file}" in end.stderr
    file.write_text("import cohort\n1 / 0\n")
    end = cohort_program.end_of("host", file, "--robots", "all")
    assert end.returncode == 2
    assert "wanderer.py:2 in <module>: ZeroDivisionError" in end.stderr


def test_what_python_keeps_for_a_thread_is_kept_between_steps(cohort_program, write, domain):
    experiment = write(
        "import cohort, collections, contextvars, threading\n"
        "steps = contextvars.ContextVar('steps', default=0)\n"
        "steps_of_thread = collections.Counter()\n"
        "class Remembering(cohort.Controller):\n"
        "    def step(self, observation, command):\n"
        "        steps.set(steps.get() + 1)\n"
        "        steps_of_thread[threading.get_ident()] += 1\n"
        "        assert steps.get() == steps_of_thread[threading.get_ident()]\n",
        seconds=0.1,
    )
    host = ["host", experiment.with_name("wanderer.py"), "--robots", "all", "--domain", domain, "--inline"]
    with (
        cohort_program.running("serve", experiment, "--quiet", "--domain", domain),
        cohort_program.running(*host) as process,
    ):
        assert end_of(process) == (0, "")


@pytest.mark.parametrize(
    ("python", "said"),
    [
        ("/nowhere/python", "the Python interpreter '/nowhere/python' cannot be run"),
        ("/bin/false", "the Python interpreter '/bin/false' cannot be run"),
        ("without_library", "the Python interpreter /an/interpreter cannot be embedded: its shared library"),
    ],
)
def test_an_unsuitable_python_is_named(cohort_program, write, tmp_path, python, said):
    without_library = tmp_path / "without_library"
    without_library.write_text("#!/bin/sh\necho a warning\necho /an/interpreter\necho\n")
    without_library.chmod(0o755)
    end = cohort_program.end_of("run", write(FORWARD), COHORT_PYTHON=python, PATH=f"{tmp_path}:{os.environ['PATH']}")
    assert end.returncode == 2
    assert said in end.stderr
    assert "et COHORT_PYTHON to" in end.stderr


def test_without_the_package_the_message_says_what_is_missing(cohort_program, write, tmp_path):
    # The plugin outside of its build tree, and a Python that sees no packages.
    shutil.copy(cohort_program.path.parent.parent / "lib/controllers/python.so", tmp_path)
    end = cohort_program.end_of("run", write(FORWARD), COHORT_PLUGIN_PATH=str(tmp_path), PYTHONPATH="")
    assert end.returncode == 2
    assert "cannot import the Python package of Cohort (No module named 'cohort')" in end.stderr


def test_without_the_plugin_the_message_says_what_is_missing(cohort_program, write, tmp_path):
    program = tmp_path / "bin/cohort"
    program.parent.mkdir()
    shutil.copy(cohort_program.path, program)  # whose folder tells where plugins are
    end = type(cohort_program)(program).end_of("check", write(FORWARD), COHORT_ALLOW_FILES="/")
    assert end.returncode == 2
    assert "controllers in Python require the Python package of Cohort" in end.stderr


@pytest.mark.parametrize("place", ["process", "inprocess"])
@pytest.mark.parametrize("source", [COUNTING, COUNTING_TOGETHER], ids=["each", "together"])
def test_a_run_continues_from_a_snapshot_with_the_state_of_controllers(cohort_program, write, domain, place, source):
    experiment = write(source)
    whole = hash_of(cohort_program, experiment)
    snapshot = experiment.with_name("snapshot")
    with cohort_program.running("run", experiment, "--quiet", "--paused", "--domain", domain):
        for request in (["step", "100"], ["save", snapshot]):
            cohort_program("ctl", "--domain", domain, "--timeout", str(PATIENCE), *request)
        cohort_program("ctl", "--domain", domain, "shutdown")
    assert hash_of(cohort_program, experiment, "--from", snapshot, "--controllers", place) == whole


@pytest.mark.parametrize("stateless", [False, True])
@pytest.mark.parametrize("base", ["Controller", "TeamController"])
def test_a_snapshot_names_controllers_without_save_unless_they_are_stateless(
    cohort_program, write, domain, base, stateless
):
    experiment = write(
        f"import cohort\nclass Idle(cohort.{base}):\n    stateless = {stateless}\n"
        "    def step(self, observation, command):\n        pass\n"
    )
    with cohort_program.running("run", experiment, "--quiet", "--paused", "--domain", domain):
        ctl = ["ctl", "--domain", domain, "--timeout", str(PATIENCE)]
        cohort_program(*ctl, "step", "2")
        saved = cohort_program(*ctl, "save", experiment.with_name("snapshot"))
        cohort_program(*ctl, "shutdown")
    assert ("team 'explorers'" in saved) == (not stateless), saved


def test_ctrl_c_ends_a_host_in_order(cohort_program, write, domain):
    experiment = write(FORWARD + "        if self.tick == 10: print('under way')\n", seconds=1e6)
    host = ["host", experiment.with_name("wanderer.py"), "--robots", "all", "--domain", domain]
    with (
        cohort_program.running("serve", experiment, "--quiet", "--domain", domain),
        cohort_program.running(*host) as process,
    ):
        assert process.stdout.readline() == "under way\n"
        process.send_signal(signal.SIGINT)
        assert end_of(process) == (130, "")
