# SPDX-License-Identifier: Apache-2.0

"""A Python program that keeps arrays, or ends while threads work, does not crash."""

import subprocess
import sys
import textwrap

import pytest
from conftest import PATIENCE


def end_of_program(text):
    """Runs a program and returns how it ended."""
    command = [sys.executable, "-c", textwrap.dedent(text)]
    return subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)


@pytest.mark.parametrize(
    ("controller", "shape"), [("Controller", "47"), ("TeamController", "(16, 47)")], ids=["one", "team"]
)
def test_arrays_that_a_controller_keeps_remain_valid(controller, shape):
    ended = end_of_program(f"""
        import gc, cohort, numpy
        kept = []
        class Keeper(cohort.{controller}):
            def step(self, observation, command):
                kept.append((observation, command))
        cohort.run("obstacle_avoidance", Keeper, duration=0.3)
        expected = [observation.copy() for observation, _ in kept]
        other = [numpy.full({shape}, 7.0) for _ in range(20000)]
        for _, command in kept:
            command.fill(1.0)
        del other
        other = [numpy.zeros(size) for size in range(2000)]
        gc.collect()
        assert all(numpy.array_equal(observation, copy) for (observation, _), copy in zip(kept, expected))
        print(len(kept), "kept")
        """)
    assert (ended.returncode, ended.stderr) == (0, "")
    assert ended.stdout.endswith(" kept\n")


@pytest.mark.parametrize(
    "work",
    [
        "cohort.Simulation('obstacle_avoidance').step(10**9)",
        "cohort.Batch('obstacle_avoidance', worlds=3, threads=2).step(10**9)",
        "cohort.run('obstacle_avoidance', duration=1e6)",
        "while True: cohort.Experiment.read('obstacle_avoidance')",
        "while True: cohort.Simulation('obstacle_avoidance').step(1)",
    ],
)
def test_python_ends_quietly_while_a_daemon_works(work):
    ended = end_of_program(f"""
        import threading, time, cohort
        begun = threading.Event()
        def work():
            begun.set()
            {work}
        threading.Thread(target=work, daemon=True).start()
        begun.wait()
        time.sleep(0.3)  # so that the work has begun: ending before would prove less, but not fail
        """)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "", "")


def test_objects_can_be_used_until_python_ends():
    ended = end_of_program("""
        import atexit
        def last():
            simulation.step(10)
            print(simulation.tick)
        atexit.register(last)
        import cohort
        simulation = cohort.Simulation("obstacle_avoidance")
        """)
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "10\n", "")
