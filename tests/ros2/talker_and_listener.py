# SPDX-License-Identifier: Apache-2.0

"""A node that says a text on a topic until it is ended (talk TEXT), or that prints what it hears (listen)."""

import sys

import rclpy
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
role = sys.argv[1]
node = Node(role + "er")
if role == "talk":
    publisher = node.create_publisher(String, "chatter", 10)
    node.create_timer(0.05, lambda: publisher.publish(String(data=sys.argv[2])))
else:
    node.create_subscription(String, "chatter", lambda message: print("heard", message.data), 10)
rclpy.spin(node)
