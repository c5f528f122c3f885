# SPDX-License-Identifier: Apache-2.0

"""sin, exp, pow and similar functions for numbers and arrays, with bit-identical results on every processor.

NumPy selects its implementations by the processor, so that results may differ in the last bit. The functions of this
module are those that the simulation and C++ controllers use, accurate to 2 units in the last place. Angles are in
radians. Arguments and results are float64: numbers, or arrays of any shape.
"""

import numpy

from cohort._native import functions as _functions

__all__ = ["acos", "asin", "atan", "atan2", "cos", "exp", "exp2", "log", "log10", "log2", "pow", "sin", "tan"]


def _apply(function, *arguments):
    arrays = numpy.broadcast_arrays(*(numpy.asarray(each, dtype=numpy.float64) for each in arguments))
    results = function(*(numpy.ascontiguousarray(each).ravel() for each in arrays)).reshape(arrays[0].shape)
    return float(results) if results.ndim == 0 else results


def sin(x):
    """Returns the sine of x [rad]."""
    return _apply(_functions.sin, x)


def cos(x):
    """Returns the cosine of x [rad]."""
    return _apply(_functions.cos, x)


def tan(x):
    """Returns the tangent of x [rad]."""
    return _apply(_functions.tan, x)


def asin(x):
    """Returns the arc sine of x, from -pi/2 to pi/2 [rad]."""
    return _apply(_functions.asin, x)


def acos(x):
    """Returns the arc cosine of x, from 0 to pi [rad]."""
    return _apply(_functions.acos, x)


def atan(x):
    """Returns the arc tangent of x, from -pi/2 to pi/2 [rad]."""
    return _apply(_functions.atan, x)


def atan2(y, x):
    """Returns the angle of the point (x, y) from the x axis, from -pi to pi [rad]."""
    return _apply(_functions.atan2, y, x)


def exp(x):
    """Returns e to the power x."""
    return _apply(_functions.exp, x)


def exp2(x):
    """Returns 2 to the power x."""
    return _apply(_functions.exp2, x)


def log(x):
    """Returns the natural logarithm of x."""
    return _apply(_functions.log, x)


def log2(x):
    """Returns the logarithm of x to the base 2."""
    return _apply(_functions.log2, x)


def log10(x):
    """Returns the logarithm of x to the base 10."""
    return _apply(_functions.log10, x)


def pow(x, y):
    """Returns x to the power y."""
    return _apply(_functions.pow, x, y)
