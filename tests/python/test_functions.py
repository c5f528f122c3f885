"""Functions with the same bits on every processor."""

import math

import cohort
import numpy
import pytest

UNARY = ["sin", "cos", "tan", "asin", "acos", "atan", "exp", "exp2", "log", "log2", "log10"]
NUMBERS = numpy.linspace(0.001, 0.999, 1001)


@pytest.mark.parametrize("name", UNARY)
def test_functions_of_arrays_are_those_of_the_process(name):
    of_arrays = getattr(cohort.math, name)(NUMBERS)
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
