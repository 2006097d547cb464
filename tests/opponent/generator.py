"""Random systems in the plain form, with constructs nested in each other, small enough to be played.

What no reading defines is left out: waiting inside a non-interruptible group (nobody could end the wait), semaphores nested in
different orders (deadlock), and semaphores on a core with round robin.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from random import Random
from typing import Any

from opponent.models.generator import RandomModel
from opponent.systems import Item, PlainSystem, constructs_of, items_of
from opponent.to_text import to_text

#: Periods as multiples of a base: harmonic, and others with a small hyperperiod.
FAMILIES = ((1, 2, 4, 8), (1, 2, 4), (1, 2, 3, 6), (2, 3, 6), (2, 3, 4, 6, 12), (4, 5, 10, 20))
#: From which modes of preemption the tasks of a system choose.
MIXTURES = (
    ("preemptive",),
    ("preemptive",),
    ("preemptive", "cooperative", "non-preemptive"),
    ("preemptive", "cooperative"),
    ("preemptive", "non-preemptive"),
    ("cooperative",),
)


def random_system(seed: int) -> PlainSystem:
    """The system of a seed."""
    rng = Random(seed)
    return pile_up(rng) if some(rng, 0.05) else Generator(rng).system()


def nested_model(seed: int) -> RandomModel:
    """The same as a model, with a pair of events between which a delay can be limited."""
    system = random_system(seed)
    first, *_, last = [process["name"] for process in (system["processes"] * 2)[:-1]]
    return RandomModel(to_text(system), constructs_of(system), (((first, "start"), (last, "terminate")),))


def pile_up(rng: Random) -> PlainSystem:
    """One that comes often waits for a long stretch of the lowest process, shortly before the one in between is released.

    Arrivals that meet like this are rare among systems without a plan.
    """
    stretch, period = rng.randint(4, 12), rng.choice((40, 60))
    begin = rng.randint(0, 5)
    group: Item = {"group": [{"execute": [stretch, stretch]}], "interruptible": False}
    frequent = {"periodic": {"period": 3, "offset": rng.randint(0, 2), "jitter": rng.randint(1, 2)}}
    if some(rng, 0.7):
        least = rng.randint(2, 4)
        frequent = {"sporadic": {"least": least, "most": least + rng.randint(0, 3), "offset": rng.randint(0, 4)}}

    def process(priority: int, arrival: dict[str, Any], body: list[Item], preemption: str = "preemptive") -> dict[str, Any]:
        return {
            "name": f"T{priority}",
            "kind": "task",
            "core": "core0",
            "priority": priority,
            "preemption": preemption,
            "arrival": arrival,
            "body": body,
        }

    def known(offset: int) -> dict[str, Any]:
        return {"periodic": {"period": period, "offset": offset}}

    lowest = [rng.choice((group, {"execute": [stretch, stretch]}))]
    middle = [{"execute": [1, rng.randint(1, 3)]}]
    return {
        "cores": {"core0": rng.choice(("FPP", "OSEK"))},
        "semaphores": {},
        "runnables": {},
        "processes": [
            process(3, frequent, [{"execute": [1, 1]}]),
            process(2, known(begin + rng.randint(0, stretch + 4)), middle, rng.choice(("preemptive", "non-preemptive"))),
            process(1, known(begin), lowest, "preemptive" if lowest[0] is group else "non-preemptive"),
        ],
    }


def some(rng: Random, probability: float) -> bool:
    """True with a probability."""
    return rng.random() < probability


#: With which probability a construct occurs at a place, in systems that have it; most have few of them.
USUAL = {
    "group": 0.25,
    "unordered": 0.5,
    "mask": 0.15,
    "switch": 0.15,
    "call": 0.3,
    "counter": 0.4,
    "lock": 0.3,
    "trigger": 0.35,
    "point": 0.5,
    "varying": 0.35,
}


def drawn_style(rng: Random) -> dict[str, float]:
    """Some constructs with their usual probability, the others never."""
    chosen = {name for name in USUAL if some(rng, 0.4)}
    # Counters and schedule points need others to occur at all.
    if chosen & {"call", "trigger"} and some(rng, 0.4):
        chosen.add("counter")
    if some(rng, 0.5):
        chosen.add("point")
    return {name: probability if name in chosen else 0.0 for name, probability in USUAL.items()}


@dataclass(slots=True)
class Place:
    """Where an item is: what it may be there."""

    process: dict[str, Any] | None
    core: str
    depth: int = 0
    held: tuple[str, ...] = ()
    is_masked: bool = False
    first_runnable: int = 0

    def inside(self, **changes: Any) -> Place:
        """One level deeper."""
        return replace(self, depth=self.depth + 1, **changes)


@dataclass(slots=True)
class Generator:
    """Draws one system."""

    rng: Random
    style: dict[str, float] = field(init=False)
    cores: dict[str, str] = field(default_factory=dict)
    semaphores: dict[str, dict[str, bool]] = field(default_factory=dict)
    runnables: dict[str, list[Item]] = field(default_factory=dict)
    runnable_cores: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.style = drawn_style(self.rng)

    def system(self) -> PlainSystem:
        """The whole system."""
        rng = self.rng
        for index in range(1 if some(rng, 0.75) else 2):
            self.cores[f"core{index}"] = rng.choice(("FPP", "FPP", "FPP", "OSEK", "OSEK", "EDF", "RR"))
            for letter in "AB" if self.style["lock"] else "":
                self.semaphores[f"s{index}{letter}"] = {"ceiling": some(rng, 0.6)}
        processes = self._processes()
        for index in reversed(range(rng.randint(1, 4) if self.style["call"] else 0)):
            core = rng.choice(list(self.cores))
            self.runnable_cores[f"r{index}"] = core
            self.runnables[f"r{index}"] = self._body(Place(None, core, depth=1, first_runnable=index + 1))
        for process in processes:
            process["body"] = self._body(Place(process, process["core"]))
        self._trigger(processes)
        used = {name: body for name, body in sorted(self.runnables.items()) if name in self._called(processes)}
        system: PlainSystem = {
            "cores": self.cores,
            "semaphores": self.semaphores,
            "runnables": used,
            "processes": processes,
        }
        self._slow_down(system)
        if some(rng, 0.35):
            self._chain(system)
        return system

    def _called(self, processes: list[dict[str, Any]]) -> set[str]:
        system = {"runnables": self.runnables}
        return {item["call"] for process in processes for item in items_of(system, process["body"]) if "call" in item}

    # Processes.

    def _processes(self) -> list[dict[str, Any]]:
        rng, count = self.rng, self.rng.choice((2, 2, 3, 3, 3, 4, 4, 5))
        base, family = rng.randint(5, 12), rng.choice(FAMILIES)
        priorities = [rng.randint(1, 4) for _ in range(count)] if some(rng, 0.2) else rng.sample(range(1, 10), count)
        modes = rng.choice(MIXTURES)
        exotic = {name for name in ("offset", "jitter", "sporadic", "isr") if some(rng, 0.25)}
        found = []
        for index in range(count):
            core = rng.choice(list(self.cores))
            policy = self.cores[core]
            period = base * rng.choice(family)
            is_isr = "isr" in exotic and some(rng, 0.4)
            process: dict[str, Any] = {
                "name": f"T{index}",
                "kind": "isr" if is_isr else "task",
                "core": core,
                "priority": priorities[index],
                "preemption": "preemptive" if is_isr or policy == "RR" else rng.choice(modes),
            }
            if policy == "EDF" and process["preemption"] == "cooperative":
                process["preemption"] = "non-preemptive"
            process["arrival"] = self._arrival(period, exotic, index)
            if policy == "EDF" and not is_isr:
                process["deadline"] = rng.randint(period // 2, period + period // 4)
            if policy == "RR" and not is_isr:
                process["slice"] = rng.randint(1, 4)
            found.append(process)
        return found

    def _arrival(self, period: int, exotic: set[str], index: int) -> dict[str, Any]:
        rng = self.rng
        if index and self.style["trigger"] and some(rng, self.style["trigger"]):
            counter = self._counter() if some(rng, 0.3) else {}
            return {"trigger": counter}
        if "sporadic" in exotic and some(rng, 0.5):
            offset = rng.randrange(period) if "offset" in exotic else 0
            return {"sporadic": {"least": period, "most": period + rng.randint(0, period), "offset": offset}}
        given = {"period": period}
        if "offset" in exotic and some(rng, 0.6):
            given["offset"] = rng.randrange(period)
        if "jitter" in exotic and some(rng, 0.6):
            given["jitter"] = rng.randint(1, period - 1)
        return {"periodic": given}

    def _trigger(self, processes: list[dict[str, Any]]) -> None:
        """Have each triggered process triggered by one before it, sometimes by two."""
        rng = self.rng
        for index, process in enumerate(processes):
            if "trigger" not in process["arrival"]:
                continue
            for _ in range(2 if some(rng, 0.15) else 1):
                source = rng.choice(processes[:index])
                body = self._somewhere(source["body"])
                item: Item = {"trigger": process["name"], **(self._counter() if some(rng, self.style["counter"]) else {})}
                at = rng.randint(0, len(body))
                body.insert(at, item)
                if self._is_triggered_later(processes, index):
                    del body[at]
                    source["body"].append(item)

    def _is_triggered_later(self, processes: list[dict[str, Any]], index: int) -> bool:
        """Whether a process is triggered by itself or one after it, as they call a runnable that triggers it."""
        system, name = {"runnables": self.runnables}, processes[index]["name"]
        return any(item.get("trigger") == name for p in processes[index:] for item in items_of(system, p["body"]))

    def _somewhere(self, body: list[Item]) -> list[Item]:
        """A body or one within it, also that of a runnable."""
        found = [body, body]
        for item in body:
            if "group" in item:
                found.append(self._somewhere(item["group"]))
            elif "switch" in item:
                found += [self._somewhere(branch) for _, branch in item["switch"]]
            elif "call" in item:
                found.append(self.runnables[item["call"]])
        return self.rng.choice(found)

    def _slow_down(self, system: PlainSystem) -> None:
        """Stretch periods until no core is overloaded, but for a few systems."""
        most = 1.2 if some(self.rng, 0.03) else 1.0 if some(self.rng, 0.2) else 0.85
        while max(_loads(system).values()) > most:
            for process in system["processes"]:
                for given in process["arrival"].values():
                    for key in ("period", "least", "most"):
                        if key in given:
                            given[key] *= 2
                if "deadline" in process:
                    process["deadline"] *= 2

    # Bodies.

    def _body(self, place: Place) -> list[Item]:
        count = self.rng.randint(1, 4) if place.depth == 0 else self.rng.randint(1, 2)
        body = [item for _ in range(count) for item in self._items(place)]
        if place.depth == 0 and not any("execute" in item for item in body):
            body.insert(self.rng.randint(0, len(body)), self._execute())
        return body

    def _execute(self) -> Item:
        least = self.rng.randint(1, 4)
        return {"execute": [least, least + (self.rng.randint(0, 3) if some(self.rng, self.style["varying"]) else 0)]}

    def _items(self, place: Place) -> list[Item]:
        """An item, or a critical section."""
        rng, style = self.rng, self.style
        is_deep = place.depth >= 3
        if not is_deep and some(rng, style["group"]):
            if some(rng, style["unordered"]):
                return [{"group": [_whole(self._items(place.inside())) for _ in range(rng.randint(1, 3))], "ordered": False}]
            return [{"group": self._body(place.inside())}]
        if not is_deep and some(rng, style["mask"]) and not place.is_masked:
            return [{"group": self._body(place.inside(is_masked=True)), "interruptible": False}]
        if not is_deep and some(rng, style["switch"]):
            weights = [rng.choice((1.0, 3.0)) for _ in range(rng.randint(2, 3))]
            return [{"switch": [[weight, self._body(place.inside()) if index else []] for index, weight in enumerate(weights)]}]
        if some(rng, style["lock"]) and (semaphores := self._requestable(place)):
            chosen = rng.choice(semaphores)
            held = (*place.held, chosen)
            inner = [self._execute()] if is_deep or some(rng, 0.5) else self._body(place.inside(held=held))
            return [{"request": chosen}, *inner, {"release": chosen}]
        if some(rng, style["call"]) and (callable_here := self._callable(place)):
            counter = self._counter() if some(rng, style["counter"]) else {}
            return [{"call": rng.choice(callable_here), **counter}]
        if some(rng, style["point"]) and place.process is not None and place.process["preemption"] == "cooperative":
            return [self._execute(), {"point": True}]
        return [self._execute()]

    def _counter(self) -> dict[str, int]:
        return {"prescaler": self.rng.randint(2, 3), "offset": self.rng.randint(0, 3)}

    def _requestable(self, place: Place) -> list[str]:
        """The semaphores of the core that may be requested: in one order, and of one kind within each other."""
        policy = self.cores[place.core]
        if policy == "RR" or (place.process is not None and place.process["kind"] == "isr"):
            return []
        found = [name for name in self.semaphores if name[1] == place.core[-1] and all(name > held for held in place.held)]
        found = [name for name in found if all(self._has_ceiling(name) == self._has_ceiling(held) for held in place.held)]
        return [name for name in found if not place.is_masked or (self._has_ceiling(name) and policy != "EDF")]

    def _has_ceiling(self, semaphore: str) -> bool:
        return self.semaphores[semaphore]["ceiling"]

    def _callable(self, place: Place) -> list[str]:
        """The runnables that come later, whose semaphores may be requested here."""
        found = []
        for name, body in self.runnables.items():
            requested = {item["request"] for item in items_of({"runnables": self.runnables}, body) if "request" in item}
            if int(name[1:]) >= place.first_runnable and requested <= set(self._requestable(place)):
                found.append(name)
        return found

    # Chains.

    def _chain(self, system: PlainSystem) -> None:
        """A chain of some processes that are released by time, which pass labels on."""
        rng = self.rng
        communication = rng.choice(("implicit", "explicit", "LET"))
        timed = [p for p in system["processes"] if "trigger" not in p["arrival"]]
        if communication == "LET":
            timed = [p for p in timed if "periodic" in p["arrival"] and "jitter" not in p["arrival"]["periodic"]]
        if len(timed) < 2:
            return
        chosen = rng.sample(timed, min(rng.choice((2, 2, 3)), len(timed)))
        for position, process in enumerate(chosen):
            body = process["body"]
            read_at = rng.randint(0, len(body))
            if position < len(chosen) - 1:
                body.insert(rng.randint(read_at, len(body)), {"write": f"L{position}"})
            if position:
                body.insert(read_at, {"read": f"L{position - 1}"})
        system["chain"] = {"processes": [process["name"] for process in chosen], "communication": communication}


def _whole(items: list[Item]) -> Item:
    """One item for several, such as a critical section, that no other order may tear apart."""
    return items[0] if len(items) == 1 else {"group": items}


def _loads(system: PlainSystem) -> dict[str, float]:
    """The load of each core in the worst case."""
    rates: dict[str, float] = {}
    loads = dict.fromkeys(system["cores"], 0.0)
    for process in system["processes"]:
        arrival, name = process["arrival"], process["name"]
        if "trigger" in arrival:
            sources = [p for p in system["processes"] if p["name"] in rates]
            triggers = sum(rates[p["name"]] * _most_triggers(system, p["body"], name) for p in sources)
            rates[name] = triggers / arrival["trigger"].get("prescaler", 1)
        else:
            given = arrival.get("periodic") or arrival["sporadic"]
            rates[name] = 1 / (given.get("period") or given["least"])
        loads[process["core"]] += rates[name] * _demand(system, process["body"])
    return loads


def _demand(system: PlainSystem, body: list[Item]) -> float:
    return sum(_of_item(system, item, lambda i: i["execute"][1] if "execute" in i else 0) for item in body)


def _most_triggers(system: PlainSystem, body: list[Item], name: str) -> float:
    return sum(_of_item(system, item, lambda i: 1 if i.get("trigger") == name else 0) for item in body)


def _of_item(system: PlainSystem, item: Item, value: Any) -> float:
    """What an item and those in it amount to, branches with the most."""
    inner = [item["group"]] if "group" in item else []
    inner += [system["runnables"][item["call"]]] if "call" in item else []
    branches = [sum(_of_item(system, i, value) for i in branch) for _, branch in item.get("switch", ())]
    total = value(item) + sum(_of_item(system, i, value) for body in inner for i in body) + max(branches, default=0)
    return float(total / item.get("prescaler", 1))
