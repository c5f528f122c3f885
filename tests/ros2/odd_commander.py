# SPDX-License-Identifier: Apache-2.0

"""A node that sends invalid commands, again and again: odd_commander.py TOPIC COMMAND.

COMMAND is nan (in a Twist), foreign (a String), short (an array of one value) or unknown_joint (a trajectory).
"""

import sys

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray, String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint


def odd_message(what: str):
    if what == "nan":
        message = Twist()
        message.linear.x = float("nan")
        return message
    if what == "foreign":
        return String(data="forward")
    if what == "short":
        return Float64MultiArray(data=[1.0])
    return JointTrajectory(joint_names=["tail"], points=[JointTrajectoryPoint(positions=[1.0])])


rclpy.init()
topic, what = sys.argv[1:3]
node = Node("odd")
message = odd_message(what)
publisher = node.create_publisher(type(message), topic, 10)
node.create_timer(0.02, lambda: publisher.publish(message))
rclpy.spin(node)
