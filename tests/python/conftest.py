import os
import pathlib
import subprocess

import pytest


@pytest.fixture(scope="session")
def build():
    """The folder of the build that is tested."""
    return pathlib.Path(os.environ["COHORT_BUILD"])


@pytest.fixture(scope="session")
def cohort_program(build):
    """Runs `cohort` with arguments and returns what it prints."""

    def run(*arguments):
        program = build / "bin/cohort"
        return subprocess.run([program, *arguments], check=True, capture_output=True, text=True).stdout

    return run
