# SPDX-License-Identifier: Apache-2.0

"""A node that has the simulation's time: prints `timer T` at every tenth of a second, and for odometry and clocks
`odom T SENT` and `clock T SENT`, where SENT is when they were sent."""

import rclpy
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock

rclpy.init()
node = Node("clockwork", parameter_overrides=[Parameter("use_sim_time", value=True)])


def nanoseconds(stamp) -> int:
    return stamp.sec * 1_000_000_000 + stamp.nanosec


def hear_odometry(message, info) -> None:
    print("odom", nanoseconds(message.header.stamp), info["source_timestamp"], flush=True)


def hear_clock(message, info) -> None:
    print("clock", nanoseconds(message.clock), info["source_timestamp"], flush=True)


node.create_timer(0.1, lambda: print("timer", node.get_clock().now().nanoseconds, 0, flush=True))
node.create_subscription(Odometry, "/odom", hear_odometry, 1000)
node.create_subscription(Clock, "/clock", hear_clock, 1000)
rclpy.spin(node)
