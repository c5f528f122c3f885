# SPDX-License-Identifier: Apache-2.0

"""Tables of recordings as arrays."""

import importlib

import numpy


def package(name, what):
    try:
        return importlib.import_module(name)
    except ImportError as error:
        raise ImportError(
            f"{what} requires the package {name}; install it, for example with `pip install {name}`"
        ) from error


class Table:
    """A table by columns: numbers in matrices [row, column], texts as indices into a list of the distinct texts."""

    def __init__(self, columns, reals, wholes, texts, values):
        self.columns = columns
        self.reals, self.wholes, self.texts = reals, wholes, texts
        self.values = values
        places = {"real": 0, "whole": 0, "text": 0}
        self._place = {}
        for name, kind, _ in columns:
            self._place[name] = (kind, places[kind])
            places[kind] += 1

    def codes(self, name):
        """Returns the indices of a text column's values in `values`, an array [row]."""
        return self.texts[:, self._place[name][1]]

    def column(self, name):
        kind, place = self._place[name]
        if kind == "text":
            return numpy.array(self.values, dtype=object)[self.texts[:, place]]
        return (self.reals if kind == "real" else self.wholes)[:, place]

    @property
    def run(self):
        return self.column("run")

    @property
    def time(self):
        return self.column("time")


def value_names(channels):
    """Returns (name, unit) of each value; the values of a channel with several are `NAME/0`, `NAME/1`, …"""
    return [(name if size == 1 else f"{name}/{place}", unit) for name, unit, size in channels for place in range(size)]


def times_of(tables):
    """Returns the distinct (run, time) of all tables in order, and for each table the index of each of its rows."""
    runs = numpy.concatenate([each.run for each in tables] or [numpy.empty(0, dtype=numpy.int64)])
    times = numpy.concatenate([each.time for each in tables] or [numpy.empty(0)])
    order = numpy.lexsort((times, runs))
    is_new = numpy.ones(len(order), dtype=bool)
    is_new[1:] = (numpy.diff(runs[order]) != 0) | (numpy.diff(times[order]) != 0)
    places = numpy.empty(len(order), dtype=numpy.int64)
    places[order] = numpy.cumsum(is_new) - 1
    first = order[is_new]
    ends = numpy.cumsum([len(each.time) for each in tables])
    return runs[first], times[first], numpy.split(places, ends[:-1]) if tables else []


class Rows:
    """Some rows of a table."""

    def __init__(self, table, rows):
        self.run, self.time = table.run[rows], table.time[rows]
