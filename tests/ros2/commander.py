# SPDX-License-Identifier: Apache-2.0

"""A node that answers each message of a sensor by a velocity: commander.py NAMESPACE SENSOR COMMAND [SPEED [STOP]].

SENSOR is scan, odom or the name of a Range. COMMAND is Twist, TwistStamped (with the stamp of the sensor's message), or
BestEffort (a Twist over a publisher that is not reliable). Before it answers message STOP, it stops, as by SIGSTOP; a
message that comes again counts once.
"""

import contextlib
import math
import os
import signal
import sys

import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import LaserScan, Range


def sensed(message) -> float:
    """Returns a number that depends on the whole message."""
    if isinstance(message, LaserScan):
        return sum(range for range in message.ranges if math.isfinite(range))
    if isinstance(message, Range):
        return message.range
    return message.pose.pose.position.x + 2 * message.pose.pose.position.y


class Commander(Node):
    def __init__(self, namespace: str, sensor: str, command: str, speed: float, stop: int):
        super().__init__("commander", namespace=namespace)
        self.speed = speed
        self.until_stop = stop
        self.last_stamp = None
        self.type = TwistStamped if command == "TwistStamped" else Twist
        reliability = ReliabilityPolicy.BEST_EFFORT if command == "BestEffort" else ReliabilityPolicy.RELIABLE
        self.publisher = self.create_publisher(self.type, "cmd_vel", QoSProfile(depth=10, reliability=reliability))
        sensor_type = {"scan": LaserScan, "odom": Odometry}.get(sensor, Range)
        self.create_subscription(sensor_type, sensor, self.answer, 10)

    def answer(self, message) -> None:
        if message.header.stamp != self.last_stamp:
            self.last_stamp = message.header.stamp
            self.until_stop -= 1
            if self.until_stop == 0:
                os.kill(os.getpid(), signal.SIGSTOP)
        value = sensed(message)
        if not math.isfinite(value):
            value = 1.0
        command = self.type()
        twist = command.twist if self.type is TwistStamped else command
        twist.linear.x = self.speed
        twist.angular.z = math.sin(20 * value)
        if self.type is TwistStamped:
            command.header.stamp = message.header.stamp
        self.publisher.publish(command)


rclpy.init()
namespace, sensor, command, *more = sys.argv[1:]
node = Commander(namespace, sensor, command, float(more[0]) if more else 0.1, int(more[1]) if more[1:] else 0)
print("ready", flush=True)
with contextlib.suppress(KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
    rclpy.spin(node)
