# SPDX-License-Identifier: Apache-2.0

"""A node that prints what the graph has of other nodes: look_at_graph.py TOPIC..., once all topics are there.

For each: TOPIC NODE publishes|subscribes TYPE RELIABILITY DURABILITY, and whether the type's hash is that of this
distribution (same, other, or unknown for a type that it does not have).
"""

import importlib
import sys
import time

import rclpy
from rclpy.node import Node


def own_hash(type_name: str) -> str:
    """Returns the hash of a type that this distribution announces for a publisher of its own."""
    package, _, name = type_name.split("/")
    try:
        message = getattr(importlib.import_module(package + ".msg"), name)
    except ImportError:
        return "none"
    topic = "/own/" + name
    publisher = node.create_publisher(message, topic, 1)
    infos = []
    while not infos:
        infos = node.get_publishers_info_by_topic(topic)
    node.destroy_publisher(publisher)
    return str(infos[0].topic_type_hash)


def show(topic: str, verb: str, info) -> None:
    qos = info.qos_profile
    own = own_hash(info.topic_type)
    same = "unknown" if own == "none" else "same" if own == str(info.topic_type_hash) else "other"
    print(topic, info.node_name, verb, info.topic_type, qos.reliability.name, qos.durability.name, same)


rclpy.init()
node = Node("looker")
topics = sys.argv[1:]


def endpoints(topic: str) -> list:
    pairs = [("publishes", info) for info in node.get_publishers_info_by_topic(topic)]
    pairs += [("subscribes", info) for info in node.get_subscriptions_info_by_topic(topic)]
    return [(verb, info) for verb, info in pairs if info.node_name not in (node.get_name(), "_NODE_NAME_UNKNOWN_")]


while not all(endpoints(topic) for topic in topics) or "cohort" not in node.get_node_names():
    time.sleep(0.05)
for topic in topics:
    for verb, info in endpoints(topic):
        show(topic, verb, info)
print("nodes", sorted(node.get_node_names()))
print("types of /clock", dict(node.get_topic_names_and_types())["/clock"])
