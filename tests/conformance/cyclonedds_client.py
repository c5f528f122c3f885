# SPDX-License-Identifier: Apache-2.0

"""A client on the Python package of Cyclone DDS, written from docs/protocol.md and idl/cohort.idl alone.

It drives robots by the values that their team's parameters give for channels, as the controller `constant` does. Usage:
cyclonedds_client.py DOMAIN SELECTOR... It ends with 0 after the report that the run has finished.
"""

import os
import random
import socket
import sys
import time
from dataclasses import dataclass

from cyclonedds.core import InstanceState, Policy, Qos, ReadCondition, SampleState, ViewState, WaitSet
from cyclonedds.domain import Domain, DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final, key
from cyclonedds.idl.types import float64, int64, sequence, uint32, uint64
from cyclonedds.pub import DataWriter, Publisher
from cyclonedds.sub import DataReader, Subscriber
from cyclonedds.topic import Topic
from cyclonedds.util import duration

ADMITTED, FINISHED, SUPERSEDED = 0, 0, 2
KEPT_ANSWERS = 8

# As docs/protocol.md, "Conformance", has them for the loopback.
SETTINGS = """<CycloneDDS><Domain Id="any">
<General><AllowMulticast>false</AllowMulticast>
<Interfaces><NetworkInterface address="127.0.0.1"/></Interfaces></General>
<Discovery><ParticipantIndex>none</ParticipantIndex><SPDPInterval>1s</SPDPInterval><LeaseDuration>5s</LeaseDuration>
<Peers><Peer Address="127.0.0.1:{port}"/></Peers></Discovery></Domain></CycloneDDS>"""


@dataclass
@final
class Channel(IdlStruct, typename="cohort.v1.Channel"):
    name: str
    unit: str
    size: uint32
    lower: float64
    upper: float64
    neutral: float64


@dataclass
@final
class Join(IdlStruct, typename="cohort.v1.Join"):
    client: uint64
    key("client")
    minor: uint32
    controller: str
    host: str
    process: uint32
    robots: sequence[str]


@dataclass
@final
class Parameter(IdlStruct, typename="cohort.v1.Parameter"):
    name: str
    values: sequence[str]


@dataclass
@final
class Team(IdlStruct, typename="cohort.v1.Team"):
    name: str
    controller: str
    parameters: sequence[Parameter]


@dataclass
@final
class AdmittedRobot(IdlStruct, typename="cohort.v1.AdmittedRobot"):
    robot: uint32
    name: str
    team: uint32
    description: uint32
    seed: uint64
    period: uint32
    phase: uint32
    delay: uint32
    mode: uint32


@dataclass
@final
class Admit(IdlStruct, typename="cohort.v1.Admit"):
    client: uint64
    key("client")
    status: uint32
    reason: str
    run: uint32
    epoch: uint64
    start_reason: uint32
    tick: uint64
    step_ns: int64
    teams: sequence[Team]
    robots: sequence[AdmittedRobot]


@dataclass
@final
class RobotDescription(IdlStruct, typename="cohort.v1.RobotDescription"):
    description: uint32
    key("description")
    model: str
    observation: sequence[Channel]
    command: sequence[Channel]


@dataclass
@final
class Observation(IdlStruct, typename="cohort.v1.Observation"):
    client: uint64
    key("client")
    run: uint32
    resent: uint32
    epoch: uint64
    tick: uint64
    time_ns: int64
    robots: sequence[uint32]
    values: sequence[float64]


@dataclass
@final
class Command(IdlStruct, typename="cohort.v1.Command"):
    client: uint64
    key("client")
    run: uint32
    resent: uint32
    epoch: uint64
    tick: uint64
    robots: sequence[uint32]
    values: sequence[float64]


@dataclass
@final
class Report(IdlStruct, typename="cohort.v1.Report"):
    client: uint64
    key("client")
    run: uint32
    kind: uint32
    tick: uint64
    reason: str
    text: str


def qos(reliable, last, durability, *more):
    reliability = Policy.Reliability.Reliable(duration(milliseconds=100)) if reliable else Policy.Reliability.BestEffort
    encoding = Policy.DataRepresentation(use_cdrv0_representation=True, use_xcdrv2_representation=False)
    return Qos(reliability, durability, Policy.History.KeepLast(last), encoding, *more)


KEPT = Policy.Durability.TransientLocal
VOLATILE = Policy.Durability.Volatile


class Client:
    """One participant with the endpoints of a client without state of controllers (minor version 0)."""

    def __init__(self, domain, selectors):
        identity = random.getrandbits(63) | 1
        participant = DomainParticipant(domain)

        def topic(name, message):
            return Topic(participant, "cohort/v1/" + name, message)

        everyone = Subscriber(participant)
        own = Subscriber(participant, Qos(Policy.Partition([f"c{identity:016x}"])))
        publisher = Publisher(participant)
        join_qos = qos(True, 1, KEPT, Policy.Liveliness.Automatic(duration(seconds=1)))
        self.descriptions = DataReader(everyone, topic("robot_description", RobotDescription), qos(True, 1, KEPT))
        self.admits = DataReader(own, topic("admit", Admit), qos(True, 1, KEPT))
        self.observations = DataReader(own, topic("observation", Observation), qos(False, 8, VOLATILE))
        self.reports = DataReader(own, topic("report", Report), qos(True, 16, KEPT))
        self.commands = DataWriter(publisher, topic("command", Command), qos(False, 8, VOLATILE))
        self.joins = DataWriter(publisher, topic("join", Join), join_qos)
        self.news = WaitSet(participant)
        for reader in (self.descriptions, self.admits, self.observations, self.reports):
            self.news.attach(ReadCondition(reader, SampleState.Any | ViewState.Any | InstanceState.Any))
        self.join = Join(identity, 0, "constant in Python", socket.gethostname(), os.getpid(), selectors)


def taken(reader, field):
    """Yields new messages. Without this field, a sample only says that its writer is gone."""
    for sample in reader.take(N=64):
        if hasattr(sample, field):
            yield sample


class Lease:
    """The robots of an admission, and the answers that may be requested again."""

    def __init__(self, admit):
        self.admit = admit
        self.robots = {robot.robot: robot for robot in admit.robots}
        self.kept = {}

    def values_of(self, robot, description):
        team = self.admit.teams[self.robots[robot].team]
        given = {parameter.name: [float(value) for value in parameter.values] for parameter in team.parameters}
        values = []
        for channel in description.command:
            values += given.get(channel.name, [channel.neutral] * channel.size)
        return values

    def answer(self, frame, descriptions):
        if frame.tick not in self.kept:
            values = []
            for robot in frame.robots:
                values += self.values_of(robot, descriptions[self.robots[robot].description])
            self.kept[frame.tick] = Command(
                frame.client, frame.run, frame.resent, frame.epoch, frame.tick, frame.robots, values
            )
            self.kept = {tick: kept for tick, kept in self.kept.items() if tick + KEPT_ANSWERS > frame.tick}
        return self.kept[frame.tick]


def drive(client):
    descriptions, lease, frames, joined = {}, None, {}, 0.0
    while True:
        if time.monotonic() - joined >= 1.0:
            client.joins.write(client.join)
            joined = time.monotonic()
        client.news.wait(duration(milliseconds=100))
        for description in taken(client.descriptions, "model"):
            descriptions[description.description] = description
        for admit in taken(client.admits, "epoch"):
            if admit.status != ADMITTED:
                print("refused:", admit.reason, flush=True)
                return 1
            if lease is None or admit.epoch > lease.admit.epoch:
                lease = Lease(admit)
                print("admitted at tick", admit.tick, flush=True)
        for report in taken(client.reports, "kind"):
            print("report", report.kind, report.reason, report.text, flush=True)
            if report.kind in (FINISHED, SUPERSEDED):
                return 0 if report.kind == FINISHED else 1
        for frame in taken(client.observations, "epoch"):
            frames[frame.epoch, frame.tick] = frame
        is_ready = lease is not None and all(each.description in descriptions for each in lease.admit.robots)
        for place, frame in sorted(frames.items()) if is_ready else ():
            if frame.epoch <= lease.admit.epoch:
                del frames[place]
            if frame.epoch == lease.admit.epoch:
                client.commands.write(lease.answer(frame, descriptions))


def main():
    number = int(sys.argv[1])
    domain = Domain(number, SETTINGS.format(port=7410 + 250 * number))  # lives as long as its participants
    client = Client(number, sys.argv[2:])
    result = drive(client)
    del domain
    return result


sys.exit(main())
