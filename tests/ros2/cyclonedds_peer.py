# SPDX-License-Identifier: Apache-2.0

"""A peer on a newer Cyclone DDS, which tells others what its types are. It does as fastdds_peer.cpp says.

Usage: cyclonedds_peer.py echo TOPIC TYPE QOS, or cyclonedds_peer.py match TYPE. TYPE is that of LaserScan.
"""

import signal
import sys
import threading
from dataclasses import dataclass

from cyclonedds.core import Listener, Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import float32, int32, sequence, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

REQUESTED = ["reliable,transient", "reliable", "best_effort,transient", "best_effort"]
OFFERED = ["best_effort", "best_effort,transient", "reliable", "reliable,transient"]


@dataclass
@final
class Time(IdlStruct, typename="builtin_interfaces.msg.dds_.Time_"):
    """As ROS 2 has it."""

    sec: int32
    nanosec: uint32


@dataclass
@final
class Header(IdlStruct, typename="std_msgs.msg.dds_.Header_"):
    """As ROS 2 has it."""

    stamp: Time
    frame_id: str


@dataclass
@final
class LaserScan(IdlStruct, typename="sensor_msgs.msg.dds_.LaserScan_"):
    """As ROS 2 has it."""

    header: Header
    angle_min: float32
    angle_max: float32
    angle_increment: float32
    time_increment: float32
    scan_time: float32
    range_min: float32
    range_max: float32
    ranges: sequence[float32]
    intensities: sequence[float32]


def to_qos(text: str) -> Qos:
    """Returns the QoS that a text says."""
    reliable = Policy.Reliability.Reliable(duration(seconds=10))
    return Qos(
        reliable if text.startswith("reliable") else Policy.Reliability.BestEffort,
        Policy.Durability.TransientLocal if text.endswith(",transient") else Policy.Durability.Volatile,
        Policy.DurabilityService(duration(), Policy.History.KeepLast(10), -1, -1, -1),
        Policy.History.KeepLast(10),
        Policy.DataRepresentation(use_cdrv0_representation=True),
    )


def echo(participant: DomainParticipant, name: str, qos: Qos) -> list:
    """Starts to write what it reads. Returns what must be kept for that."""
    writer = DataWriter(participant, Topic(participant, f"rt/{name}_again", LaserScan), qos=qos)
    has_data = threading.Event()

    class Wake(Listener):
        """Wakes the thread that reads."""

        def on_data_available(self, _reader: DataReader) -> None:
            has_data.set()

    reader = DataReader(participant, Topic(participant, f"rt/{name}", LaserScan), qos=qos, listener=Wake())

    def serve() -> None:
        while True:
            has_data.wait()
            has_data.clear()
            for scan in reader.take(100):
                if not isinstance(scan, LaserScan):
                    continue
                writer.write(scan)
                print("echo", len(scan.serialize(use_version_2=False)), flush=True)

    threading.Thread(target=serve, daemon=True).start()
    return [writer, reader]


def match(participant: DomainParticipant) -> list:
    """Makes the endpoints. Returns them."""
    kept: list = []
    for digit in "0123":
        to, back = (Topic(participant, f"rt/{which}_{digit}", LaserScan) for which in ("to", "from"))
        kept += [DataReader(participant, to, qos=to_qos(qos)) for qos in REQUESTED]
        kept += [DataWriter(participant, back, qos=to_qos(qos)) for qos in OFFERED]
    return kept


def main() -> None:
    """Runs until a signal ends it."""
    participant = DomainParticipant(0)
    kept = echo(participant, sys.argv[2], to_qos(sys.argv[4])) if sys.argv[1] == "echo" else match(participant)
    signal.pause()
    del kept


if __name__ == "__main__":
    main()
