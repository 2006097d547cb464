"""0.9.2 -> 0.9.3: constants and deviations become classes of their own for numbers and for times."""

from __future__ import annotations

from typing import NamedTuple

from amalthea_uros.xmi.migrate.steps.tools import add_property, attributes_text, keep_comments
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes

DISCRETE, CONTINUOUS, TIME = "DiscreteValue", "ContinuousValue", "Time"

#: Class of a constant -> attribute with its value.
CONSTANTS = {"NeedConstant": "value", "InstructionsConstant": "value", "LatencyConstant": "cycles"}

#: Class of a deviation -> the part that holds bounds and distribution.
DEVIATIONS = {"NeedDeviation": "deviation", "InstructionsDeviation": "deviation", "LatencyDeviation": "cycles"}

_LOST = "a deviation without a distribution that has a successor is lost"

_UNBOUNDED = "the mandatory upper bound was not specified; left open"


class _DistributionForm(NamedTuple):
    """The successor of a distribution: what its class ends with, its attributes, and its parameters (old name -> new name)."""

    suffix: str
    attributes: tuple[str, ...] = ()
    parameters: dict[str, str] = {}  # noqa: RUF012 (never changed)


_BOUNDARIES = _DistributionForm("Boundaries", ("samplingType",))

_FORMS = {
    "BetaDistribution": _DistributionForm("BetaDistribution", ("alpha", "beta")),
    "Boundaries": _BOUNDARIES,
    "GaussDistribution": _DistributionForm("GaussDistribution", (), {"mean": "mean", "sd": "sd"}),
    "UniformDistribution": _DistributionForm("UniformDistribution"),
    "WeibullEstimators": _DistributionForm("WeibullEstimatorsDistribution", ("pRemainPromille",), {"mean": "average"}),
}

_UPPER = "upperBound"
_BOUNDS = {"lowerBound": "lowerBound", _UPPER: _UPPER}
_ZEROS = {DISCRETE: "0", CONTINUOUS: "0.0"}
_WEIBULL_PARAMETERS = ("kappa", "lambda")


class Values:
    """Converts constants and deviations."""

    def __init__(self, notes: StepNotes) -> None:
        self.notes = notes

    def number(self, node: Node, tag: str, owner: Node) -> Node | None:
        """A need, a number of instructions or a latency in the newer form, as a new part without container; None if nothing is left.

        Parameters
        ----------
        tag : that of the new part
        owner : the nearest object that can have custom properties
        """
        _drop_statistics(node, self.notes)
        inner = node.child(DEVIATIONS.get(node.type, "deviation"))
        if inner is not None:
            inner.remove()
            return inner if self.restate(inner, DISCRETE, tag, owner) else None
        attribute = CONSTANTS.get(node.type, "value")
        if node.type not in CONSTANTS and attribute not in node.attributes:
            self.notes.lost(node, "neither a value nor bounds are specified")
            return None
        made = Node(tag, "DiscreteValueConstant", origin=node.origin)
        if attribute in node.attributes:
            made.attributes["value"] = node.attributes[attribute]
        return made

    def restate(self, node: Node, kind: str, tag: str, owner: Node) -> bool:
        """Give a deviation the class of its distribution, and the parameters of it; whether a value is left."""
        distribution = node.child("distribution")
        form = _FORMS.get(distribution.type) if distribution is not None else None
        if form is None:
            if not _keep_bounds(node, distribution, kind, owner, self.notes):
                return False
            form = _BOUNDARIES
        elif distribution is not None:
            _take_attributes(node, distribution, form, self.notes)
        _take_parameters(node, distribution, kind, form, self.notes)
        node.tag, node.type = tag, kind + form.suffix
        self.default_bounds(node, kind, form)
        return True

    def default_bounds(self, node: Node, kind: str, form: _DistributionForm) -> None:
        """A missing lower bound of a number is 0: nothing of them is negative. A missing upper bound is left open.

        With 0, something that may take any time, or occur any number of times, would be taken for something that never does.
        """
        if kind == TIME or form.suffix == "GaussDistribution":
            return
        for name in _BOUNDS:
            if kind == TIME:
                bound = node.child_or_new(name)
                if "value" in bound.attributes:
                    continue
                bound.attributes["value"] = "0"
            elif name in node.attributes:
                continue
            elif name == _UPPER:
                self.notes.to_check(node, _UNBOUNDED, attribute=name)
                continue
            else:
                node.attributes[name] = _ZEROS[kind]
            self.notes.defaulted(node, "missing bound: 0", name, name)


def _drop_statistics(node: Node, notes: StepNotes) -> None:
    for statistic in node.all("fetchStatistic"):
        notes.lost(statistic, "fetch statistics of instructions have no successor", _summary(statistic))
        statistic.remove()


def _summary(node: Node) -> str:
    """Everything that the parts state, on one line."""
    return " ".join(f"{part.tag}({attributes_text(part, ' ')})" for part in node.children)


def _keep_bounds(node: Node, distribution: Node | None, kind: str, owner: Node, notes: StepNotes) -> bool:
    """Keep what a deviation states without a distribution that has a successor; whether there is something to keep."""
    if distribution is not None:
        stated = {name: text for name, text in distribution.attributes.items() if name in _WEIBULL_PARAMETERS}
        if stated:
            text = " ".join(f"{name}={value}" for name, value in stated.items())
            add_property(owner, distribution.type, text)
            notes.kept(distribution, "a distribution without a successor; only its bounds are part of the model now", text)
        _report_unknown(distribution, set(stated), notes)
    if node.child("lowerBound") or node.child("upperBound"):
        notes.converted(node, "deviation without a distribution that has a successor: its bounds are now Boundaries")
        return True
    if kind == TIME and distribution is not None:
        # Without it, a stimulus would have no jitter, instead of one of unknown size.
        notes.to_check(node, "the mandatory bounds were not specified; left open")
        return True
    notes.lost(node, "neither a value nor bounds are specified")
    return False


def _take_attributes(node: Node, distribution: Node, form: _DistributionForm, notes: StepNotes) -> None:
    _report_unknown(distribution, set(form.attributes), notes)
    for name in form.attributes:
        if name in distribution.attributes:
            node.attributes[name] = distribution.attributes[name]


def _report_unknown(node: Node, known: set[str], notes: StepNotes) -> None:
    for name, text in node.attributes.items():
        if name not in known:
            notes.lost(node, "not an attribute of this class", f"{name}={text!r}", name)


def _take_parameters(node: Node, distribution: Node | None, kind: str, form: _DistributionForm, notes: StepNotes) -> None:
    """Bounds, mean and the like: elements of times, attributes of numbers."""
    parts = [(part, _BOUNDS) for part in node.children if part is not distribution]
    if distribution is not None:
        keep_comments(distribution, node)
        parts += [(part, form.parameters) for part in distribution.children]
    node.set_children([])
    times = []
    for part, names in parts:
        part.parent = None
        name = names.get(part.tag)
        if name is None:
            notes.lost(part, f"no part of {node.tag}", f"<{part.tag}>")
        elif kind == TIME:
            part.tag, part.type = name, ""
            times.append(part)
        else:
            _take_number(node, part, name, notes)
    node.take(times)


def _take_number(node: Node, part: Node, name: str, notes: StepNotes) -> None:
    keep_comments(part, node)
    if "value" in part.attributes:
        node.attributes[name] = part.attributes["value"]
    if "unit" in part.attributes:
        notes.lost(part, "the unit of a number without dimension", part.attributes["unit"], "unit")
