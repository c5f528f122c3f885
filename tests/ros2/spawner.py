# SPDX-License-Identifier: Apache-2.0

"""A node that adds and removes robots of a run of turtlebot3, drives them, prints what differs, and ends the server.

- spawner.py drive: drives a robot that it adds, while another one that it adds has no driver.
- spawner.py random SEED COUNT: adds and removes robots COUNT times, while it drives all of them.
"""

import random
import sys
import time

import rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.node import Node
from service_calls import PATIENCE, caller_of
from simulation_interfaces import srv

OK, PAUSED, QUITTING = 1, 2, 3

rclpy.init()
node = Node("spawner")
call = caller_of(node)
differences = 0


def expect(what: str, value, expected) -> None:
    global differences
    if value != expected:
        differences += 1
        print(f"{what}: {value}, expected {expected}", flush=True)


def expect_done(what: str, response) -> None:
    expect(f"{what} ({response.result.error_message})", response.result.result, OK)


def wait_until(what: str, is_so) -> None:
    end = time.monotonic() + PATIENCE
    while not is_so():
        if time.monotonic() > end:
            expect(what, False, True)
            return
        rclpy.spin_once(node, timeout_sec=0.02)


def spawn(name: str, x: float, y: float, uri: str = "turtlebot3") -> None:
    request = srv.SpawnEntity.Request(name=name)
    getattr(request, "entity_resource", request).uri = uri
    request.initial_pose.pose.position.x, request.initial_pose.pose.position.y = x, y
    expect_done(f"spawn {name}", call("SpawnEntity", request))


def delete(name: str) -> None:
    expect_done(f"delete {name}", call("DeleteEntity", srv.DeleteEntity.Request(entity=name)))


def set_run_state(state: int) -> None:
    request = srv.SetSimulationState.Request()
    request.state.state = state
    expect_done(f"state {state}", call("SetSimulationState", request))


def step(count: int) -> None:
    expect_done(f"{count} steps", call("StepSimulation", srv.StepSimulation.Request(steps=count)))


def position_of(name: str) -> tuple[float, float]:
    position = call("GetEntityState", srv.GetEntityState.Request(entity=name)).state.pose.position
    return position.x, position.y


def topics() -> set[str]:
    return {name for name, _ in node.get_topic_names_and_types()}


class Driver:
    """Drives a robot ahead, and knows how far its odometry says that it has come."""

    def __init__(self, prefix: str):
        self.way = 0.0
        self.publisher = node.create_publisher(Twist, f"{prefix}/cmd_vel", 10)
        self.subscription = node.create_subscription(Odometry, f"{prefix}/odom", self.note, 10)
        self.timer = node.create_timer(0.05, self.drive)

    def drive(self) -> None:
        command = Twist()
        command.linear.x = 0.2
        self.publisher.publish(command)

    def note(self, odometry) -> None:
        self.way = odometry.pose.pose.position.x

    def end(self) -> None:
        node.destroy_timer(self.timer)
        node.destroy_publisher(self.publisher)
        node.destroy_subscription(self.subscription)


def drive() -> None:
    spawn("second", 1.0, -1.2)
    second = Driver("/second")
    wait_until("second drives", lambda: second.way > 0.05)
    expect("its way in the world", position_of("second")[0] > 1.03, True)
    spawn("third", 1.0, 1.2, "turtlebot3?undriven")
    set_run_state(PAUSED)
    before = position_of("third")
    step(10)
    expect("third stands", abs(position_of("third")[0] - before[0]) < 1e-3, True)
    expect("third has topics", any(name.startswith("/third/") for name in topics()), False)
    second.end()
    delete("second")
    wait_until("second has no topics", lambda: not any(name.startswith("/second/") for name in topics()))
    step(10)


def spawn_randomly(seed: int, count: int) -> None:
    draw = random.Random(seed)
    drivers = {"turtlebot3": Driver("")}
    wait_until("turtlebot3 drives", lambda: drivers["turtlebot3"].way > 0.02)
    for number in range(count):
        names = [name for name in drivers if name != "turtlebot3"]
        if names and (len(names) == 6 or draw.random() < 0.5):
            name = draw.choice(names)
            delete(name)
            drivers.pop(name).end()
        else:
            name = f"robot{number}"
            spawn(name, draw.uniform(-2.0, 2.0), draw.uniform(-2.0, 2.0))
            drivers[name] = Driver(f"/{name}")
        if draw.random() < 0.3:
            way = drivers["turtlebot3"].way
            wait_until("turtlebot3 drives on", lambda way=way: drivers["turtlebot3"].way != way)


if sys.argv[1] == "drive":
    drive()
else:
    spawn_randomly(int(sys.argv[2]), int(sys.argv[3]))
set_run_state(QUITTING)
sys.exit(differences > 0)
