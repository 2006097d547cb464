"""The routes through an event graph: steps in order, and where branches are joined."""

from __future__ import annotations

from itertools import product

from amalthea_uros._internal.records import dataclass
from amalthea_uros.errors import UnknownError
from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.tables.chains import BARRIER, TRACE_EVENT

#: Nodes with one step, and nodes with two, one after the other.
_STEPS = {TRACE_EVENT: ("first",), "EventGraphProcess": ("first", "second"), "EventGraphTraceFunction": ("first", "second")}
_DECISION, _SUB_GRAPH = "EventGraphDecision", "EventGraphSubGraph"
#: More decisions would be too many routes, and more levels or steps a graph that is damaged.
_MOST_DECISIONS = 6
_MOST_LEVELS = 20
_MOST_STEPS = 10_000


@dataclass(frozen=True, slots=True)
class Join:
    """Branches side by side, of which a number has to complete."""

    branches: tuple[GraphRoute, ...]
    needed: int


#: Steps (`ConditionalTraceEvent`) and joins, in order.
GraphRoute = tuple["ProjectObject | Join", ...]


def routes_of(graph: ProjectObject, level: int = 0) -> dict[str, GraphRoute]:
    """All routes through a graph, by what its decisions choose for them: "" without decisions.

    Raises
    ------
    UnknownError : something in it is not understood.
    """
    decisions = [node for node in graph["nodes"] if node.kind == _DECISION]
    if len(decisions) > _MOST_DECISIONS or level > _MOST_LEVELS:
        raise UnknownError("it has too many decisions, or contains itself")
    result: dict[str, GraphRoute] = {}
    visited: set[ProjectObject] = set()
    for choices in product((True, False), repeat=len(decisions)):
        walk = _GraphWalk(graph, dict(zip(decisions, choices, strict=True)), level)
        route = walk.route()
        visited |= walk.visited
        if route is not None and route not in result.values():
            result["_".join(str(choices[place]).lower() for place, each in enumerate(decisions) if each in walk.visited)] = (
                route
            )
    if not result or visited != set(graph["nodes"]):
        raise UnknownError("not all of its nodes are on a route to its end")
    return result


def joined_steps(route: GraphRoute) -> list[ProjectObject]:
    """The steps that a route ends with: several if all of them have to occur."""
    last = route[-1]
    if isinstance(last, ProjectObject):
        return [last]
    return [step for branch in last.branches for step in branch if isinstance(step, ProjectObject)]


class _GraphWalk:
    """One walk through a graph, along the branches that its decisions choose."""

    def __init__(self, graph: ProjectObject, choices: dict[ProjectObject, bool], level: int) -> None:
        self.graph = graph
        self.choices = choices
        self.level = level
        self.visited: set[ProjectObject] = set()
        self.ends: set[ProjectObject] = set()
        self.after: dict[ProjectObject, list[ProjectObject]] = {}
        for node in graph["nodes"]:
            for before in node["predecessors"]:
                self.after.setdefault(before, []).append(node)

    def route(self) -> GraphRoute | None:
        """The route to the end; None if a decision leads nowhere."""
        if self.graph["initialNode"] is None:
            raise UnknownError("it does not begin anywhere")
        result, stop = self.line(self.graph["initialNode"], 0)
        if any(node.kind == _DECISION for node in self.ends):
            return None
        if stop is not None or not result or not isinstance(result[0], ProjectObject):
            raise UnknownError("a barrier in it waits for steps that cannot be reached")
        if not self.ends <= set(self.graph["terminalNodes"]) or any(
            self.after.get(node) for node in self.graph["terminalNodes"]
        ):
            raise UnknownError("it ends elsewhere than it says")
        last = result[-1]
        if isinstance(last, Join) and any(len(branch) != 1 or isinstance(branch[0], Join) for branch in last.branches):
            raise UnknownError("it ends with several branches")
        return result

    def line(self, node: ProjectObject, depth: int) -> tuple[GraphRoute, ProjectObject | None]:
        """The steps from a node on, to the end or to the barrier that joins the branch, which is the second result."""
        if depth > _MOST_LEVELS:
            raise UnknownError("its branches have too many branches")
        result: list[ProjectObject | Join] = []
        while True:
            result += self.entered(node)
            if len(result) > _MOST_STEPS:
                raise UnknownError(f"it has more than {_MOST_STEPS:,} steps")
            following = self.following(node)
            if not following:
                self.ends.add(node)
                return tuple(result), None
            if len(following) == 1 and not _joins(following[0]):
                node = following[0]
                continue
            if len(following) == 1:
                return tuple(result), following[0]
            lines = [((), each) if _joins(each) else self.line(each, depth + 1) for each in following]
            stops = {stop for _, stop in lines}
            barrier = stops.pop()
            if stops or (barrier is not None and len(barrier["predecessors"]) != len(lines)):
                raise UnknownError("its branches are not joined by one barrier")
            branches = tuple(line for line, _ in lines)
            if barrier is None:
                return (*result, Join(branches, len(branches))), None
            result.append(Join(branches, min(barrier["minItems"], len(branches)) or len(branches)))
            node = barrier

    def entered(self, node: ProjectObject) -> GraphRoute:
        """The steps of a node itself."""
        if node in self.visited:
            raise UnknownError("it has a circle, or steps that follow several others without a barrier")
        self.visited.add(node)
        if node.kind in _STEPS:
            return tuple(_plain(node[name], node) for name in _STEPS[node.kind])
        if node.kind == _SUB_GRAPH and node["subGraph"] is not None:
            (route, *others) = routes_of(node["subGraph"], self.level + 1).values()
            if others:
                raise UnknownError("a graph in it has decisions")
            return route
        if node.kind in (BARRIER, _DECISION):
            return ()
        raise UnknownError(f"the node {node.name!r} is an {node.kind}")

    def following(self, node: ProjectObject) -> list[ProjectObject]:
        """The nodes after a node; after a decision, only the branch that it chooses."""
        if node.kind != _DECISION:
            return self.after.get(node, [])
        chosen = node["trueBranch" if self.choices[node] else "falseBranch"]
        return [] if chosen is None else [chosen]


def _joins(node: ProjectObject) -> bool:
    return node.kind == BARRIER and len(node["predecessors"]) > 1


def _plain(step: ProjectObject | None, node: ProjectObject) -> ProjectObject:
    if step is None or not step["consumePredecessor"] or step["valueConstraint"]:
        raise UnknownError(f"the step {node.name!r} has a condition")
    return step
