"""Random models with constraints, and with further constructs; those of `generator` stay as they are."""

from __future__ import annotations

from itertools import pairwise, starmap
from random import Random

from opponent.models import writing
from opponent.models.generator import FEATURES, PERIODS, Generator, Plan, RandomModel, constrained, random_model
from opponent.models.writing import item

#: What is in some of these models, besides up to two of the other features.
FURTHER = (
    "equal periods", "data in runnables", "nested calls", "switch in a runnable", "unordered group", "chance", "cooperative",
    "few activations", "two chains", "long chain", "semaphore", "ceiling",
    "non-preemptive", "calls", "timed", "label events", "runnable events", "nested chain", "parallel chain",
)  # fmt: skip


def richer_model(seed: int, always: frozenset[str] = frozenset()) -> RandomModel:
    """The model of a number, with constraints: every third one is one of the other generator, unless it has some features always."""
    if seed % 3 == 0 and not always:
        return constrained(random_model(seed // 3), seed)
    return constrained(_Richer(Random(seed), always).model(), seed)


class _Richer(Generator):
    def __init__(self, rng: Random, always: frozenset[str]) -> None:
        self.always = always
        super().__init__(rng)

    def _features(self) -> set[str]:
        rng = self.rng
        constant = {"constant times"} if rng.random() < 0.5 else set()
        return {
            *self.always,
            *constant,
            *rng.sample(FURTHER, rng.choice((2, 3, 4))),
            *rng.sample(FEATURES, rng.choice((0, 0, 1, 2))),
        }

    def _ticks(self) -> str:
        if "constant times" in self.features:
            number = self.rng.randint(1, 4)
            return writing.ticks(number, number)
        return super()._ticks()

    def _period(self) -> int:
        if self.plans and self.has("equal periods", chance=0.8):
            return self.plans[0].period
        return self.rng.choice(PERIODS)

    def _mode(self, plan: Plan) -> str:
        return "cooperative" if self.has("cooperative", chance=0.6) else super()._mode(plan)

    def _limit(self) -> int:
        return self.rng.choice((1, 1, 2)) if self.has("few activations", chance=0.6) else 99

    # Bodies.

    def _item(self, plan: Plan) -> str:
        rng = self.rng
        if self.has("calls", "nested calls", chance=0.5):
            return self._call()
        if self.has("unordered group", chance=0.4):
            return writing.group(self._ticks() + self._call() + self._ticks(), is_ordered=False)
        if self.has("chance", chance=0.4):
            return self._chance()
        if self.has("cooperative", chance=0.3):
            return item("SchedulePoint")
        if self.features & {"semaphore", "ceiling"} and self.policy == "FixedPriorityPreemptive" and rng.random() < 0.4:
            return self._locked(plan)
        return super()._item(plan)

    def _chance(self) -> str:
        rng = self.rng
        return writing.chance((rng.randint(1, 3), self._ticks() if rng.random() < 0.7 else self._call()) for _ in range(2))

    def _call(self) -> str:
        """A call of a runnable, which can call another one."""
        if not self.has("nested calls", "switch in a runnable", chance=0.6):
            return super()._call()
        inner = super()._call()
        content = self._ticks() + inner if self.rng.random() < 0.6 else inner + self._ticks()
        if self.has("switch in a runnable", chance=0.7):
            content += self._switch()
        return self._runnable(content)

    def _switch(self) -> str:
        if not self.features & {"modes", "stimulus condition", "mode switch"}:
            return self._chance()
        branch = f'<entries name="e0">{self._ticks()}<condition>{self._condition()}</condition></entries>'
        return item("Switch", content=branch + f"<defaultEntry>{self._ticks()}</defaultEntry>")

    def _runnable(self, content: str, *, is_counted: bool = True) -> str:
        """A call of a new runnable."""
        name = f"r{self.runnables}"
        self.runnables += 1
        self.parts.runnables.append(writing.runnable(name, content))
        counter = writing.counter(2, 0) if is_counted and self.has("counter", chance=0.3) else ""
        return item("RunnableCall", f'runnable="{name}?type=Runnable"', counter)

    def _locked(self, plan: Plan) -> str:
        """An execution with a semaphore of a core, or two, one within the other; ISRs have none."""
        if plan.is_isr or self.has("server", "migration"):
            return self._ticks()
        names = [f"{plan.core}{which}" for which in "ab"[: self.rng.choice((1, 1, 2))]]
        content = self._ticks()
        for name in reversed(names):
            if not any(f'name="{name}"' in text for text in self.parts.semaphores):
                self.used |= self.features & {"semaphore"}
                self.parts.semaphores.append(writing.semaphore(name, has_ceiling=self.has("ceiling")))
            content = writing.semaphore_access(name, "request") + content + writing.semaphore_access(name, "release")
        return writing.group(content)

    # Chains.

    def _chain(self) -> None:
        rng = self.rng
        most = 4 if self.has("long chain") else 3
        path = rng.sample(self.plans, min(len(self.plans), rng.randint(2, most)))
        first = self._path(path, "L")
        if len(self.plans) > len(path) and self.has("parallel chain"):
            aside = rng.choice([plan for plan in self.plans if plan not in path])
            between = self._path([path[0], aside, path[-1]], "B")
            self._state_parallel("both", [first, [first[0], *between[1:-1], first[-1]]])
        self._state_chain("chain", first)
        if self.has("two chains"):
            # From the same stimulus to another response, or from another process.
            others = [plan for plan in self.plans if plan not in path] or self.plans[:1]
            other = [path[0] if rng.random() < 0.7 else path[-1], rng.choice(others)]
            if other[0] is not other[1]:
                events = self._path(other, "P")
                self._state_chain("other", [first[0], *events[1:]] if other[0] is path[0] else events)

    def _path(self, path: list[Plan], label: str) -> list[str]:
        """References to the events of a way through some processes, which share data."""
        rng = self.rng
        between = [self._process_event(plan, "terminate") for plan in path[1:]]
        steps = [[self._process_event(path[0], rng.choice(("start", "activate", "terminate")))]]
        if self.has("runnable events", chance=0.6):
            call, name = self._named_runnable(self._ticks())
            path[0].items.insert(0, call)
            steps = [[self._runnable_event(path[0], name, rng.choice(("start", "terminate")))]]
        for n, (source, target) in enumerate(pairwise(path)):
            is_explicit = self.has("label events", chance=0.7)
            self._share(source, target, f"{label}{n}", "explicit" if is_explicit else "")
            if is_explicit:
                steps.append(
                    [self._label_event(source, f"{label}{n}", "write"), self._label_event(target, f"{label}{n}", "read")]
                )
            elif n + 2 < len(path):
                steps.append([between[n]])
        if self.has("runnable events", chance=0.4):
            call, name = self._named_runnable(self._ticks())
            path[-1].items.append(call)
            steps.append([self._runnable_event(path[-1], name, "terminate")])
        else:
            steps.append([self._process_event(path[-1], rng.choice(("terminate", "terminate", "start")))])
        return list(dict.fromkeys(event for step in steps for event in step))

    def _event(self, kind: str, name: str, attributes: str) -> str:
        reference = f"{name}?type={kind}"
        text = f'<events xsi:type="am:{kind}" xmi:id="{reference}" name="{name}" {attributes}/>'
        if text not in self.parts.events:
            self.parts.events.append(text)
        return reference

    def _process_event(self, plan: Plan, change: str) -> str:
        entity = f"{plan.name}?type={plan.kind}"
        return self._event("ProcessEvent", f"{plan.name}.{change}", f'eventType="{change}" entity="{entity}"')

    def _runnable_event(self, plan: Plan, runnable: str, change: str) -> str:
        attributes = f'eventType="{change}" entity="{runnable}?type=Runnable" process="{plan.name}?type={plan.kind}"'
        return self._event("RunnableEvent", f"{runnable}.{change}", attributes)

    def _label_event(self, plan: Plan, label: str, change: str) -> str:
        attributes = f'eventType="{change}" entity="{label}?type=Label" process="{plan.name}?type={plan.kind}"'
        return self._event("LabelEvent", f"{label}.{change}.{plan.name}", attributes)

    def _state_chain(self, name: str, events: list[str]) -> None:
        """A chain of events; its first two steps can be a chain of their own."""
        items = list(starmap(writing.step, pairwise(events)))
        if len(items) > 2 and self.has("nested chain"):
            self._stated(f"{name} part", events[:3], items[:2])
            reference = f"{name}+part?type=EventChain"
            items[:2] = [f'<items xsi:type="am:EventChainReference" eventChain="{reference}"/>']
        self._stated(name, events, items)
        self.used.add("chain")

    def _state_parallel(self, name: str, ways: list[list[str]]) -> None:
        """Ways between the same events, one or all of which have to be completed."""
        branches = "".join(
            f'<items xsi:type="am:EventChainContainer"><eventChain name="" stimulus="{events[0]}" response="{events[-1]}" '
            f'itemType="sequence" minItemsCompleted="1">{"".join(starmap(writing.step, pairwise(events)))}</eventChain></items>'
            for events in ways
        )
        self.parts.chains.append(
            f'<eventChains xmi:id="{name}?type=EventChain" name="{name}" stimulus="{ways[0][0]}" response="{ways[0][-1]}" '
            f'itemType="parallel" minItemsCompleted="{self.rng.randint(1, 2)}">{branches}</eventChains>'
        )

    def _stated(self, name: str, events: list[str], items: list[str]) -> None:
        self.parts.chains.append(writing.chain(name, events[0], events[-1], items))

    def _named_runnable(self, content: str) -> tuple[str, str]:
        name = f"r{self.runnables}"
        return self._runnable(content, is_counted=False), name

    def _share(self, source: Plan, target: Plan, label: str, how: str = "") -> None:
        self.parts.data.append(writing.label(label))
        how = how or self.rng.choice(("explicit", "explicit", "implicit"))
        how = "timed" if self.has("timed", chance=0.6) and how == "implicit" else how
        in_runnables = self.has("data in runnables")
        for plan, access in ((source, "write"), (target, "read")):
            text = writing.label_access(label, access, how)
            if in_runnables:
                text = self._runnable("".join([self._ticks(), text] if self.rng.random() < 0.5 else [text, self._ticks()]))
                if self.has("nested calls", chance=0.5):
                    text = self._runnable(text + self._ticks())
            plan.items.insert(self.rng.randint(0, len(plan.items)), text)
