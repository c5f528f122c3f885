# SPDX-License-Identifier: Apache-2.0

"""PX4 as its simulator sees it, with pymavlink on the wire: decodes all that the bridge sends, and answers.

Usage: px4_peer.py PORT. Prints what it has seen as JSON; fails at the first message that pymavlink does not take.
"""

import collections
import json
import socket
import sys

from pymavlink.dialects.v20 import common

BOOT = 10  # HIL_SENSOR that are not answered


class Wire:
    """The file to which pymavlink writes."""

    def __init__(self, connection: socket.socket) -> None:
        self.connection = connection

    def write(self, data: bytes) -> None:
        self.connection.sendall(data)


def main() -> None:
    """Answers each HIL_SENSOR with full speed ahead."""
    connection = socket.create_connection(("127.0.0.1", int(sys.argv[1])), timeout=30)
    connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    link = common.MAVLink(Wire(connection), srcSystem=1, srcComponent=1)
    link.heartbeat_send(common.MAV_TYPE_GROUND_ROVER, common.MAV_AUTOPILOT_PX4, 0, 0, 0)
    link.command_long_send(
        0, 0, common.MAV_CMD_SET_MESSAGE_INTERVAL, 0, common.MAVLINK_MSG_ID_HIL_STATE_QUATERNION, 4000, 0, 0, 0, 0, 0
    )
    # A message that the bridge does not know.
    link.ping_send(1, 2, 3, 4)
    counts: collections.Counter[str] = collections.Counter()
    last = {}
    while data := connection.recv(4096):
        for message in link.parse_buffer(data) or []:
            name = message.get_type()
            counts[name] += 1
            last[name] = {field: getattr(message, field) for field in message.get_fieldnames()}
            if name == "HIL_SENSOR" and counts[name] > BOOT:
                controls = [1.0, 1.0] + 14 * [0.0]
                link.hil_actuator_controls_send(message.time_usec, controls, 129, 1)
    print(json.dumps({"counts": counts, "last": last, "lost": link.total_receive_errors}))


try:
    main()
except ConnectionError:
    sys.exit("the bridge has cut the connection")
