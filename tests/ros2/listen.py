# SPDX-License-Identifier: Apache-2.0

"""A node that listens to topics until it has heard so many messages, and prints them in the order of their sending.

Usage: listen.py COUNT TOPIC=TYPE... Prints `TOPIC STAMP` for each, STAMP being what the message says, in nanoseconds.
Subscriptions are reliable, that to /tf_static also for what was sent before.
"""

import sys
from importlib import import_module

import rclpy
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy


def stamp(message) -> int:
    """Returns the time in the message."""
    if hasattr(message, "transforms"):
        message = message.transforms[0]
    time = message.clock if hasattr(message, "clock") else message.header.stamp
    return time.sec * 10**9 + time.nanosec


def main() -> None:
    """Listens, and prints."""
    count = int(sys.argv[1])
    heard = []  # when it was sent, topic, stamp
    rclpy.init()
    node = Node("listener")
    for argument in sys.argv[2:]:
        topic, name = argument.split("=")
        package, kind = name.split("/")
        qos = QoSProfile(depth=1000, reliability=ReliabilityPolicy.RELIABLE)
        if topic == "/tf_static":
            qos.durability = DurabilityPolicy.TRANSIENT_LOCAL

        def take(message, info, topic=topic):
            heard.append((info["source_timestamp"], topic, stamp(message)))

        node.create_subscription(getattr(import_module(package + ".msg"), kind), topic, take, qos)
    while len(heard) < count:
        rclpy.spin_once(node, timeout_sec=1.0)
    for _, topic, time in sorted(heard, key=lambda each: each[0]):
        print(topic, time)


if __name__ == "__main__":
    main()
