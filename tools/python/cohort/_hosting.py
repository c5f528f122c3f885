# SPDX-License-Identifier: Apache-2.0

"""Functions that C++ calls to run controllers written in Python."""

import contextlib
import importlib.util
import pathlib
import sys
import traceback

import numpy

from cohort import _native
from cohort.controller import Controller, ParameterError, Start, TeamController


@contextlib.contextmanager
def portable_calls():
    """Has `math.sin` and similar functions of this process be those of Cohort, for controllers that call them."""
    _native.bind_process_calls()
    try:
        yield
    finally:
        _native.release_process_calls()


class Adapter:
    """One robot's controller. C++ also uses the memory of `observation` and `command`."""

    __slots__ = ("_controller", "_command", "_observation", "_start")

    def __init__(self, make):
        self._controller = make()
        if not isinstance(self._controller, Controller):
            raise TypeError(f"{make!r} returned a {type(self._controller).__name__}, expected a cohort.Controller")

    def start(self, facts, observation, command):
        self._observation = numpy.frombuffer(observation, dtype=numpy.float64)
        self._command = numpy.frombuffer(command, dtype=numpy.float64)
        self._start = Start(facts)
        self._controller.robot = self._start
        self._controller.tick = self._start.tick
        self._controller.time = self._start.tick * self._start.step
        self._controller.start(self._start)
        return list(self._start.parameters.asked)

    def step(self, tick, nanoseconds):
        controller = self._controller
        controller.tick = tick
        controller.time = nanoseconds * 1e-9
        controller.step(self._observation, self._command)

    def save(self):
        return _checked_state(self._controller.save())

    def load(self, state):
        self._controller.load(state)


class TeamAdapter:
    """The controller of all robots of a process. C++ also uses the memory of `observations` and `commands`."""

    __slots__ = ("_commands", "_controller", "_observations")

    def __init__(self, make):
        self._controller = make()

    def start(self, facts, observations, commands):
        robots = [Start(each) for each in facts]
        self._observations = numpy.frombuffer(observations, dtype=numpy.float64).reshape(len(robots), -1)
        self._commands = numpy.frombuffer(commands, dtype=numpy.float64).reshape(len(robots), -1)
        controller = self._controller
        controller.robots = robots
        controller.tick = robots[0].tick
        controller.time = robots[0].tick * robots[0].step
        controller.start(robots)
        return sorted(set().union(*(each.parameters.asked for each in robots)))

    def step(self, tick, nanoseconds, rows):
        controller = self._controller
        controller.tick = tick
        controller.time = nanoseconds * 1e-9
        if rows is None:
            controller.asked = slice(None)
            controller.step(self._observations, self._commands)
        else:
            controller.asked = numpy.array(rows)
            controller.step(self._observations[: len(rows)], self._commands[: len(rows)])

    def save(self):
        return _checked_state(self._controller.save())

    def load(self, state):
        self._controller.load(state)


def _checked_state(state):
    if state is not None and not isinstance(state, bytes):
        raise TypeError(
            f"save() returned a {type(state).__name__}, expected bytes, or None if the state cannot be saved"
        )
    return state


class Maker:
    """Makes adapters for controllers of one class."""

    def __init__(self, controller):
        self.controller = controller
        self.name = getattr(controller, "__name__", str(controller))
        self.drives_all = isinstance(controller, type) and issubclass(controller, TeamController)

    def __call__(self):
        return (TeamAdapter if self.drives_all else Adapter)(self.controller)


def controller_in(file):
    """Returns the controller class that a Python file defines. Raises ValueError unless there is exactly one."""
    path = pathlib.Path(file).resolve()
    if not path.is_file():
        raise ValueError(f"no such file: {path}")
    name = "cohort_controller_" + path.stem
    specification = importlib.util.spec_from_file_location(name, path)
    module = importlib.util.module_from_spec(specification)
    sys.modules[name] = module
    if str(path.parent) not in sys.path:
        sys.path.insert(0, str(path.parent))  # permanently, because it may import modules later
    with portable_calls():
        specification.loader.exec_module(module)
    classes = [
        value
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, (Controller, TeamController)) and value.__module__ == name
    ]
    if len(classes) != 1:
        found = ", ".join(sorted(each.__name__ for each in classes)) or "none"
        raise ValueError(f"{path}: expected one class derived from cohort.Controller, found: {found}")
    return classes[0]


def maker_in(file):
    return Maker(controller_in(file))


def maker_in_program(file):
    """Acts as `maker_in` in a program that embeds Python and exits without finalizing it: prints without buffering."""
    if sys.stdout is not None:
        sys.stdout.reconfigure(line_buffering=True)
    return maker_in(file)


def parameter_problem(error):
    """Returns the name of the wrong parameter and the problem, or None for another exception."""
    return (str(error.name), str(error.problem)) if isinstance(error, ParameterError) else None


def describe(error):
    """Returns an exception as one line: where it was raised, and its message."""
    here = f"{pathlib.Path(__file__).parent}/"
    frames = traceback.extract_tb(error.__traceback__)
    shown = [each for each in frames if not each.filename.startswith((here, "<frozen "))]
    places = [f"{pathlib.Path(each.filename).name}:{each.lineno} in {each.name}" for each in shown]
    if isinstance(error, SyntaxError) and error.filename:
        places.append(f"{pathlib.Path(error.filename).name}:{error.lineno}")
    said = "".join(traceback.format_exception_only(type(error), error)).strip().splitlines()
    return (", then ".join(places) + ": " if places else "") + (said[-1] if said else type(error).__name__)
