"""Random models, as text, with the constructs of ../shared/vectors/constructs2, those that nobody can analyse, and further ones."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise, starmap
from random import Random

from opponent.models import writing
from opponent.models.choosing import constraints_of
from opponent.models.constraints import Constraint
from opponent.models.erasing import erased
from opponent.models.reading import UnplayableError
from opponent.models.writing import Parts, item, ticks, time

#: What is in some models; a plain model has one to four of them.
FEATURES = (
    "modes", "stimulus condition", "channel", "burst", "arrival curve", "variable rate", "synthetic times", "single",
    "trigger", "custom event", "server", "EDF", "deadline monotonic", "round robin", "scheduler overhead", "isr", "isr overhead",
    "activation overhead", "core frequency", "start-up", "exclusive triggers", "several links", "mode switch", "group",
    "non-preemptive", "jitter", "sporadic", "two stimuli", "migration", "counter",
)  # fmt: skip
#: What is in richer models, besides up to two of the other features.
FURTHER = (
    "equal periods", "data in runnables", "nested calls", "switch in a runnable", "unordered group", "chance", "cooperative",
    "few activations", "two chains", "long chain", "semaphore", "ceiling",
    "non-preemptive", "calls", "timed", "label events", "runnable events", "nested chain", "parallel chain",
)  # fmt: skip
RELATIONS = ("EQUAL", "NOT_EQUAL", "LESS_THAN", "GREATER_THAN", "LESS_THAN_OR_EQUAL", "GREATER_THAN_OR_EQUAL")
#: Of the models, those of which something is not told.
SHARE_HIDING = 0.2
PERIODS = (40, 60, 80, 120)
POLICIES = {"EDF": "EarliestDeadlineFirst", "deadline monotonic": "DeadlineMonotonic", "round robin": "PriorityBasedRoundRobin"}


@dataclass(slots=True)
class Plan:
    """A task or interrupt service routine that is being made."""

    name: str
    is_isr: bool
    core: str
    period: int
    items: list[str] = field(default_factory=list)
    stimuli: list[str] = field(default_factory=list)
    is_fired: bool = False

    @property
    def kind(self) -> str:
        """The class in the language."""
        return "ISR" if self.is_isr else "Task"


@dataclass(frozen=True, slots=True)
class RandomModel:
    """A model, what it has in it, and pairs of events between which a delay can be limited, and what else can be.

    Attributes
    ----------
    hides : number of what is not told; None: nothing is
    """

    text: str
    features: frozenset[str]
    delays: tuple[tuple[tuple[str, str], tuple[str, str]], ...]
    hides: int | None = None
    constraints: tuple[Constraint, ...] = ()

    def told(self) -> tuple[str, frozenset[str]]:
        """What the model states, and what is in it."""
        if self.hides is None:
            return self.text, self.features
        text, name = erased(self.text, Random(self.hides))
        return text, self.features | ({name} if name else set())


def random_model(seed: int) -> RandomModel:
    """The model of a number."""
    rng = Random(seed)
    return Generator(rng, set(rng.sample(FEATURES, rng.choice((1, 2, 2, 3, 4))))).model()


def richer_model(seed: int, always: frozenset[str] = frozenset()) -> RandomModel:
    """The model of a number, with constraints: every third one is a plain one, unless it has some features always."""
    if seed % 3 == 0 and not always:
        return constrained(random_model(seed // 3), seed)
    rng = Random(seed)
    constant = {"constant times"} if rng.random() < 0.5 else set()
    further, others = rng.sample(FURTHER, rng.choice((2, 3, 4))), rng.sample(FEATURES, rng.choice((0, 0, 1, 2)))
    return constrained(Generator(rng, {*always, *constant, *further, *others}).model(), seed)


def constrained(model: RandomModel, seed: int) -> RandomModel:
    """The same model with constraints."""
    try:
        return replace(model, constraints=constraints_of(model.text, Random(seed)))
    except UnplayableError:
        return model


class Generator:
    """Makes a model, part by part."""

    def __init__(self, rng: Random, features: set[str]) -> None:
        self.rng, self.parts, self.features = rng, Parts(), features
        if rng.random() < 0.25:
            self.features = {f for f in self.features if f not in POLICIES}
        self.plans: list[Plan] = []
        self.used: set[str] = set()
        self.runnables = 0

    def _period(self) -> int:
        if self.plans and self.has("equal periods", chance=0.8):
            return self.plans[0].period
        return self.rng.choice(PERIODS)

    def has(self, *names: str, chance: float = 1.0) -> bool:
        """Whether the model shall have something, here."""
        if self.features & set(names) and self.rng.random() < chance:
            self.used |= self.features & set(names)
            return True
        return False

    def model(self) -> RandomModel:
        rng, parts = self.rng, self.parts
        number = rng.choice((1, 1, 2))
        if self.has("migration"):
            number = 2
        parts.cores = {
            f"c{n}": rng.choice(("2.0", "0.5", "4.0")) if n and self.has("core frequency") else "1.0" for n in range(number)
        }
        self.policy = next((POLICIES[f] for f in POLICIES if f in self.features), "FixedPriorityPreemptive")
        self.used |= self.features & set(POLICIES)
        for n in range(rng.choice((2, 3, 3, 4))):
            self.plans.append(Plan(f"T{n}", False, rng.choice([*parts.cores]), self._period()))
        if self.has("isr", "isr overhead"):
            self.plans.append(Plan(f"T{len(self.plans)}", True, rng.choice([*parts.cores]), self._period()))
        self._state()
        for plan in self.plans:
            self._body(plan)
        self._activations()
        self._chain()
        self._delivered()
        features = frozenset(self.used or {"plain"})
        hides = rng.randrange(10**6) if rng.random() < SHARE_HIDING else None
        return RandomModel(parts.text(), features, self._delays(), hides)

    # Data.

    def _state(self) -> None:
        data = self.parts.data
        if self.has("modes", "stimulus condition", "mode switch"):
            data.append('<modes xsi:type="am:NumericMode" xmi:id="num?type=NumericMode" name="num"/>')
            data += [
                f'<modeLabels xmi:id="{name}?type=ModeLabel" name="{name}" mode="num?type=NumericMode" '
                f'initialValue="{self.rng.randrange(3)}"/>'
                for name in "MN"
            ]
        if self.has("channel"):
            most = self.rng.randint(2, 4)
            data.append(
                f'<channels xmi:id="Q?type=Channel" name="Q" defaultElements="{self.rng.randint(0, 2)}" maxElements="{most}"/>'
            )

    def _condition(self) -> str:
        rng = self.rng
        if self.has("channel") and (not self.features & {"modes", "stimulus condition", "mode switch"} or rng.random() < 0.5):
            level, relation = rng.choice(((0, "EQUAL"), (0, "GREATER_THAN"), (0, "NOT_EQUAL"), (1, "GREATER_THAN")))
            return f'<entries xsi:type="am:ChannelFillCondition" channel="Q?type=Channel" relation="{relation}" fillLevel="{level}"/>'
        compared = [
            f'<entries xsi:type="am:ModeValueCondition" label="{rng.choice("MN")}?type=ModeLabel" value="{rng.randrange(3)}" '
            f'relation="{rng.choice(RELATIONS)}"/>'
            for _ in range(rng.choice((1, 1, 2)))
        ]
        return (
            compared[0] if len(compared) == 1 else f'<entries xsi:type="am:ConditionConjunction">{"".join(compared)}</entries>'
        )

    # Bodies.

    def _body(self, plan: Plan) -> None:
        rng = self.rng
        for _ in range(rng.choice((1, 2, 2, 3))):
            plan.items.append(self._item(plan))
        if not any("Ticks" in text for text in plan.items):
            plan.items.append(self._ticks())

    def _ticks(self) -> str:
        least = self.rng.randint(1, 4)
        is_constant = "constant times" in self.features or self.rng.random() < 0.6
        return ticks(least, least if is_constant else least + self.rng.randint(1, 3))

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
        if self.has("modes", "mode switch", chance=0.3):
            return item(
                "ModeLabelAccess", f'data="{rng.choice("MN")}?type=ModeLabel" access="set" value="{rng.randrange(3)}" step="1"'
            )
        if self.has("modes", "channel", "mode switch", chance=0.3):
            branch = f'<entries name="e0">{self._ticks()}<condition>{self._condition()}</condition></entries>'
            default = f"<defaultEntry>{self._ticks()}</defaultEntry>" if rng.random() < 0.6 else ""
            return item("Switch", content=branch + default)
        if self.has("channel", chance=0.4):
            if rng.random() < 0.5:
                return item("ChannelSend", f'data="Q?type=Channel" elements="{rng.randint(1, 2)}"')
            return item(
                "ChannelReceive",
                'data="Q?type=Channel" elements="1" receiveOperation="FIFO_Take" dataMustBeNew="false" elementIndex="0" lowerBound="0"',
            )
        if self.has("group", chance=0.4):
            return writing.group(self._ticks() + self._ticks(), is_interruptible=rng.choice((True, False)))
        if rng.random() < 0.3:
            return self._call()
        return self._ticks()

    def _chance(self) -> str:
        rng = self.rng
        return writing.chance((rng.randint(1, 3), self._ticks() if rng.random() < 0.7 else self._call()) for _ in range(2))

    def _call(self) -> str:
        """A call of a runnable, which can call another one."""
        if not self.has("nested calls", "switch in a runnable", chance=0.6):
            has_condition = self.has("modes", chance=0.3)
            condition = f"<executionCondition>{self._condition()}</executionCondition>" if has_condition else ""
            return self._runnable(self._ticks(), condition)
        inner = self._runnable(self._ticks())
        content = self._ticks() + inner if self.rng.random() < 0.6 else inner + self._ticks()
        if self.has("switch in a runnable", chance=0.7):
            content += self._switch()
        return self._runnable(content)

    def _switch(self) -> str:
        if not self.features & {"modes", "stimulus condition", "mode switch"}:
            return self._chance()
        branch = f'<entries name="e0">{self._ticks()}<condition>{self._condition()}</condition></entries>'
        return item("Switch", content=branch + f"<defaultEntry>{self._ticks()}</defaultEntry>")

    def _runnable(self, content: str, condition: str = "", *, is_counted: bool = True) -> str:
        """A call of a new runnable."""
        name = f"r{self.runnables}"
        self.runnables += 1
        self.parts.runnables.append(writing.runnable(name, content, condition))
        counter = writing.counter(2, 0) if is_counted and self.has("counter", chance=0.4) else ""
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

    # Activations.

    def _activations(self) -> None:
        """Later processes may be fired by earlier ones; the first one never is."""
        rng = self.rng
        for number, plan in enumerate(self.plans):
            earlier = [other for other in self.plans[:number] if not other.is_isr]
            if earlier and self.has("exclusive triggers", chance=0.7) and number + 1 < len(self.plans) and not plan.is_isr:
                other = self.plans[number + 1]
                if not other.is_isr and not plan.stimuli and not other.stimuli:
                    self._fire_either(rng.choice(earlier), plan, other)
                    continue
            if plan.stimuli:
                continue
            if earlier and not plan.is_isr and self.has("trigger", "custom event", "activation overhead", chance=0.6):
                self._fire(rng.choice(earlier), plan)
                continue
            self._timed(plan)
            if self.has("two stimuli", chance=0.3):
                self._timed(plan)

    def _fire(self, source: Plan, target: Plan) -> None:
        target.is_fired, name = True, f"s{target.name}"
        counter = writing.counter(2, 1) if self.has("counter", chance=0.5) else ""
        at = self.rng.randint(0, len(source.items))
        if "custom event" in self.features and (not self.features & {"trigger"} or self.rng.random() < 0.5):
            event = f"E{target.name}"
            self.parts.events.append(f'<events xsi:type="am:CustomEvent" xmi:id="{event}?type=CustomEvent" name="{event}"/>')
            self.parts.stimuli.append(
                writing.stimulus("Event", name, f'triggeringEvents="{event}?type=CustomEvent"', self._guard() + counter)
            )
            target.stimuli.append(f"{name}?type=EventStimulus")
            source.items.insert(at, item("CustomEventTrigger", f'event="{event}?type=CustomEvent"'))
            return
        self.parts.stimuli.append(writing.stimulus("InterProcess", name, "", self._guard() + counter))
        target.stimuli.append(f"{name}?type=InterProcessStimulus")
        source.items.insert(at, self._trigger(name))

    @staticmethod
    def _trigger(name: str) -> str:
        return item("InterProcessTrigger", f'stimulus="{name}?type=InterProcessStimulus"')

    def _fire_either(self, source: Plan, *targets: Plan) -> None:
        branches = []
        for target in targets:
            name = f"s{target.name}"
            target.is_fired = True
            target.stimuli.append(f"{name}?type=InterProcessStimulus")
            self.parts.stimuli.append(writing.stimulus("InterProcess", name))
            branches.append((self.rng.randint(1, 3), self._trigger(name)))
        source.items.insert(self.rng.randint(0, len(source.items)), writing.chance(branches))

    def _guard(self) -> str:
        """What a stimulus sets, and its condition."""
        if not self.has("stimulus condition", chance=0.6):
            return ""
        sets = ""
        if self.rng.random() < 0.5:
            label, value = self.rng.choice("MN"), self.rng.randrange(3)
            sets = f'<setModeValueList><entries label="{label}?type=ModeLabel" value="{value}"/></setModeValueList>'
        return f"{sets}<executionCondition>{self._condition()}</executionCondition>" if self.rng.random() < 0.8 else sets

    def _timed(self, plan: Plan) -> None:
        rng, period = self.rng, plan.period
        name = f"s{plan.name}{len(plan.stimuli) or ''}"
        offset = time("offset", rng.randrange(period) if self.has("start-up", chance=0.7) else 0)
        kind, attributes, content = "Periodic", "", time("recurrence", period) + offset
        if self.has("single", chance=0.5):
            kind, content = "Single", time("occurrence", rng.randrange(100))
        elif self.has("burst", chance=0.6):
            kind, attributes = "PeriodicBurst", f'occurrenceCount="{rng.randint(2, 3)}"'
            distance = rng.choice((2, 5, 9))
            content += time("burstLength", 2 * distance + 1) + time("occurrenceMinDistance", distance)
        elif self.has("synthetic times", chance=0.6):
            kind = "PeriodicSynthetic"
            times = sorted(rng.sample(range(1, 3 * period), 3))
            content = time("recurrence", 3 * period) + offset + "".join(time("occurrenceTimes", t) for t in times)
        elif self.has("arrival curve", chance=0.6):
            kind = "ArrivalCurve"
            borders = ((2, rng.choice((8, 16))), (3, period), (5, 3 * period))
            content = "".join(f'<entries numberOfOccurrences="{n}">{time("lowerTimeBorder", t)}</entries>' for n, t in borders)
        elif self.has("variable rate", chance=0.6):
            kind = "VariableRate"
            least, most = rng.choice((0.0, 0.25, 0.5)), rng.choice((0.6, 1.0, 1.5))
            content = time("step", period) + (
                f'<occurrencesPerStep xsi:type="am:ContinuousValueUniformDistribution" lowerBound="{least}" upperBound="{most}"/>'
            )
        elif self.has("sporadic", chance=0.6):
            kind = "RelativePeriodic"
            content = offset + writing.times("nextOccurrence", period, period + rng.randint(1, 30))
        elif self.has("jitter", chance=0.7) and self.policy != POLICIES["EDF"]:
            late = rng.choice((3, period // 2, period - 1))
            jitter = f'<jitter xsi:type="am:TimeBoundaries">{time("lowerBound", 0)}{time("upperBound", late)}</jitter>'
            content += jitter + (time("minDistance", rng.randint(1, period - late)) if rng.random() < 0.5 else "")
        plan.stimuli.append(f"{name}?type={kind}Stimulus")
        self.parts.stimuli.append(writing.stimulus(kind, name, attributes, self._guard() + content))

    # Chains.

    def _chain(self) -> None:
        rng = self.rng
        if rng.random() < 0.1:
            return
        most = 4 if self.has("long chain") else 3
        path = rng.sample(self.plans, min(len(self.plans), rng.randint(2, most)))
        if rng.random() < 0.5:
            # Along triggers, which go from earlier processes to later ones.
            path.sort(key=lambda plan: plan.name)
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
            if is_explicit or not _is_linked(source, target) or self.has("several links", chance=0.7) or rng.random() < 0.3:
                self._share(source, target, f"{label}{n}", "explicit" if is_explicit else "")
                if self.has("several links", chance=0.6):
                    self._share_mode(source, target, f"K{label}{n}")
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

    def _share_mode(self, source: Plan, target: Plan, label: str) -> None:
        if not any('"num?' in text for text in self.parts.data):
            self.parts.data.append('<modes xsi:type="am:NumericMode" xmi:id="num?type=NumericMode" name="num"/>')
        self.parts.data.append(
            f'<modeLabels xmi:id="{label}?type=ModeLabel" name="{label}" mode="num?type=NumericMode" initialValue="0"/>'
        )
        for plan, access in ((source, 'access="set" value="1"'), (target, 'access="read"')):
            plan.items.insert(
                self.rng.randint(0, len(plan.items)), item("ModeLabelAccess", f'data="{label}?type=ModeLabel" {access}')
            )

    def _delays(self) -> tuple[tuple[tuple[str, str], tuple[str, str]], ...]:
        found = []
        for _ in range(2):
            one, other = self.rng.sample(self.plans, 2)
            found.append(
                ((one.name, self.rng.choice(("start", "terminate"))), (other.name, self.rng.choice(("start", "terminate"))))
            )
        return tuple(dict.fromkeys(found))

    # The rest.

    def _delivered(self) -> None:
        rng, parts = self.rng, self.parts
        self._schedulers()
        priorities = rng.sample(range(1, 50), len(self.plans))
        for plan, priority in zip(self.plans, priorities, strict=True):
            body, stimuli = "".join(plan.items), " ".join(plan.stimuli)
            if plan.is_isr:
                parts.isrs.append(writing.isr(plan.name, stimuli, body))
                parts.allocations.append(writing.isr_allocation(plan.name, plan.core, priority))
                continue
            if self.has("migration", chance=0.5) and self.policy == "FixedPriorityPreemptive" and not self.has("server"):
                other = "c1" if plan.core == "c0" else "c0"
                body += item("EnforcedMigration", f'resourceOwner="S{other}?type=TaskScheduler"') + self._ticks()
            parts.tasks.append(writing.task(plan.name, stimuli, body, self._mode(), self._limit()))
            parts.allocations.append(self._allocation(plan, priority))

    def _mode(self) -> str:
        if self.has("cooperative", chance=0.6):
            return "cooperative"
        return "non_preemptive" if self.has("non-preemptive", chance=0.5) else "preemptive"

    def _limit(self) -> int:
        return self.rng.choice((1, 1, 2)) if self.has("few activations", chance=0.6) else 99

    def _allocation(self, plan: Plan, priority: int) -> str:
        rng, scheduler = self.rng, f"S{plan.core}"
        if "V0" in "".join(self.parts.schedulers) and plan.core == "c0" and rng.random() < 0.5:
            scheduler = "V0"
        given = {
            "FixedPriorityPreemptive": {"priority": priority},
            "PriorityBasedRoundRobin": {"priority": rng.randint(1, 2), "timeSliceLength": 3},
        }.get(self.policy, {"deadline": rng.randint(10, plan.period)})
        if scheduler == "V0":
            given = {"priority": priority}
        return writing.task_allocation(plan.name, scheduler, given)

    def _schedulers(self) -> None:
        rng, parts = self.rng, self.parts
        decides = (
            '<computationItems xsi:type="am:Ticks"><default xsi:type="am:DiscreteValueConstant" value="1"/></computationItems>'
        )
        with_cost = self.has("scheduler overhead")
        for core in parts.cores:
            parts.schedulers.append(writing.scheduler(f"S{core}", self.policy, decides if with_cost else ""))
            parts.allocations.append(writing.scheduler_allocation(f"S{core}", core))
        if "server" in self.features and self.policy == "FixedPriorityPreemptive":
            self.used.add("server")
            given = {"priority": rng.randint(1, 100), "capacity": rng.randint(4, 9), "period": rng.choice((12, 15, 20))}
            content = "".join(writing.parameter(name, value) for name, value in given.items())
            parent = f'<parentAssociation parent="Sc0?type=TaskScheduler">{content}</parentAssociation>'
            parts.schedulers.append(writing.scheduler("V0", rng.choice(("DeferrableServer", "PollingPeriodicServer")), parent))
        constant = '<default xsi:type="am:DiscreteValueConstant" value="{}"/>'
        overheads = ""
        if "activation overhead" in self.features and self.used & {"activation overhead"} and "core frequency" not in self.used:
            overheads += f"<apiOverhead><apiActivateTask>{constant.format(2)}</apiActivateTask></apiOverhead>"
        if "isr overhead" in self.used and "core frequency" not in self.used:
            before, after = (
                f"<{when}ExecutionOverhead>{constant.format(1)}</{when}ExecutionOverhead>" for when in ("pre", "post")
            )
            overheads += f"<isrCategory2Overhead>{before}{after}</isrCategory2Overhead>"
        if overheads:
            parts.overheads.append(f'<osOverheads xmi:id="ov?type=OsOverhead" name="ov">{overheads}</osOverheads>')


def _is_linked(source: Plan, target: Plan) -> bool:
    """Whether a process triggers another one."""
    return any(f'"s{target.name}?' in text or f'"E{target.name}?' in text for text in source.items)
