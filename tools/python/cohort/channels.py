# SPDX-License-Identifier: Apache-2.0

"""Channels: the named parts of a robot's observation and command."""

from __future__ import annotations

import dataclasses
import difflib
import re
from collections.abc import Iterable, Iterator

import numpy


class ChannelError(LookupError):
    """The error that no channel has the given name, or that no or the wrong number of channels match."""


@dataclasses.dataclass(frozen=True)
class Channel:
    """A named part of a robot's observation or command.

    Attributes:
        name: `device/index/quantity`, such as `proximity/3/reading`.
        unit: SI unit; `1` if dimensionless.
        offset: index of its first value among the robot's values.
        size: number of values.
        lower, upper: bounds; infinite if there are none.
        neutral: value of a command until it is set.
    """

    name: str
    unit: str
    offset: int
    size: int
    lower: float
    upper: float
    neutral: float


class Channels:
    """The channels of a robot's observation or command, in the order of their values."""

    def __init__(self, tuples: Iterable[tuple]) -> None:
        self._all = tuple(Channel(*each) for each in tuples)
        self._by_name = {each.name: each for each in self._all}

    def __iter__(self) -> Iterator[Channel]:
        return iter(self._all)

    def __len__(self) -> int:
        return len(self._all)

    def __getitem__(self, name: str) -> Channel:
        """Returns the channel with this name. Raises ChannelError if there is none."""
        channel = self._by_name.get(name)
        if channel is None:
            near = difflib.get_close_matches(name, self._by_name, n=4, cutoff=0.3)
            raise ChannelError(f"unknown channel '{name}'" + (f"; the nearest are {', '.join(near)}" if near else ""))
        return channel

    def __contains__(self, name: str) -> bool:
        return name in self._by_name

    def __repr__(self) -> str:
        return "Channels(" + ", ".join(self._by_name) + ")"

    @property
    def size(self) -> int:
        """Number of values of all channels."""
        return sum(each.size for each in self._all)

    @property
    def lower(self) -> numpy.ndarray:
        """Lower bound of each value, an array [value]; -inf if there is none."""
        return numpy.concatenate([numpy.full(each.size, each.lower) for each in self._all] or [numpy.empty(0)])

    @property
    def upper(self) -> numpy.ndarray:
        """Upper bound of each value, an array [value]; inf if there is none."""
        return numpy.concatenate([numpy.full(each.size, each.upper) for each in self._all] or [numpy.empty(0)])

    def index(self, name: str) -> int | slice:
        """Returns the index of a channel: an int if it has one value, otherwise a slice.

        Raises ChannelError if there is none.
        """
        channel = self[name]
        return channel.offset if channel.size == 1 else slice(channel.offset, channel.offset + channel.size)

    def indices(self, pattern: str, count: int | None = None) -> slice | numpy.ndarray:
        """Returns the indices of the values of all channels whose names match a pattern.

        `*` matches any characters except `/`. The result is a slice if the indices are consecutive, so that indexing
        returns a view; otherwise, it is an array of int. Raises ChannelError if no channel matches, or if `count` is
        given and is not the number of matches.
        """
        expression = re.compile("[^/]*".join(re.escape(each) for each in pattern.split("*")) + r"\Z")
        found = [each for each in self._all if expression.match(each.name)]
        if not found:
            raise ChannelError(f"no channel matches '{pattern}'; known: {', '.join(self._by_name)}")
        if count is not None and len(found) != count:
            raise ChannelError(f"{len(found)} channels match '{pattern}', expected {count}")
        places = [place for each in found for place in range(each.offset, each.offset + each.size)]
        if places[-1] - places[0] == len(places) - 1:
            return slice(places[0], places[-1] + 1)
        return numpy.array(places)
