# SPDX-License-Identifier: Apache-2.0

"""Controllers in Python that drive robots of a server."""

import json
import pathlib
import signal
import subprocess
import sys

import cohort
import pytest
from obstacle_avoidance_in_python import ObstacleAvoidance

SCRIPT = pathlib.Path(__file__).parent / "obstacle_avoidance_in_python.py"
EXPERIMENT = "obstacle_avoidance"


def start_program(domain, robots):
    return subprocess.Popen(
        [sys.executable, SCRIPT, "--robots", robots, "--domain", str(domain)], stderr=subprocess.PIPE, text=True
    )


def test_one_process_gives_the_hash_of_the_twin_in_cpp(serve, domain):
    finish = serve(EXPERIMENT, "--duration", "10")
    cohort.host(ObstacleAvoidance, domain=domain)
    assert finish().state_hash == cohort.run(EXPERIMENT, duration=10).state_hash


def test_several_programs_give_the_same_hash(serve, domain):
    finish = serve(EXPERIMENT, "--duration", "5")
    programs = [start_program(domain, robots) for robots in ("0..4", "5..11", "12..15")]
    served = finish()
    assert [program.wait(timeout=300) for program in programs] == [0, 0, 0]
    assert served.state_hash == cohort.run(EXPERIMENT, duration=5).state_hash


class Raises(cohort.Controller):
    def step(self, observation, command):
        raise LookupError("no such thing")


def test_an_exception_ends_the_run_with_its_line(serve, domain):
    finish = serve(EXPERIMENT, "--duration", "5")
    with pytest.raises(cohort.ClientError, match="test_clients.py:.* in step: LookupError: no such thing"):
        cohort.host(Raises, domain=domain)
    assert "LookupError: no such thing" in finish().errors


def test_an_interrupted_program_ends_in_order(serve, domain, cohort_program):
    serve(EXPERIMENT, "--duration", "1000000")
    programs = [start_program(domain, robots) for robots in ("0..14", "15")]
    while json.loads(cohort_program("ctl", "status", "--json", "--domain", str(domain)))["tick"] == 0:
        pass
    for program in programs:
        program.send_signal(signal.SIGINT)
    assert [program.wait(timeout=300) for program in programs] == [130, 130]


def test_unknown_robots_are_refused(serve, domain):
    serve(EXPERIMENT, "--duration", "5")
    with pytest.raises(cohort.ClientError, match="refused.*99"):
        cohort.host(ObstacleAvoidance, robots="99", domain=domain)


def test_an_invalid_option_is_named(capfd):
    with pytest.raises(SystemExit) as ended:
        cohort.main(ObstacleAvoidance, ["--robot", "0"])
    assert ended.value.code == 2
    assert "ObstacleAvoidance: unknown option '--robot'" in capfd.readouterr().err
