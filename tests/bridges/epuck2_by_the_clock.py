# SPDX-License-Identifier: Apache-2.0

"""A program for an e-puck2 that goes by its own clock, as for the real robot: see docs/bridges/epuck2.md.

Usage: epuck2_by_the_clock.py COURSE. Prints when it has received each answer, and what the wheels have turned.
"""

import os
import socket
import struct
import sys
import time

robot = socket.create_connection((os.environ["COHORT_ADDRESS"], int(os.environ["COHORT_PORT"])))


def receive(count):
    received = b""
    while len(received) < count:
        part = robot.recv(count - len(received))
        if not part:
            sys.exit(0)  # the run has ended
        received += part
    return received


def exchange(left, right):
    """Returns the sensors after a command of these speeds."""
    robot.sendall(struct.pack("<BBBhh14x", 0x80, 2, 0, left, right))
    assert receive(1) == b"\x02"
    sensors = receive(104)
    print(f"{time.monotonic():.9f}", *struct.unpack_from("<hh", sensors, 79), flush=True)
    return sensors


def avoid_obstacles():
    left, right = 500, 500
    while True:
        proximity = struct.unpack_from("<8H", exchange(left, right), 37)
        left = 500 - sum(proximity[0:3]) // 2 - proximity[0]
        right = 500 - sum(proximity[5:8]) // 2
        time.sleep(0.05)


def speak_always():
    while True:
        exchange(300, 200)


def speak_once():
    exchange(300, 200)
    while True:
        time.sleep(1)


def command_after_a_second():
    exchange(300, 200)
    time.sleep(1)
    exchange(0, 0)
    while True:
        exchange(0, 0)


def leave():
    exchange(300, 200)
    time.sleep(0.2)
    sys.exit(3)


def reconnect():
    global robot
    while True:
        exchange(300, 200)
        robot.close()
        time.sleep(0.12)
        robot = socket.create_connection((os.environ["COHORT_ADDRESS"], int(os.environ["COHORT_PORT"])))


def never_read():
    while True:
        robot.sendall(struct.pack("<BBBhh14x", 0x80, 3, 0, 300, 200))
        time.sleep(0.05)


def speak_nonsense():
    while True:
        try:
            robot.sendall(b"nonsense")
            robot.recv(1)
        except OSError:
            pass
        reopen()


def reopen():
    global robot
    robot = socket.create_connection((os.environ["COHORT_ADDRESS"], int(os.environ["COHORT_PORT"])))


def spin():
    exchange(0, 0)
    while True:
        pass


globals()[sys.argv[1]]()
