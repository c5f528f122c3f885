# SPDX-License-Identifier: Apache-2.0

"""A node like commander.py that does not answer the fifth scan, ends its subscription and subscribes again."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from sensor_msgs.msg import LaserScan


class Resubscriber(Node):
    def __init__(self):
        super().__init__("resubscriber")
        self.publisher = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_timer(0.5, self.subscribe_again)
        self.stamps = []
        self.subscribe()

    def subscribe(self) -> None:
        self.subscription = self.create_subscription(LaserScan, "scan", self.answer, 10)

    def subscribe_again(self) -> None:
        if self.subscription is None:
            self.subscribe()
            print("subscribed again", flush=True)
        elif len(self.stamps) == 5:
            self.stamps.append(None)
            self.destroy_subscription(self.subscription)
            self.subscription = None

    def answer(self, message) -> None:
        if message.header.stamp not in self.stamps:
            self.stamps.append(message.header.stamp)
        if len(self.stamps) == 5:
            return
        command = Twist()
        command.linear.x = 0.1
        value = sum(range for range in message.ranges if math.isfinite(range))
        command.angular.z = math.sin(20 * value)
        self.publisher.publish(command)


rclpy.init()
rclpy.spin(Resubscriber())
