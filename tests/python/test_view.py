# SPDX-License-Identifier: Apache-2.0

"""A simulation of a Python program, live in the page of `cohort view`."""

import asyncio
import json
import multiprocessing
import os
import pathlib
import re
import signal
import struct
import subprocess
import sys
import textwrap
import threading
import time
import types
import urllib.error
import urllib.request
import webbrowser

import cohort
import pytest
from conftest import PATIENCE
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from tornado.websocket import websocket_connect

PAGE = pathlib.Path(os.environ["COHORT_BUILD"]) / "share/cohort/view/index.html"
pytestmark = pytest.mark.skipif(not PAGE.exists(), reason="the page of the view was not built: it needs node and npm")

CRATE = """<sdf version='1.9'><model name='crate'><link name='body'><collision name='hull'><geometry><box>
<size>0.2 0.2 0.2</size></box></geometry></collision></link></model></sdf>"""
FRAMES_A_SECOND = 30


class Viewer:
    """A viewer that speaks the WebSocket protocol of Foxglove. One thread uses it."""

    def __init__(self, url, *topics):
        self._loop = asyncio.new_event_loop()
        address = url.replace("http:", "ws:")
        self._socket = self._wait(websocket_connect, address, subprotocols=["foxglove.websocket.v1"])
        self._channels = {}
        while not self._channels:
            message = json.loads(self._wait(self._socket.read_message))
            if message["op"] == "advertise":
                self._channels = {each["topic"]: each for each in message["channels"]}
        self._types = get_typestore(Stores.ROS2_HUMBLE)
        subscriptions = [
            {"id": number, "channelId": self._channels[topic]["id"]} for number, topic in enumerate(topics)
        ]
        self._topics = topics
        for topic in topics:
            self._types.register(
                get_types_from_msg(self._channels[topic]["schema"], self._channels[topic]["schemaName"])
            )
        self._send({"op": "subscribe", "subscriptions": subscriptions})

    def __enter__(self):
        return self

    def __exit__(self, *_):
        async def close():
            self._socket.close()

        self._wait(close)
        self._loop.close()

    def _wait(self, begin, *arguments, **options):
        async def patiently():
            return await asyncio.wait_for(begin(*arguments, **options), PATIENCE)

        return self._loop.run_until_complete(patiently())

    def _send(self, message):
        self._wait(self._socket.write_message, json.dumps(message))

    def next(self):
        """Returns the next message and its topic."""
        while True:
            message = self._wait(self._socket.read_message)
            assert message is not None, "the view has ended the connection"
            if isinstance(message, bytes) and message[0] == 1:
                topic = self._topics[struct.unpack_from("<I", message, 1)[0]]
                return topic, self._types.deserialize_cdr(message[13:], self._channels[topic]["schemaName"])

    def until(self, topic, holds):
        """Returns the first message of a topic of which something holds."""
        while True:
            found, message = self.next()
            if found == topic and holds(message):
                return message

    def frame(self, tick):
        return self.until("/cohort/frame", lambda frame: frame.tick == tick)

    def ask(self, request):
        """Returns the answer of the service `/cohort/control`."""
        payload = json.dumps(request).encode()
        head = struct.pack("<BIII", 2, 1, 7, 4) + b"json"
        self._wait(self._socket.write_message, head + payload, binary=True)
        while True:
            message = self._wait(self._socket.read_message)
            if isinstance(message, bytes) and message[0] == 3:
                return json.loads(message[message.index(b"{") :])


@pytest.fixture
def simulation():
    simulation = cohort.Simulation("obstacle_avoidance", seed=1)
    simulation.commands[:, simulation.robots[0].command_channels.indices("treel/*/velocity", 2)] = 0.1
    return simulation


@pytest.fixture
def view(simulation):
    with simulation.view(port=0) as view:
        yield view


def page_of(view):
    with urllib.request.urlopen(view.url, timeout=PATIENCE) as response:
        return response.headers, response.read()


def test_the_page_of_the_view_is_served_to_this_machine(view):
    headers, page = page_of(view)
    assert page == PAGE.read_bytes()
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/", view.url)
    assert "frame-ancestors http://127.0.0.1:* http://localhost:*" in headers["Content-Security-Policy"]
    assert repr(view) == f"<cohort.View of obstacle_avoidance: {view.url}>"


def test_viewers_get_the_scene_and_its_state_after_each_call(simulation, view):
    with Viewer(view.url, "/cohort/scene", "/cohort/frame", "/cohort/status") as viewer:
        scene = viewer.until("/cohort/scene", lambda _: True)
        assert [each.name for each in scene.entities] == simulation.objects
        first = viewer.frame(0)
        simulation.step(50)
        second = viewer.frame(50)
        assert second.state_hash == simulation.state_hash
        assert second.revision == first.revision == scene.revision
        assert (second.positions != first.positions).any()
        paused = viewer.until("/cohort/status", lambda status: status.time_ns > 0 and not status.is_playing)
        assert (paused.source, paused.name) == ("program", "obstacle_avoidance")
        simulation.set_pose(simulation.robots[0].name, [0.5, 0.5, 0.1])
        moved = viewer.until("/cohort/frame", lambda frame: (frame.positions != second.positions).any())
        assert moved.tick == 50


def test_viewers_see_the_progress_of_a_long_call(simulation, view):
    ticks = []

    def look():
        try:
            with Viewer(view.url, "/cohort/frame") as viewer:
                while len(set(ticks)) < 5:
                    ticks.append(viewer.next()[1].tick)
        finally:
            os.kill(os.getpid(), signal.SIGINT)

    looking = threading.Thread(target=look)
    looking.start()
    with pytest.raises(KeyboardInterrupt):
        simulation.step(1_000_000_000)
    looking.join()
    assert len(set(ticks)) == 5
    assert ticks == sorted(ticks)
    assert simulation.tick >= ticks[-1]


def test_a_loop_of_short_calls_shows_at_most_30_frames_a_second_and_the_last(simulation, view):
    steps = 2000
    with Viewer(view.url, "/cohort/frame") as viewer:
        viewer.frame(0)
        begin = time.monotonic()
        for _ in range(steps):
            simulation.step()
        frames = 1
        while viewer.next()[1].tick != steps:
            frames += 1
        assert frames <= 2 + (time.monotonic() - begin) * FRAMES_A_SECOND


def test_added_robots_and_restarted_worlds_are_shown(simulation, view):
    with Viewer(view.url, "/cohort/scene", "/cohort/frame") as viewer:
        scene = viewer.until("/cohort/scene", lambda _: True)
        saved = simulation.save()
        name = simulation.spawn(CRATE, [0.3, 0.3, 1.0], name="crate")
        crate = viewer.until("/cohort/scene", lambda each: len(each.entities) == len(scene.entities) + 1)
        assert crate.entities[-1].name == name
        robot = simulation.spawn("sbot", [1.0, 1.0, 0.1], name="newcomer")
        came = viewer.until("/cohort/scene", lambda each: len(each.entities) == len(scene.entities) + 2)
        assert came.entities[-1].name == robot
        simulation.step(7)
        run = viewer.frame(7).run
        simulation.reset()
        again = viewer.until("/cohort/frame", lambda frame: frame.run == run + 1)
        assert again.tick == 0 and again.state_hash == simulation.state_hash
        simulation.restore(saved)
        restored = viewer.until("/cohort/frame", lambda frame: frame.run == run + 2)
        assert restored.state_hash == simulation.state_hash
        simulation.step(3)
        assert viewer.frame(3).state_hash == simulation.state_hash


def test_a_robot_that_is_watched_shows_what_it_observes(simulation, view):
    with Viewer(view.url, "/cohort/robots") as viewer:
        assert viewer.ask({"operation": "watch", "numbers": [3]})["done"]
        simulation.step(5)
        shown = viewer.until("/cohort/robots", lambda each: len(each.robots) and each.robots[0].tick == 5).robots[0]
        assert shown.robot == 3
        assert list(shown.observation) == pytest.approx(list(simulation.robots[3].observation), rel=1e-6)


def test_requests_of_viewers_are_refused(simulation, view):
    with Viewer(view.url, "/cohort/frame") as viewer:
        for operation in ("play", "pause", "step", "reset"):
            answer = viewer.ask({"operation": operation})
            assert not answer["done"]
            assert f"'{operation}'" in answer["text"] and "the Python program that steps this world" in answer["text"]
    assert simulation.tick == 0


def test_a_view_changes_no_bit(simulation, view):
    stopped = threading.Event()

    def look():
        with Viewer(view.url, "/cohort/frame", "/cohort/contacts", "/tf") as viewer:
            while not stopped.is_set():
                viewer.next()

    alone = cohort.Simulation("obstacle_avoidance", seed=1)
    alone.commands[:] = simulation.commands
    looking = threading.Thread(target=look)
    looking.start()
    for _ in range(100):
        simulation.step(10)
        alone.step(10)
        assert simulation.state_hash == alone.state_hash
    stopped.set()
    simulation.step()  # so that something comes
    looking.join()


def test_two_simulations_are_shown_at_once(simulation, view):
    other = cohort.Simulation("phototaxis", seed=1)
    with other.view(port=0) as other_view:
        assert other_view.port != view.port
        with Viewer(view.url, "/cohort/frame") as viewer, Viewer(other_view.url, "/cohort/frame") as other_viewer:
            simulation.step(4)
            other.step(6)
            assert viewer.frame(4).state_hash == simulation.state_hash
            assert other_viewer.frame(6).state_hash == other.state_hash
    assert page_of(view)


def test_a_port_is_free_again_after_close(simulation, view):
    other = cohort.Simulation("obstacle_avoidance")
    with Viewer(view.url, "/cohort/frame") as viewer:
        viewer.next()
        with pytest.raises(RuntimeError, match=f"cannot listen on 127.0.0.1, port {view.port}: .*choose another port"):
            other.view(port=view.port)
        view.close()
    with pytest.raises(urllib.error.URLError):
        page_of(view)
    assert view.closed and "closed" in repr(view) and "iframe" not in view._repr_html_()
    view.close()
    with other.view(port=view.port) as again:
        assert page_of(again)
    simulation.step()


def test_without_a_port_the_usual_one_or_any_free_one_is_taken():
    first = cohort.Simulation("obstacle_avoidance")
    second = cohort.Simulation("obstacle_avoidance")
    with first.view() as one, second.view() as other:
        assert one.port != other.port
        assert page_of(one) and page_of(other)


def test_a_simulation_has_one_view_as_long_as_it_is_open(simulation, view):
    assert simulation.view() is view
    assert simulation.view(port=view.port) is view
    with pytest.raises(ValueError, match=f"the simulation already has a view at {view.url}"):
        simulation.view(port=view.port % 65535 + 1)
    view.close()
    with simulation.view(port=0) as another:
        assert another is not view
        with Viewer(another.url, "/cohort/frame") as viewer:
            simulation.step(3)
            viewer.frame(3)


def test_an_invalid_port_is_an_error(simulation):
    with pytest.raises(ValueError, match="port is 70000, expected 0 to 65535"):
        simulation.view(port=70000)


def test_a_view_may_be_closed_while_the_program_steps(simulation, view):
    def close_by_thread():
        view.close()
        os.kill(os.getpid(), signal.SIGINT)

    def close_in_handler(*_):
        view.close()
        raise KeyboardInterrupt

    before = signal.signal(signal.SIGUSR1, close_in_handler)
    try:
        for closing in (close_by_thread, lambda: os.kill(os.getpid(), signal.SIGUSR1)):
            timer = threading.Timer(0.1, closing)
            timer.start()
            with pytest.raises(KeyboardInterrupt):
                simulation.step(1_000_000_000)
            timer.join()
            assert view.closed
            view = simulation.view(port=0)
    finally:
        signal.signal(signal.SIGUSR1, before)
        view.close()


def drop_in_child(held, answers):
    held[0].view().close()
    held.clear()
    answers.put("dropped")


def test_a_view_continues_when_a_forked_process_drops_its_copy():
    held = [cohort.Simulation("obstacle_avoidance")]
    view = held[0].view(port=0)
    url = view.url
    del view  # so that the child destroys it
    context = multiprocessing.get_context("fork")
    answers = context.Queue()
    child = context.Process(target=drop_in_child, args=(held, answers))
    child.start()
    try:
        assert answers.get(timeout=PATIENCE) == "dropped"
    finally:
        child.kill()
        child.join()
    with Viewer(url, "/cohort/frame") as viewer:
        held[0].step(2)
        viewer.frame(2)


@pytest.mark.parametrize(
    "ending",
    [
        "simulation.view(port=0)",
        "view = simulation.view(port=0); del simulation; view.url",
        "import builtins; builtins.kept = simulation.view(port=0)",
    ],
)
def test_an_open_view_does_not_keep_the_process_alive(ending):
    program = f"""
        import cohort
        simulation = cohort.Simulation("obstacle_avoidance")
        simulation.step(3)
        {ending}
        print("done")
    """
    ended = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, timeout=PATIENCE
    )
    assert (ended.returncode, ended.stdout, ended.stderr) == (0, "done\n", "")


def test_a_view_ends_with_an_unused_simulation():
    simulation = cohort.Simulation("obstacle_avoidance")
    url = simulation.view(port=0).url
    del simulation
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(url, timeout=PATIENCE)


def test_a_view_without_its_page_says_how_to_build_it(simulation, monkeypatch, tmp_path):
    monkeypatch.setattr(cohort._files, "worlds_folder", lambda: tmp_path / "worlds")
    with pytest.raises(FileNotFoundError, match="node 18 and npm .*--target view_page"):
        simulation.view()


def test_a_browser_is_opened_only_outside_of_jupyter(simulation, view, monkeypatch):
    opened = []
    monkeypatch.setattr(webbrowser, "open", lambda url: opened.append(url) is None)
    assert simulation.view(open=True) is view
    assert opened == [view.url]
    monkeypatch.setattr(webbrowser, "open", lambda url: False)
    with pytest.warns(UserWarning, match=f"open {view.url} yourself"):
        simulation.view(open=True)
    shell = types.SimpleNamespace(kernel=object())
    monkeypatch.setitem(sys.modules, "IPython", types.SimpleNamespace(get_ipython=lambda: shell))
    assert f'<iframe src="{view.url}"' in simulation.view(open=True)._repr_html_()
