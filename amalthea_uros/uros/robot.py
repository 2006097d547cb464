"""A robot: the systems of its controllers as one, with its host, and chains that lead from one to the other.

Each controller keeps its own clock, wire and agent. Topics have one name for all of them: what one publishes reaches another one
through the agents of both, and between these takes the latency that the host states for the topic.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping

from amalthea_uros._internal.records import replace
from amalthea_uros.perf.host import Host, HostTopic
from amalthea_uros.perf.network import Direction, Purpose, plain_topic
from amalthea_uros.perf.qualified import joined, qualified
from amalthea_uros.perf.system import System
from amalthea_uros.spec.description import Description, RobotController
from amalthea_uros.uros.application.notes import Notes
from amalthea_uros.uros.assemble import Assembly
from amalthea_uros.uros.assembly.planned import HIGHER_IS_MORE_URGENT
from amalthea_uros.uros.chain_members import members_together
from amalthea_uros.uros.demands import with_demands
from amalthea_uros.uros.host import host_of
from amalthea_uros.uros.memory import MemoryDemand
from amalthea_uros.uros.missing_wires import check_wires
from amalthea_uros.uros.profiles import stated_profile
from amalthea_uros.uros.stacks import separate_stacks
from amalthea_uros.uros.transports.line import span_of


def assemble_robot(description: Description, controllers: Mapping[str, Assembly]) -> Assembly:
    """The robot that a description describes.

    Parameters
    ----------
    controllers : what the files of its controllers describe, by name

    Raises
    ------
    ReadError : the description is contradictory; carries all findings.
    """
    problems = Notes()
    _check(description.controllers, controllers, problems)
    profile = stated_profile(description.middleware, problems)
    if profile is None or problems.has_errors:
        raise problems.refusal()
    system = joined({name: each.system for name, each in controllers.items()})
    _check_names(system, description, problems)
    system = replace(system, host=_host(description, controllers, system, problems))
    parts = [each.members.of_part(name) for name, each in controllers.items()]
    members = members_together(parts, system.network)
    check_wires(members, parts, system, problems)
    system = with_demands(system, members, description, problems)
    if problems.has_errors:
        raise problems.refusal()
    choices = (qualified(choice, name) for name, each in controllers.items() for choice in each.choices)
    return Assembly(
        description=description,
        profile=profile,
        system=system,
        members=members,
        choices=tuple(choices),
        placement="",
        messages=(),
        bus=None,
        options=(),
        memory=MemoryDemand(uses=(), stacks=separate_stacks(()), other_stacks=0, ram=None, budget=None),
        findings=tuple(
            dict.fromkeys((*(finding for each in controllers.values() for finding in each.findings), *problems.findings))
        ),
        task_periods=(),
        priority_scale=HIGHER_IS_MORE_URGENT,
        controllers=controllers,
    )


def _check(sections: list[RobotController], controllers: Mapping[str, Assembly], problems: Notes) -> None:
    """Report controllers that share a name, and files that describe a host, too."""
    problems.unique("controller", ((each.name, each.location("name")) for each in sections))
    for section in sections:
        described = controllers[section.name].description
        if described.host is not None:
            message = f"the file of the controller {section.name!r} has a 'host', which is that of the robot"
            problems.error("APP003", message, described.location("host"), "Move 'host' to the file of the robot.")


def _check_names(system: System, description: Description, problems: Notes) -> None:
    """Report names that are the same with the names of controllers before them, e.g. `arm_left` `Motor` and `arm` `left_Motor`."""
    software = system.software
    every = (*software.tasks, *software.isrs, *software.runnables, *software.labels, *system.events.chains)
    for (kind, name), count in Counter((type(each).__name__, each.name) for each in every).items():
        if count > 1:
            message = f"two controllers have a {kind.lower()} {name!r}, with the name of the controller before its own name"
            problems.error("APP002", message, description.location("controllers"), "Rename one of the controllers.")


def _host(description: Description, controllers: Mapping[str, Assembly], system: System, problems: Notes) -> Host:
    """The host, with the topics that only controllers send each other."""
    nodes = [node for each in controllers.values() for node in each.description.application.nodes]
    host = host_of(description.host, nodes, problems)
    known = {topic.name for topic in host.topics}
    latency = span_of(description.host.latency if description.host is not None else None)
    between = [HostTopic(name=name, latency=latency) for name in _between(system) if name not in known]
    return replace(host, topics=(*host.topics, *between))


def _between(system: System) -> Iterator[str]:
    """The topics that one controller publishes and another one receives."""
    data = [each for each in system.network.transmissions if each.purpose is Purpose.DATA]
    sent = [each for each in data if each.direction is Direction.TO_AGENT]
    received = [each for each in data if each.direction is Direction.TO_CONTROLLER]
    yield from dict.fromkeys(
        plain_topic(one.topic)
        for one in sent
        for other in received
        if one.wire != other.wire and plain_topic(one.topic) == plain_topic(other.topic)
    )
