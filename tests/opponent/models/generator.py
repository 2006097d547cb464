"""Random models, as text, with the constructs of ../shared/vectors/constructs2 and those that nobody can analyse."""

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

#: What is in some models; a model has one to four of them.
FEATURES = (
    "modes", "stimulus condition", "channel", "burst", "arrival curve", "variable rate", "synthetic times", "single",
    "trigger", "custom event", "server", "EDF", "deadline monotonic", "round robin", "scheduler overhead", "isr", "isr overhead",
    "activation overhead", "core frequency", "start-up", "exclusive triggers", "several links", "mode switch", "group",
    "non-preemptive", "jitter", "sporadic", "two stimuli", "migration", "counter",
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
    return Generator(Random(seed)).model()


def constrained(model: RandomModel, seed: int) -> RandomModel:
    """The same model with constraints."""
    try:
        return replace(model, constraints=constraints_of(model.text, Random(seed)))
    except UnplayableError:
        return model


class Generator:
    """Makes a model, part by part."""

    def __init__(self, rng: Random) -> None:
        self.rng, self.parts = rng, Parts()
        self.features = self._features()
        if rng.random() < 0.25:
            self.features = {f for f in self.features if f not in POLICIES}
        self.plans: list[Plan] = []
        self.used: set[str] = set()
        self.runnables = 0

    def _features(self) -> set[str]:
        return set(self.rng.sample(FEATURES, self.rng.choice((1, 2, 2, 3, 4))))

    def _period(self) -> int:
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
        return ticks(least, least if self.rng.random() < 0.6 else least + self.rng.randint(1, 3))

    def _item(self, plan: Plan) -> str:
        rng = self.rng
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

    def _call(self) -> str:
        name, condition = f"r{self.runnables}", ""
        self.runnables += 1
        if self.has("modes", chance=0.3):
            condition = f"<executionCondition>{self._condition()}</executionCondition>"
        self.parts.runnables.append(writing.runnable(name, self._ticks(), condition))
        counter = writing.counter(2, 0) if self.has("counter", chance=0.5) else ""
        return item("RunnableCall", f'runnable="{name}?type=Runnable"', counter)

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
        if rng.random() < 0.25:
            return
        path = rng.sample(self.plans, 2 if rng.random() < 0.6 else min(3, len(self.plans)))
        path.sort(key=lambda plan: plan.name) if rng.random() < 0.5 else None
        for n, (source, target) in enumerate(pairwise(path)):
            is_linked = any(f'"s{target.name}?' in text or f'"E{target.name}?' in text for text in source.items)
            if not is_linked or self.has("several links", chance=0.7) or rng.random() < 0.3:
                self._share(source, target, f"L{n}")
                if self.has("several links", chance=0.6):
                    self._share_mode(source, target, f"K{n}")
        ends = [rng.choice(("start", "start", "activate", "terminate")), rng.choice(("terminate", "terminate", "start"))]
        changes = [ends[0], *["terminate"] * (len(path) - 2), ends[1]]
        for n, (plan, change) in enumerate(zip(path, changes, strict=True)):
            self.parts.events.append(writing.process_event(f"v{n}", plan.name, plan.kind, change))
        events = [f"v{n}?type=ProcessEvent" for n in range(len(path))]
        self.parts.chains.append(writing.chain("chain", events[0], events[-1], starmap(writing.step, pairwise(events))))
        self.used.add("chain")

    def _share(self, source: Plan, target: Plan, label: str) -> None:
        self.parts.data.append(writing.label(label))
        how = self.rng.choice(("explicit", "explicit", "implicit"))
        for plan, access in ((source, "write"), (target, "read")):
            text = writing.label_access(label, access, how)
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
            parts.tasks.append(writing.task(plan.name, stimuli, body, self._mode(plan), self._limit()))
            parts.allocations.append(self._allocation(plan, priority))

    def _mode(self, _plan: Plan) -> str:
        return "non_preemptive" if self.has("non-preemptive", chance=0.5) else "preemptive"

    def _limit(self) -> int:
        return 99

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
