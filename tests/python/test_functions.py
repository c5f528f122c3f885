# SPDX-License-Identifier: Apache-2.0

"""Functions with the same bits on every processor."""

import math
import subprocess
import sys

import cohort
import numpy
import pytest
from cohort._hosting import portable_calls

UNARY = ["sin", "cos", "tan", "asin", "acos", "atan", "exp", "exp2", "log", "log2", "log10"]
NUMBERS = numpy.linspace(0.001, 0.999, 1001)


@pytest.mark.parametrize("name", UNARY)
def test_functions_of_arrays_are_those_that_controllers_call(name):
    of_arrays = getattr(cohort.math, name)(NUMBERS)
    with portable_calls():
        of_numbers = [2.0**each if name == "exp2" else getattr(math, name)(each) for each in NUMBERS]
    assert of_arrays.tolist() == of_numbers
    assert getattr(cohort.math, name)(NUMBERS[3]) == of_numbers[3]


@pytest.mark.parametrize("name", UNARY)
def test_functions_agree_with_those_of_numpy(name):
    numpy.testing.assert_allclose(getattr(cohort.math, name)(NUMBERS), getattr(numpy, name)(NUMBERS), rtol=1e-15)


def test_functions_take_arrays_of_any_shape():
    assert cohort.math.sin(numpy.zeros((2, 3))).shape == (2, 3)
    assert cohort.math.atan2([[1.0], [2.0]], [1.0, 2.0, 3.0]).shape == (2, 3)
    assert cohort.math.pow(2, 10) == 1024.0


# The last bits of a thousand results show which functions were called.
USES_NUMBERS = """
import math, sys
def numbers():
    x = [0.001 + 0.0009991 * i for i in range(1000)]
    unary = [math.sin, math.cos, math.tan, math.asin, math.acos, math.atan, math.exp, math.log, math.log2, math.log10]
    return [f(each) for f in unary for each in x] + [each**0.3 for each in x] + [math.atan2(each, 0.3) for each in x]
before = numbers()
import cohort
assert numbers() == before, "import cohort changes the functions of the process"
class Idle(cohort.Controller):
    def start(self, start):
        Idle.numbers = numbers()
        Idle.sines = cohort.math.sin([0.001 + 0.0009991 * i for i in range(1000)]).tolist()
    def step(self, observation, command):
        pass
simulation = cohort.Simulation("obstacle_avoidance")
simulation.step()
assert numbers() == before, "a simulation changes the functions of the process"
with cohort._hosting.portable_calls():
    cohort.run("obstacle_avoidance", Idle, duration=0.05)
    assert numbers() == Idle.numbers
assert Idle.numbers[:1000] == Idle.sines
assert numbers() == before, "a run changes the functions of the process"
"""


def test_functions_of_the_process_stay_those_of_the_c_library():
    subprocess.run([sys.executable, "-c", USES_NUMBERS], check=True)


def test_functions_are_right_for_large_arguments():
    assert cohort.math.sin([1e15, 1e22, 1.2345e19]).tolist() == pytest.approx(
        [0.8582727931702359, -0.8522008497671888, 0.4079037766601177], rel=4e-16
    )
    with portable_calls():
        assert math.cos(1e50) == pytest.approx(cohort.math.cos(1e50), rel=0)
