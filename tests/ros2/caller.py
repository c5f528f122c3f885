# SPDX-License-Identifier: Apache-2.0

"""A node that calls two services many times, several calls at once, and checks that each call has the answer to it.

caller.py CALLS FIRST BYTES: calls /camera/set with the numbers from FIRST on, each with BYTES more bytes.
"""

import sys

import rclpy
from rclpy.node import Node
from sensor_msgs.srv import SetCameraInfo
from std_srvs.srv import Trigger

AT_ONCE = 5

calls, first, size = (int(argument) for argument in sys.argv[1:4])
rclpy.init()
node = Node(f"caller_{first}")
camera = node.create_client(SetCameraInfo, "/camera/set")
trigger = node.create_client(Trigger, "/trigger")
for client in (camera, trigger):
    while not client.wait_for_service(timeout_sec=60):
        print("no service")
print("services are there")


def result(future):
    rclpy.spin_until_future_complete(node, future, timeout_sec=30)
    return future.result() if future.done() else None


right = 0
for start in range(first, first + calls, AT_ONCE):
    numbers = range(start, min(start + AT_ONCE, first + calls))
    futures = []
    for number in numbers:
        request = SetCameraInfo.Request()
        request.camera_info.header.stamp.sec = number
        request.camera_info.d = [1.0] * (size // 8)
        futures.append(camera.call_async(request))
    for number, future in zip(numbers, futures):
        response = result(future)
        if response is None or not response.success or response.status_message != f"number {number}":
            print("wrong answer to", number, ":", response)
        else:
            right += 1
response = result(trigger.call_async(Trigger.Request()))
print("trigger:", response.message if response else None)
print("right answers:", right)
