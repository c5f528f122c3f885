# SPDX-License-Identifier: Apache-2.0

"""Reads a folder as a bag of rosbag2 with rosbags, and prints what is in it.

Usage: read_bag.py FOLDER. Prints a line for each topic, `TOPIC TYPE COUNT DURABILITY`, and then for each message of ROS
itself and of the robots' observations `TOPIC TIME STAMP`, in the bag's order. TIME is the bag's, and STAMP what the
message says, in nanoseconds. Fails where a hash of a type differs from that of Jazzy, or a count from what is there.
"""

import collections
import sys
from pathlib import Path

from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore

OURS = "/cohort/"


def stamp(message) -> int:
    """Returns the time in the message."""
    if hasattr(message, "transforms"):
        message = message.transforms[0]
    time = message.header.stamp if hasattr(message, "header") else getattr(message, "clock", None) or message.stamp
    return time.sec * 10**9 + time.nanosec


def main() -> None:
    """Reads the bag twice: as rosbag2 has it, and with its messages."""
    folder = Path(sys.argv[1])
    jazzy = get_typestore(Stores.ROS2_JAZZY)
    with Reader(folder) as bag:
        for each in sorted(bag.connections, key=lambda each: each.topic):
            if each.msgtype in jazzy.fielddefs and each.digest != jazzy.hash_rihs01(each.msgtype):
                sys.exit(f"{each.topic}: the hash is {each.digest}")
            durability = each.ext.offered_qos_profiles[0].durability.name.lower()
            print(each.topic, each.msgtype, each.msgcount, durability)
        told = {each.topic: each.msgcount for each in bag.connections}
    found: collections.Counter = collections.Counter()
    with AnyReader([folder]) as bag:
        for connection, time, data in bag.messages():
            found[connection.topic] += 1
            if not connection.topic.startswith(OURS):
                print(connection.topic, time, stamp(bag.deserialize(data, connection.msgtype)))
    if any(found[topic] != count for topic, count in told.items()) or sum(found.values()) != sum(told.values()):
        sys.exit(f"counts are {told}, and there are {dict(found)}")


if __name__ == "__main__":
    main()
