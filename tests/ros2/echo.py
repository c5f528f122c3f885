# SPDX-License-Identifier: Apache-2.0

"""A node that serves /NAME/echo with what it is asked (serve NAME), or that calls it and prints the answer (call)."""

import sys

import rclpy
from echo_interfaces.msg import Code
from echo_interfaces.srv import Echo
from geometry_msgs.msg import TransformStamped
from rclpy.node import Node


def serve(node: Node, name: str) -> None:
    def echo(request, response):
        response.transforms, response.code, response.words = request.transforms, request.code, request.words
        return response

    node.create_service(Echo, f"/{name}/echo", echo)
    rclpy.spin(node)


def call(node: Node, name: str) -> None:
    client = node.create_client(Echo, f"/{name}/echo")
    client.wait_for_service()
    transform = TransformStamped(child_frame_id="base")
    transform.header.frame_id = "odom"
    transform.transform.translation.x = 1.5
    request = Echo.Request(words=["ä", ""])
    request.code.value = Code.SOME
    request.transforms.transforms = [transform]
    future = client.call_async(request)
    rclpy.spin_until_future_complete(node, future)
    answer = future.result()
    moved = answer.transforms.transforms[0]
    x = moved.transform.translation.x
    print(moved.header.frame_id, moved.child_frame_id, x, "code", answer.code.value, answer.words)


rclpy.init()
role, name = sys.argv[1:3]
node = Node(f"{role}_{name}")
serve(node, name) if role == "serve" else call(node, name)
