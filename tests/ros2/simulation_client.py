# SPDX-License-Identifier: Apache-2.0

"""A node that controls a simulation by the services of simulation_interfaces, and prints what differs.

- simulation_client.py all: calls each service of a paused run of turtlebot3, and ends the server.
- simulation_client.py ask CALLS: asks CALLS times for the state of the simulation, which is paused.
- simulation_client.py look: sees the service's endpoints, and takes none for a service that it can call.
"""

import sys

import rclpy
from rclpy.node import Node
from service_calls import caller_of
from simulation_interfaces import msg, srv

UNSUPPORTED, OK, NOT_FOUND, FAILED, ALREADY = 0, 1, 2, 4, 101
PLAYING, PAUSED, QUITTING = 1, 2, 3
STEP = 0.01  # s, of the experiment

BOX = """<sdf version="1.9"><model name="crate"><link name="link">
<inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial>
<collision name="box"><geometry><box><size>0.2 0.2 0.2</size></box></geometry></collision></link></model></sdf>"""

rclpy.init()
node = Node("simulation_client")
call = caller_of(node)
differences = 0


def differs(text: str) -> None:
    global differences
    differences += 1
    print(text)


def expect(what: str, value, expected) -> None:
    if value != expected:
        differs(f"{what}: {value}, expected {expected}")


def expect_result(what: str, response, result: int, text: str = ""):
    """Checks the number of a result, and that its sentence has a part."""
    expect(what, response.result.result, result)
    if text not in response.result.error_message:
        differs(f"{what}: '{response.result.error_message}', expected '{text}' in it")
    return response


def set_run_state(state: int):
    request = srv.SetSimulationState.Request()
    request.state.state = state
    return call("SetSimulationState", request)


def spawn(name: str, uri: str = "", text: str = "", x: float = 0.0, frame: str = "", namespace: str = ""):
    request = srv.SpawnEntity.Request(name=name, entity_namespace=namespace)
    resource = getattr(request, "entity_resource", request)  # a part of its own since 2.0
    resource.uri, resource.resource_string = uri, text
    request.initial_pose.header.frame_id = frame
    request.initial_pose.pose.position.x = x
    request.initial_pose.pose.position.z = 5.0
    return call("SpawnEntity", request)


def state_of(entity: str):
    return call("GetEntityState", srv.GetEntityState.Request(entity=entity))


def tick_of(response) -> int:
    stamp = response.state.header.stamp
    return round((stamp.sec + 1e-9 * stamp.nanosec) / STEP)


def set_entity(entity: str, frame: str = "", acceleration: bool = False, **values):
    request = srv.SetEntityState.Request(entity=entity)
    request.state.header.frame_id = frame
    request.state.pose.position.x, request.state.pose.position.z = 2.0, 6.0
    request.state.twist.linear.y = 0.5
    request.state.acceleration.linear.x = 1.0 if acceleration else 0.0
    if hasattr(request, "set_pose"):  # since 2.1
        request.set_pose, request.set_twist, request.set_acceleration = True, True, acceleration
        for name, value in values.items():
            setattr(request, name, value)
    return call("SetEntityState", request)


def select(filter: str = "", category: int | None = None, tag: str = ""):
    request = srv.GetEntities.Request()
    request.filters.filter = filter
    request.filters.tags.tags = [tag] if tag else []
    if category is not None:
        request.filters.categories = [msg.EntityCategory(category=category)]
    return call("GetEntities", request)


def check_time() -> None:
    features = call("GetSimulatorFeatures").features
    expect("features", list(features.features), [0, 1, 8, 9, 10, 11, 12, 14, 20, 24, 25, 26, 31, 32, 44, 50])
    expect("spawn_formats", list(features.spawn_formats), ["sdf", "urdf", "yaml"])
    expect_result("pause", set_run_state(PAUSED), ALREADY, "already paused")
    expect("state", call("GetSimulationState").state.state, PAUSED)
    before = tick_of(state_of("turtlebot3"))
    expect_result("step", call("StepSimulation", srv.StepSimulation.Request(steps=10)), OK, f"tick {before + 10}")
    expect("steps", tick_of(state_of("turtlebot3")) - before, 10)
    expect_result("play", set_run_state(PLAYING), OK)
    expect_result("step while playing", call("StepSimulation", srv.StepSimulation.Request(steps=1)), FAILED, "paused")
    expect_result("pause again", set_run_state(PAUSED), OK, "paused at tick")
    expect_result("no such state", set_run_state(4), UNSUPPORTED, "state 4")
    expect_result("no steps", call("StepSimulation", srv.StepSimulation.Request(steps=0)), FAILED)


def check_entities() -> None:
    expect_result("spawn a text", spawn("crate", text=BOX, x=1.0), OK)
    expect_result("spawn a model", spawn("second", uri="turtlebot3", x=-1.0, frame="world"), OK)
    expect_result("name taken", spawn("crate", text=BOX), 101, "crate")
    expect_result("no resource", spawn("nothing"), 104)
    expect_result("a frame", spawn("lost", text=BOX, frame="map"), 109, "frame_id 'map'")
    expect_result("a namespace", spawn("lost", text=BOX, namespace="/here"), 105, "'/here'")
    expect("entities", sorted(select("crate|second").entities), ["crate", "second"])
    expect("robots", sorted(select("", 1).entities), ["second", "turtlebot3"])
    expect_result("tags", select(tag="red"), UNSUPPORTED, "tags")
    state = expect_result("state", state_of("crate"), OK).state
    expect("x", state.pose.position.x, 1.0)
    expect("frame", state.header.frame_id, "world")
    expect_result("set state", set_entity("crate"), OK)
    state = state_of("crate").state
    expect("pose", (state.pose.position.x, state.pose.position.z), (2.0, 6.0))
    expect("twist", state.twist.linear.y, 0.5)
    if hasattr(srv.SetEntityState.Request(), "set_pose"):
        expect_result("set twist alone", set_entity("second", set_pose=False), OK)
        state = state_of("second").state
        expect("untouched pose", (state.pose.position.x, state.twist.linear.y), (-1.0, 0.5))
    expect_result("set in a frame", set_entity("crate", frame="map"), 101, "frame_id 'map'")
    expect_result("acceleration", set_entity("crate", acceleration=True), UNSUPPORTED, "acceleration")
    expect_result("set nobody's", set_entity("nobody"), NOT_FOUND, "'nobody'")
    request = srv.GetEntitiesStates.Request()
    request.filters.filter = "^(crate|second)$"
    states = expect_result("states", call("GetEntitiesStates", request), OK)
    expect(
        "states",
        dict(zip(states.entities, (state.pose.position.x for state in states.states))),
        {"crate": 2.0, "second": -1.0},
    )
    info = expect_result("info", call("GetEntityInfo", srv.GetEntityInfo.Request(entity="second")), OK).info
    expect("info", (info.category.category, info.description), (1, "model turtlebot3"))
    expect_result("delete", call("DeleteEntity", srv.DeleteEntity.Request(entity="crate")), OK)
    expect_result("deleted", state_of("crate"), NOT_FOUND, "'crate'")
    expect_result("delete again", call("DeleteEntity", srv.DeleteEntity.Request(entity="crate")), NOT_FOUND)


def check_several() -> None:
    def one(name: str, text: str):
        entity = msg.SpawnEntity(name=name, entity_resource=msg.Resource(resource_string=text))
        entity.initial_pose.pose.position.z = 8.0
        return entity

    request = srv.SpawnEntities.Request(spawn_requests=[one("several", BOX), one("several", BOX), one("none", "")])
    spawned = expect_result("spawn several", call("SpawnEntities", request), 150)
    expect("each", [each.result.result for each in spawned.results], [OK, 101, 104])


def check_worlds() -> None:
    spawnables = expect_result("spawnables", call("GetSpawnables"), OK).spawnables
    uris = [getattr(each, "entity_resource", each).uri for each in spawnables]
    expect("turtlebot3 can be spawned", "turtlebot3" in uris, True)
    world = expect_result("world", call("GetCurrentWorld"), OK).world
    expect("world", (world.name, world.world_resource.uri.endswith("turtlebot3.yaml")), ("turtlebot3", True))
    for service in ("LoadWorld", "UnloadWorld", "GetAvailableWorlds"):
        expect_result(service, call(service), UNSUPPORTED, "cohort serve")


def check_end() -> None:
    expect_result("reset a part", call("ResetSimulation", srv.ResetSimulation.Request(scope=1)), UNSUPPORTED, "scope")
    expect_result("reset", call("ResetSimulation"), OK)
    expect("tick", tick_of(state_of("turtlebot3")), 0)
    expect_result("what was spawned", state_of("second"), NOT_FOUND)
    expect_result("quit", set_run_state(QUITTING), OK)


def look() -> None:
    client = node.create_client(srv.GetSimulationState, "/get_simulation_state")
    while "/get_simulation_state" not in dict(node.get_service_names_and_types()):
        rclpy.spin_once(node, timeout_sec=0.05)
    expect("available", client.wait_for_service(timeout_sec=1), False)


if sys.argv[1] == "look":
    look()
elif sys.argv[1] == "all":
    for check in (check_time, check_entities, check_several, check_worlds, check_end):
        check()
else:
    for _ in range(int(sys.argv[2])):
        expect("state", call("GetSimulationState").state.state, PAUSED)
sys.exit(differences > 0)
