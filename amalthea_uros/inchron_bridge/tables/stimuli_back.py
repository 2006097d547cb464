"""Stimuli of the processes of a project."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any, get_args

from amalthea_uros.inchron.objects import ProjectObject
from amalthea_uros.inchron_bridge.basics.importing import Importing
from amalthea_uros.inchron_bridge.basics.values import time_of
from amalthea_uros.inchron_bridge.tables.conditions import extract_condition
from amalthea_uros.inchron_bridge.tables.os_back import processes_of
from amalthea_uros.inchron_bridge.tables.stimuli import GENERATOR, INDUCED, LIST, STIMULUS
from amalthea_uros.perf import stimuli as perf
from amalthea_uros.perf.conditions import Condition
from amalthea_uros.perf.distributions import Constant, Distribution, Gauss, Uniform

_KINDS = get_args(perf.Stimulus)


class StimuliReader:
    """The stimuli of a project, and which of them activate each process."""

    def __init__(self, context: Importing, model: ProjectObject) -> None:
        self.context = context
        self.model = model
        self.stimuli: list[Any] = []
        self.of_process: dict[ProjectObject, list[str]] = {}

    def read(self) -> None:
        """Read all."""
        generators = [each for scenario in self._scenarios() for each in scenario["generators"]]
        drivers = {each["sourceGenerator"] for each in generators if each.kind == INDUCED}
        for each in generators:
            if each not in drivers or each["targets"] is not None:
                self.add(each, each["targets"])
        for connection in self.model["connections"]:
            if connection.kind == "ActivationConnection":
                self.add(connection, connection["callGraph"])
            else:
                self.context.leave_out(connection)
        for process in processes_of(self.model):
            if process["activeAtBoot"]:
                name = self.context.name("Stimulus", process, f"boot_of_{process.name}")
                self.stimuli.append(perf.Single(name=name, time=0))
                self.activate(process, name)

    def _scenarios(self) -> Iterator[ProjectObject]:
        """The default scenario; all of them, if that is a composite one."""
        chosen = self.model["defaultScenario"]
        for scenario in self.model["scenarios"]:
            if scenario.kind != "stimulation.StimulationScenario":
                self.context.leave_out(scenario)
            elif chosen is None or chosen.kind != "stimulation.StimulationScenario" or scenario is chosen:
                if scenario["burstPattern"] is not None:
                    self.context.leave_out(scenario, "StimulationScenario.burstPattern")
                yield scenario
            elif scenario["generators"]:
                self.context.leave_out(scenario, "a scenario that is not the default one")

    def add(self, holder: ProjectObject, graph: ProjectObject | None) -> None:
        """A generator or connection with what it activates; one stimulus for each condition."""
        first = True
        for condition, targets, counter in self.activations(graph) or [(None, [], None)]:
            name = self.context.name("Stimulus", holder, None if first else f"{holder.name}_2")
            first = False
            result = self.stimulus(holder, name)
            if condition is not None:
                result = [replace(each, condition=condition) for each in result]
            if counter is not None and holder.kind == "ActivationConnection":
                result = [replace(each, counter=each.counter or counter) for each in result]
            self.stimuli += result
            for target in targets:
                for each in result:
                    self.activate(target, each.name)

    def activate(self, process: ProjectObject, stimulus: str) -> None:
        """Note that a stimulus activates a process."""
        self.of_process.setdefault(process, []).append(stimulus)

    def activations(
        self, graph: ProjectObject | None
    ) -> list[tuple[Condition | None, list[ProjectObject], perf.Counter | None]]:
        """The processes that a call graph activates, by the condition under which it does."""
        result: list[tuple[Condition | None, list[ProjectObject], perf.Counter | None]] = []
        for entry in graph["graphEntries"] if graph is not None else ():
            if entry.kind == "CallSequence":
                result.append((None, *self.targets(entry)))
            elif entry.kind == "Switch" and len(entry["entries"]) == 1 and entry["defaultEntry"] is None:
                case = entry["entries"][0]
                condition = None if case["negated"] else extract_condition(case["condition"], self.context)
                for inner in case["graphEntries"]:
                    if inner.kind == "CallSequence":
                        result.append((condition or Condition(()), *self.targets(inner)))
                    else:
                        self.context.leave_out(inner, f"a {inner.kind} in what a generator activates")
            else:
                # Whatever is in it may be activated each time.
                self.context.leave_out(entry, f"a {entry.kind} in what a generator activates")
                targets = [each["target"] for each in entry.walk() if each.kind == "ActivateProcess"]
                result.append((Condition(()), [each for each in targets if each is not None], None))
        return result

    def targets(self, sequence: ProjectObject) -> tuple[list[ProjectObject], perf.Counter | None]:
        """The processes that a sequence activates, and every how often."""
        targets, counters = [], set()
        for call in sequence["calls"]:
            if call.kind != "ActivateProcess":
                self.context.leave_out(call, f"a {call.kind} of a generator")
            elif call["target"] is None:
                self.context.leave_out(call, "an activation without a process")
            else:
                targets.append(call["target"])
                counters.add((call["period"], call["offset"]))
        if len(counters) == 1 and counters != {(1, 0)}:
            period, offset = counters.pop()
            return targets, perf.Counter(prescaler=period, offset=offset)
        return targets, None

    def stimulus(self, item: ProjectObject, name: str) -> list[Any]:
        """The stimuli for a generator or connection; several for a list of times."""
        kept = self.context.whole(item, STIMULUS, _KINDS)
        if kept is not None:
            return [replace(kept, name=name, origin=self.context.location(item))]
        known: dict[str, Any] = {"name": name, "origin": self.context.location(item)}
        known |= self.context.fields(item, perf.AbstractStimulus, ("assignments",))
        if item.kind == "ActivationConnection":
            counter = self.context.whole(item, "counter", (perf.Counter,))
            return [perf.InterProcess(**known, counter=counter)]
        reason = _obstacle(item)
        result: list[Any] | None = None
        if reason is None and item.kind == GENERATOR:
            result = self._random(item, known)
        elif reason is None and item.kind in (LIST, INDUCED):
            result = self._list(item, known)
        if result is None:
            self.context.leave_out(item, f"a {item.kind} {reason or 'with values that cannot be converted'}")
            return [perf.Custom(**known, description=f"a {item.kind} of the project, which is not understood")]
        return result

    def _random(self, item: ProjectObject, known: dict[str, Any]) -> list[Any] | None:
        period, shortest = time_of(item["period"]), time_of(item["minimumInterArrivalTime"])
        low, high, sigma = (time_of(item["variation"][each]) for each in ("min", "max", "sigma"))
        start, end = (time_of(item["startOffsetVariation"][each]) for each in ("min", "max"))
        kind, variation, pattern = item["startOffsetVariation"]["type"], item["variation"]["type"], item["burstPatternSettings"]
        if None in (period, shortest, low, high, sigma, start, end) or not period:
            return None
        offset = end if kind == "Max" else start
        is_shifted = kind == "Uniform" and start != end
        if pattern is not None:
            length, distance = time_of(pattern["patternLength"]), time_of(pattern["minimumInterArrivalTime"])
            if item["relative"] or variation != "None" or is_shifted or length is None or distance is None:
                return None
            count = pattern["maximumOccurrences"]
            return [perf.Burst(**known, period=period, length=length, distance=distance, count=count, offset=offset or 0)]
        if item["relative"]:
            distribution: Distribution[int] = Constant(period)
            if variation == "Uniform":
                distribution = Uniform(lower=period + (low or 0), upper=period + (high or 0))
            elif variation == "Normal":
                bounds = (None, None) if not low and not high else (period + (low or 0), period + (high or 0))
                distribution = Gauss(mean=float(period), deviation=float(sigma or 0), lower=bounds[0], upper=bounds[1])
            kept = self.context.fields(item, perf.RelativePeriodic, ("has_maximum",))
            return [perf.RelativePeriodic(**known, distance=distribution, offset=offset or 0, **kept)]
        if is_shifted:
            return None
        jitter: Distribution[int] | None = None
        if variation == "Uniform":
            jitter = Uniform(lower=low or 0, upper=high or 0)
        elif variation == "Normal":
            limits = (None, None) if not low and not high else (low, high)
            jitter = Gauss(mean=0.0, deviation=float(sigma or 0), lower=limits[0], upper=limits[1])
        return [perf.Periodic(**known, period=period, offset=offset or 0, jitter=jitter, min_distance=shortest or None)]

    def _list(self, item: ProjectObject, known: dict[str, Any]) -> list[Any] | None:
        times = [time_of(each) for each in item["entries"]]
        if any(time is None for time in times):
            return None
        result = tuple(time for time in times if time is not None)
        if item.kind == LIST:
            name = known["name"]
            others = [
                self.context.name("Stimulus", entry, f"{name}_{number}")
                for number, entry in enumerate(item["entries"])
                if number
            ]
            return [
                perf.Single(**{**known, "name": each}, time=time) for each, time in zip([name, *others], result, strict=False)
            ]
        driver = item["sourceGenerator"]
        if (
            driver is None
            or driver.kind != GENERATOR
            or (item["period"], item["offset"]) != (1, 0)
            or item["delay"] is not None
        ):
            return None
        base = self._random(driver, {"name": known["name"]}) if _obstacle(driver) is None else None
        if base is None or not isinstance(base[0], perf.Periodic) or base[0].jitter is not None or not result:
            return None
        return [perf.Synthetic(**known, period=base[0].period, times=result, offset=base[0].offset)]


def _obstacle(generator: ProjectObject) -> str | None:
    """Why the times of a generator cannot be known."""
    if generator["filters"]:
        return "with filters"
    clock = generator["clock"]
    if clock is not None and clock["drift"]:
        return "whose clock drifts"
    return None
