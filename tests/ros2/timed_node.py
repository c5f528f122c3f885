# SPDX-License-Identifier: Apache-2.0

"""A node that drives a robot by timers of its own: every 0.1 s, by the odometry that came last.

timed_node.py ROBOT [SPEED [END [THREADS]]]; ROBOT is its namespace. Every second of its clock it prints the time, how
many messages came, and a hash of all that it was told and when. It ends after END seconds, with the exit code 3. With
THREADS, that many threads call its callbacks, any of them at the same time.
"""

import hashlib
import sys

import rclpy
import rclpy.qos
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor


def main() -> None:
    robot = sys.argv[1]
    speed = float(sys.argv[2]) if len(sys.argv) > 2 else 0.1
    ends_after = float(sys.argv[3]) if len(sys.argv) > 3 else float("inf")
    threads = int(sys.argv[4]) if len(sys.argv) > 4 else 0
    rclpy.init()
    node = rclpy.create_node("timed")
    publisher = node.create_publisher(Twist, f"{robot}/cmd_vel", 10)
    told = hashlib.sha256()
    last: list[Odometry] = []
    count = 0
    early = 0
    ticks = 0

    def take(message: Odometry) -> None:
        nonlocal count, early
        count += 1
        last[:] = [message]
        stamp = message.header.stamp.sec * 10**9 + message.header.stamp.nanosec
        now = node.get_clock().now().nanoseconds
        # A message with a stamp arrives at that time, by the node's clock.
        early += not stamp <= now < stamp + 30_000_000
        told.update(f"{stamp} {now} {message.pose.pose.position.x!r};".encode())

    def drive() -> None:
        nonlocal ticks
        ticks += 1
        command = Twist()
        command.linear.x = speed
        if last:
            command.angular.z = 2 * last[0].pose.pose.position.x
        told.update(f"{node.get_clock().now().nanoseconds};".encode())
        publisher.publish(command)
        if ticks % 10 == 0:
            # In one piece: other nodes write to the same pipe.
            sys.stdout.write(f"{ticks // 10} s: {count} messages, {early} at another time, {told.hexdigest()}\n")
            sys.stdout.flush()
        if ticks >= 10 * ends_after:
            sys.exit(3)

    group = ReentrantCallbackGroup() if threads else None
    quality = rclpy.qos.qos_profile_sensor_data
    node.create_subscription(Odometry, f"{robot}/odom", take, quality, callback_group=group)
    node.create_timer(0.1, drive, callback_group=group)
    rclpy.spin(node, MultiThreadedExecutor(threads) if threads else None)


main()
