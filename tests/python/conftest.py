# SPDX-License-Identifier: Apache-2.0
import contextlib
import fcntl
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

import pytest

PATIENCE = 300  # [s] for what should happen soon


class Program:
    """The program `cohort`, which finds the Python that runs the tests."""

    def __init__(self, path):
        self.path = path
        self._environment = os.environ | {"COHORT_PYTHON": sys.executable}

    def __call__(self, *arguments):
        """Runs it and returns what it prints."""
        return self.end_of(*arguments, check=True).stdout

    def end_of(self, *arguments, check=False, **environment):
        """Runs it and returns how it ended."""
        command = [self.path, *map(str, arguments)]
        environment = self._environment | environment
        return subprocess.run(command, check=check, capture_output=True, text=True, env=environment, timeout=PATIENCE)

    @contextlib.contextmanager
    def running(self, *arguments):
        """A process that runs it, and is killed if it has not ended by then."""
        command = [self.path, *map(str, arguments)]
        pipe = subprocess.PIPE
        with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, env=self._environment) as process:
            try:
                yield process
            finally:
                process.kill()


def end_of(process):
    """Waits for a process and returns its exit code and what it has written to standard error."""
    _, errors = process.communicate(timeout=PATIENCE)
    return process.returncode, errors


@pytest.fixture(scope="session")
def build():
    """The folder of the build that is tested."""
    return pathlib.Path(os.environ["COHORT_BUILD"])


@pytest.fixture(scope="session")
def cohort_program(build):
    """Runs `cohort` with arguments and returns what it prints: a `Program`."""
    return Program(build / "bin/cohort")


@pytest.fixture
def domain():
    """A DDS domain that no other test of this machine has."""
    patience = 300
    for _ in range(patience):
        for number in range(75, 80):
            with open(pathlib.Path(tempfile.gettempdir()) / f"cohort-test-domain-{number}", "a") as lock:
                try:
                    fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except BlockingIOError:
                    continue
                yield number
                return
        time.sleep(1)  # until another test is done
    raise TimeoutError("all domains for tests are taken")


@pytest.fixture
def serve(build, domain, tmp_path):
    """Starts `cohort run` of an experiment whose controllers others start; what it returns waits for the end."""
    processes = []

    def start(experiment, *arguments):
        summary = tmp_path / "served.json"
        command = [build / "bin/cohort", "run", experiment, "--controllers", "external", "--domain", str(domain)]
        process = subprocess.Popen(
            [*command, "--quiet", "--summary", summary, *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        processes.append(process)

        def finish():
            _, errors = process.communicate(timeout=300)
            return Served(process.returncode, errors, json.loads(summary.read_text()) if summary.exists() else {})

        return finish

    yield start
    for process in processes:
        process.kill()
        process.communicate()


class Served:
    def __init__(self, code, errors, summary):
        self.code = code
        self.errors = errors
        self.state_hash = int(summary.get("state_hash", "0"), 16)

    def __repr__(self):
        return f"<served run: exit code {self.code}, {self.errors!r}>"
