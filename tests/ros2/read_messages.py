# SPDX-License-Identifier: Apache-2.0

"""Reads messages of ROS 2 with rosbags, writes them again, and compares bytes and hashes of types.

Usage: read_messages.py DISTRIBUTION FILE. DISTRIBUTION: `humble`, `jazzy` …, whose own definitions count, or `ours`:
the schemas in the file. FILE: JSON, a list of {type, schema, hash, samples}, where samples are bytes in hexadecimal
digits. A hash that is null is not compared. Prints how many types it read; fails at the first message that differs.
"""

import json
import sys
from pathlib import Path

from rosbags.typesys import Stores, get_types_from_msg, get_typestore


def check(store, message: dict) -> None:
    """Compares one type's hash, and each of its samples with what is written of it."""
    name = message["type"]
    found = store.hash_rihs01(name)
    if message["hash"] not in (None, found):
        sys.exit(f"{name}: the hash is {message['hash']}; it should be {found}")
    for sample in message["samples"]:
        data = bytes.fromhex(sample)
        again = bytes(store.serialize_cdr(store.deserialize_cdr(data, name), name))
        if again != data:
            sys.exit(f"{name}: {data.hex()} is written again as {again.hex()}")


def main() -> None:
    """Checks every message of the file."""
    distribution, file = sys.argv[1:]
    messages = json.loads(Path(file).read_text())
    store = get_typestore(Stores.EMPTY if distribution == "ours" else Stores[f"ROS2_{distribution.upper()}"])
    if distribution == "ours":
        types: dict = {}
        for message in messages:
            name = message["type"]
            as_message = name.replace("/srv/", "/msg/")  # the parser knows no other kind
            parsed = get_types_from_msg(message["schema"], as_message)
            parsed[name] = parsed.pop(as_message)
            types.update(parsed)
        store.register(types)
    for message in messages:
        check(store, message)
    print(f"{len(messages)} types")


if __name__ == "__main__":
    main()
