# SPDX-License-Identifier: Apache-2.0

"""A node that moves joints: move_joints.py TOPIC VALUE..., the values of a Float64MultiArray, again and again."""

import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64MultiArray

rclpy.init()
topic, *values = sys.argv[1:]
node = Node("mover")
publisher = node.create_publisher(Float64MultiArray, topic, 10)
message = Float64MultiArray(data=[float(value) for value in values])
node.create_timer(0.02, lambda: publisher.publish(message))
rclpy.spin(node)
