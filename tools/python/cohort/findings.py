# SPDX-License-Identifier: Apache-2.0

"""Results of replays and comparisons of recordings."""

import dataclasses
import typing


@dataclasses.dataclass(frozen=True)
class Verification:
    """The result of a replay of a recording. Its truth value is True if all ticks are identical.

    Attributes:
        ticks: number of identical ticks.
        tick, time: the first tick that differs, and its time in the recording [s]; None if no tick differs.
        recorded, replayed: state hashes of that tick; None if no tick differs.
        problem: reason why the replay ended before the recording; empty if it did not.
    """

    ticks: int
    tick: typing.Optional[int] = None
    time: typing.Optional[float] = None
    recorded: typing.Optional[int] = None
    replayed: typing.Optional[int] = None
    problem: str = ""

    @property
    def is_identical(self):
        """True if the state at every tick is identical to the recorded state."""
        return self.ticks > 0 and self.tick is None and not self.problem

    def __bool__(self):
        return self.is_identical

    def __str__(self):
        before = f"{self.ticks} identical ticks"
        if self.is_identical:
            return f"identical, {self.ticks} ticks"
        if self.tick is not None:
            hashes = f"recorded {self.recorded:016x}, replayed {self.replayed:016x}"
            return f"differs at tick {self.tick} ({self.time:.3f} s), after {before}: {hashes}"
        return f"ends after {before}: {self.problem}" if self.problem else "nothing to compare"


class Difference(typing.NamedTuple):
    """A quantity that differs between two runs.

    `object` is a scoped name, empty for the world as a whole. `quantity` is `command`, `action`, `pose`, `velocity`,
    `joint`, `contact`, `observation`, `presence` or `state`. `detail` is a part of the quantity, such as a channel.
    `first` and `second` are its values in the two runs, as strings.
    """

    object: str
    quantity: str
    detail: str
    first: str
    second: str

    def __str__(self):
        values = f"{self.first} | {self.second}" if self.second else self.first
        return f"{self.quantity:<12} {self.object or 'the world':<24} {self.detail}: {values}"


@dataclasses.dataclass(frozen=True)
class Comparison:
    """The first difference between two recordings. `print` shows it like `cohort diff`.

    Attributes:
        ticks: number of identical ticks at the beginning.
        tick, time: the first tick that differs, and its time in the recording [s]; None if no tick differs.
        differences: the first differences at that tick, a list of `Difference`.
        more: number of further differences at that tick.
        ends: a sentence that says which recording ends before the other; empty if neither does.
    """

    ticks: int
    tick: typing.Optional[int] = None
    time: typing.Optional[float] = None
    differences: list = dataclasses.field(default_factory=list)
    more: int = 0
    ends: str = ""

    @property
    def are_identical(self):
        """True if both recordings contain the same run to its end."""
        return self.tick is None and not self.ends

    def __str__(self):
        if self.tick is None:
            same = f"identical, {self.ticks} ticks"
            return f"{self.ends}; until then, they are {same}" if self.ends else same
        lines = [f"they diverge at tick {self.tick} ({self.time:.3f} s), after {self.ticks} identical ticks"]
        lines += [f"  {each}" for each in self.differences]
        return "\n".join(lines + ([f"  and {self.more} more"] if self.more else []))
