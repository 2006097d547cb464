"""The ports of micro-ROS, the ways in which it is brought to a controller: files in `platforms/ports`."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros._internal.resources import PLATFORMS, yaml_data

#: Distributions of ROS 2 with micro-ROS, the oldest first.
DISTRIBUTIONS = ("foxy", "galactic", "humble", "iron", "jazzy", "kilted", "rolling")
#: Those whose parameter server has five services and handles: `RCLC_EXECUTOR_PARAMETER_SERVER_HANDLES` and parameter_server.c of
#: ros2/rclc rclc_parameter, on the branch of each distribution.
_WITH_FIVE = ("foxy", "galactic", "humble")
#: An action server has services for goals, results and cancelling, and publishes feedback and its status; an action client has their
#: counterparts (ros2/rcl rcl_action/src/rcl_action/action_server.c, action_client.c).
ACTION_SERVICES, ACTION_TOPICS = 3, 2
#: A lifecycle node with its communication interface creates all five services, however many are added to the executor, and a publisher
#: (ros2/rcl rcl_lifecycle/src/com_interface.c).
LIFECYCLE_SERVICES = 5


def parameter_services(distribution: str | None) -> int:
    """The services and handles of a parameter server; without a distribution the most that one has."""
    return 5 if distribution in _WITH_FIVE else 6


@dataclass(frozen=True, slots=True, kw_only=True)
class Port:
    """A port.

    Attributes
    ----------
    is_custom : whether its library is built for functions of its own that send and receive, also over UDP
    pools : build options as the port sets them, where they differ from those of the packages
    pools_of : where these pools are so, after "is 1 ..."
    least_stack : of a task in which an executor spins, in bytes, as the port documents it; None if it does not
    kconfig : build options that its configuration replaces -> their names there
    code : how code for it looks, see `uros.firmware.ports.CodePort`
    references : the sources of these facts
    """

    name: str
    title: str
    is_custom: bool = False
    pools: Mapping[str, int] = field(default_factory=dict)
    pools_of: str = ""
    least_stack: int | None = None
    kconfig: Mapping[str, str] = field(default_factory=dict)
    code: Mapping[str, Any] = field(default_factory=dict)
    references: Mapping[str, str] = field(default_factory=dict)


@cache
def known_ports() -> Mapping[str, Port]:
    """The ports by name."""
    ports = (Port(**yaml_data(path)) for path in sorted((PLATFORMS / "ports").glob("*.yaml")))
    return {port.name: port for port in ports}
