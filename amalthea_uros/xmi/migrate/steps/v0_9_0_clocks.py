"""0.8.3 -> 0.9.0, hardware: quartzes -> frequency domains; prescalers -> the domain of the quartz, or one of their own."""

from __future__ import annotations

from fractions import Fraction
from math import isfinite

from amalthea_uros.units import FREQUENCY
from amalthea_uros.xmi.emf.data_types import format_double, parse_float
from amalthea_uros.xmi.migrate.steps.tools import free_key
from amalthea_uros.xmi.migrate.steps.v0_9_0_definitions import Shape, hash_order
from amalthea_uros.xmi.tree.model_set import ModelSet
from amalthea_uros.xmi.tree.node import Node
from amalthea_uros.xmi.tree.notes import StepNotes

_DOMAIN = Shape("quartzes", parts=frozenset({"defaultValue"}))
_HERTZ = {"": 1, "_undefined_": 1, **FREQUENCY.units}


class Clocks:
    """The frequency domains of a set of files."""

    def __init__(self, notes: StepNotes) -> None:
        self.notes = notes
        self.domains: dict[tuple[Node, str], Node] = {}
        self.names: set[str] = set()

    def convert_quartzes(self, models: ModelSet) -> None:
        """Make every quartz a frequency domain of its hardware model."""
        for hardware in models.parts("hwModel"):
            quartzes = [node for node in list(hardware.walk()) if node.tag == "quartzes" and self._is_convertible(node)]
            # The order has no meaning: that of APP4MC, so that results can be compared.
            hardware.take(hash_order(quartzes))
            for quartz in quartzes:
                self.notes.converted(quartz, "quartz -> frequency domain")
                self._convert_quartz(quartz)
        self.names = {node.name for node in models.parts("hwModel", "domains")}

    def _is_convertible(self, quartz: Node) -> bool:
        if quartz.name or quartz.children:
            return True
        self.notes.lost(quartz, "quartz without name")
        quartz.remove()
        return False

    def _convert_quartz(self, quartz: Node) -> None:
        quartz.tag, quartz.type = "domains", "FrequencyDomain"
        frequency = quartz.child("frequency")
        if frequency is not None:
            frequency.tag = "defaultValue"
        _DOMAIN.reduce(quartz, self.notes)

    def convert_prescaler(self, module: Node) -> None:
        """Replace the prescaler of a module by a reference to a frequency domain."""
        prescaler = module.child("prescaler")
        if prescaler is None:
            return
        prescaler.remove()
        quartz = prescaler.target("quartz")
        if quartz is None:
            if prescaler.get("clockRatio", "1.0") not in ("0.0", "1.0"):
                self.notes.lost(module, "clock ratio of a prescaler without quartz", prescaler.get("clockRatio"))
            return
        ratio = self.ratio(prescaler)
        if ratio is None:
            domain: Node | None = quartz
        elif quartz.tag == "domains":
            domain = self.domain(quartz, ratio)
        else:
            domain = None
        if domain is None:
            self.notes.lost(
                module, "prescaler: its quartz is not in the files", f"{quartz.get('path') or quartz.name} x {ratio}"
            )
            return
        module.refer("frequencyDomain", domain)
        self.notes.converted(module, "prescaler -> frequency domain", domain.name)

    def ratio(self, prescaler: Node) -> str | None:
        """The factor as text; None if the clock is that of the quartz."""
        text = prescaler.get("clockRatio")
        number = _number(text)
        if not text or number == 0:
            self.notes.defaulted(prescaler, "prescaler without clock ratio, or with ratio 0; assuming 1", text, "clockRatio")
            return None
        return None if number == 1 else text.strip()

    def domain(self, quartz: Node, ratio: str) -> Node:
        """The domain of the prescalers with that quartz and that ratio."""
        known = self.domains.get((quartz, ratio))
        if known is not None:
            return known
        made = self.domains[quartz, ratio] = quartz.copy()
        made.attributes["name"] = self._name(quartz, ratio)
        assert quartz.parent is not None
        quartz.parent.insert(made)
        frequency = made.child("defaultValue")
        if frequency is not None and "value" in frequency.attributes:
            factor, value = _number(ratio), _number(frequency.get("value"))
            if factor is not None and value is not None and factor > 0:
                frequency.attributes["value"] = format_double(value * factor)
            else:
                # It is not the frequency of the quartz either.
                words = "not a number" if factor is None or value is None else "negative"
                self.notes.lost(made, f"frequency after a prescaler: {words}", f"{frequency.get('value')} x {ratio}")
                frequency.remove()
        return made

    def _name(self, quartz: Node, ratio: str) -> str:
        """The name of the domain of a prescaler. References are names, so it must not be that of another domain."""
        name = free_key(f"{quartz.name}__{ratio}", self.names)
        self.names.add(name)
        return name


def frequency_of(domain: Node | None) -> Fraction | None:
    """The frequency of a domain in Hz, None if it is not known; without unit it is in Hz."""
    stated = domain.child("defaultValue") if domain is not None else None
    number = _number(stated.get("value")) if stated is not None else None
    scale = _HERTZ.get(stated.get("unit")) if stated is not None else None
    return Fraction(number) * scale if number and scale else None


def _number(text: str) -> float | None:
    try:
        number = parse_float(text)
    except ValueError:
        return None
    return number if isfinite(number) else None
