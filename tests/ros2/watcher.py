# SPDX-License-Identifier: Apache-2.0

"""A node that prints what it hears of a robot: watcher.py NAMESPACE TOPIC..., as `TOPIC STAMP VALUE...`.

It prints `found` when it has found a publisher of each topic.
"""

import math
import sys

import rclpy
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, LaserScan, Range


def seconds(stamp) -> float:
    return stamp.sec + 1e-9 * stamp.nanosec


def values_of(message):
    if isinstance(message, Clock):
        return message.clock, []
    if isinstance(message, JointState):
        return message.header.stamp, [*message.position]
    if isinstance(message, LaserScan):
        return message.header.stamp, [message.angle_min, message.angle_increment, *message.ranges]
    if isinstance(message, Range):
        return message.header.stamp, [message.range, message.min_range, message.max_range]
    pose, twist = message.pose.pose, message.twist.twist
    heading = 2 * math.atan2(pose.orientation.z, pose.orientation.w)
    return message.header.stamp, [pose.position.x, pose.position.y, heading, twist.linear.x, twist.angular.z]


rclpy.init()
namespace, *topics = sys.argv[1:]
node = Node("watcher", namespace=namespace)


def watch(topic: str) -> None:
    def hear(message) -> None:
        stamp, values = values_of(message)
        print(topic, f"{seconds(stamp):.9f}", *values, flush=True)

    types = {"odom": Odometry, "/clock": Clock, "joint_states": JointState, "scan": LaserScan}
    node.create_subscription(types.get(topic, Range), topic, hear, 1000)


for topic in topics:
    watch(topic)
def find_publishers() -> None:
    if all(node.count_publishers(topic) > 0 for topic in topics):
        print("found", flush=True)
        timer.cancel()


timer = node.create_timer(0.05, find_publishers)
print("ready", flush=True)
rclpy.spin(node)
