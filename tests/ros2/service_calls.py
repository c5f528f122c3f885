# SPDX-License-Identifier: Apache-2.0

"""Calls of the services of simulation_interfaces, for the programs of this folder."""

import re
import sys

import rclpy
from simulation_interfaces import srv

PATIENCE = 60  # s


def caller_of(node):
    """Returns a function that calls a service and returns the response. It ends the program if there is none."""
    clients = {}

    def call(service: str, request=None):
        """`service`: the name of the service's type."""
        kind = getattr(srv, service)
        if service not in clients:
            name = re.sub("(?!^)([A-Z])", r"_\1", service).lower()
            clients[service] = node.create_client(kind, "/" + name)
            if not clients[service].wait_for_service(timeout_sec=PATIENCE):
                sys.exit(f"no service /{name}")
        future = clients[service].call_async(request or kind.Request())
        rclpy.spin_until_future_complete(node, future, timeout_sec=PATIENCE)
        if not future.done():
            sys.exit(f"{service}: no response")
        return future.result()

    return call
