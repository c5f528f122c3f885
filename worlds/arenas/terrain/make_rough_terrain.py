#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0

"""Writes rough_terrain.png, a height map of 65 x 65 pixels of 16 bits: hills of several sizes, flat at the edges. If it
is 4 m wide and 0.25 m high, an s-bot can climb all of them. The output is the same every time."""

import math
import pathlib
import struct
import zlib

PIXELS = 65
# Waves along x and y over the whole map, their phases [rad] and heights.
WAVES = [(1, 2, 0.3, 1.0), (3, 1, 1.9, 0.7), (2, 4, 4.1, 0.5), (5, 3, 0.8, 0.3), (4, 6, 2.6, 0.25), (7, 6, 5.2, 0.15)]


def height(column, row):
    x, y = column / (PIXELS - 1), row / (PIXELS - 1)
    hills = sum(h * math.cos(2 * math.pi * (u * x + v * y) + phase) for u, v, phase, h in WAVES)
    share = 0.5 + 0.5 * hills / sum(h for *_, h in WAVES)
    edge = min(x, y, 1 - x, 1 - y)
    return share * min(1.0, edge / 0.1)


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


rows = b"".join(
    b"\0" + b"".join(struct.pack(">H", round(65535 * height(column, row))) for column in range(PIXELS))
    for row in range(PIXELS)
)
header = struct.pack(">IIBBBBB", PIXELS, PIXELS, 16, 0, 0, 0, 0)
pathlib.Path(__file__).with_name("rough_terrain.png").write_bytes(
    b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
)
