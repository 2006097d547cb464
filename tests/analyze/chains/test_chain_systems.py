"""Chains of whole systems: links between events, read and write times, and reasons of unknown results."""

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import pytest
from effort import every
from hand_made_systems import READ, WRITE, access, chain, changed, locked, of_parts, read, ticks, write
from support import ROOT, SHARED, analysis_of
from test_methods import cases

from amalthea_uros import Settings, analyze_system, describe, extract, load
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.perf.activities import Call, Communication, RaiseEvent, Receive, Send, Trigger
from amalthea_uros.perf.distributions import Boundaries
from amalthea_uros.perf.events import (
    ChainReference,
    ChannelChange,
    ChannelEvent,
    CustomEvent,
    EventChain,
    Events,
    EventSet,
    LabelChange,
    LabelEvent,
    Parallel,
    ProcessChange,
    ProcessEvent,
    RunnableChange,
    RunnableEvent,
    Segment,
    SemaphoreChange,
    SemaphoreEvent,
    Sequence,
    StimulusEvent,
)
from amalthea_uros.perf.hardware import Clock, Core, Hardware, Structure, StructureKind
from amalthea_uros.perf.mapping import TaskAllocation
from amalthea_uros.perf.software import Preemption, Runnable, Task
from amalthea_uros.perf.stimuli import Counter, EventTriggered, InterProcess, Periodic, RelativePeriodic
from amalthea_uros.units import MICROSECOND as US
from amalthea_uros.units import NANOSECOND as NS

START, END, ACTIVATION = ProcessChange.START, ProcessChange.TERMINATE, ProcessChange.ACTIVATE


def at(process, change):
    return ProcessEvent(name=f"{process} {change}", process=process, change=change)


#: Jobs can be pending while further ones are activated.
NO_LOSSES = 99


def system(tasks, events, chains=None, stimuli=(), runnables=(), cores=("core",), controllers=False, unit=US):
    """Tasks of (name, period or None, activities[, core[, offset]]), the first one first; cores of 1 tick in each unit."""
    rows = [(*task, *("core", 0)[len(task) - 3 :]) if len(task) < 5 else task for task in tasks]
    structures = tuple(
        Structure(name=f"at {core}", kind=StructureKind.ECU if controllers else None, cores=(Core(name=core, clock="clock"),))
        for core in cores
    )
    whole = chain("chain", *(event.name for event in events))
    return of_parts(
        [Task(name=name, stimuli=(name,), activities=tuple(body), activation_limit=NO_LOSSES) for name, _, body, _, _ in rows],
        [TaskAllocation(task=row[0], scheduler=row[3], priority=-number) for number, row in enumerate(rows)],
        [*(Periodic(name=name, period=period * unit, offset=at * unit) for name, period, _, _, at in rows if period), *stimuli],
        cores=cores,
        runnables=runnables,
        hardware=Hardware(clocks=(Clock(name="clock", frequency=Fraction(10**12, unit)),), structures=structures),
        events=Events(events=tuple(events), chains=chains or (whole,)),
    )


def evaluate(built, unit=US, **settings):
    return results(analyze_system(built, Settings(**settings)), unit)


def results(analysis, unit=US):
    """The first chain, its values by their quantities, their claims, and the rules of findings about chains."""
    (chain, *_) = analysis.chains
    values = {value.quantity.value: value.value / unit for value in chain.values}
    claims = {str(value.claim) for value in chain.values}
    rules = [finding.rule for finding in analysis.findings if finding.rule.startswith("CHN")]
    return chain, values, claims, rules


def ends(values):
    return values["min_first_to_first"], values["max_reduced_reaction_time"]


VECTORS = cases(lambda case: int(case["id"].split("-")[1]) % 10 == 5 or case["kind"] == "phase")


@pytest.mark.parametrize("case", every(4, VECTORS))
def test_vectors_as_models(case):
    labels = {name: ([], []) for name in (task["name"] for task in case["tasks"])}
    for number, (writer, reader) in enumerate(pairwise(case["chain"])):
        labels[writer][1].append(write(f"L{number}"))
        labels[reader][0].append(read(f"L{number}"))
    ordered = sorted(case["tasks"], key=lambda task: task["priority"])
    tasks = [
        (
            task["name"],
            task["period"],
            [*labels[task["name"]][0], ticks(task["wcet"], task["bcet"]), *labels[task["name"]][1]],
            "core",
            task["offset"],
        )
        for task in ordered
    ]
    first, last = case["chain"][0], case["chain"][-1]
    events = [at(first, START), *(at(name, END) for name in case["chain"][1:])]
    if first == last:
        events = [at(first, START), at(first, END)]
    _, values, claims, rules = evaluate(system(tasks, events, unit=NS), NS)
    assert not rules
    if case["kind"] == "bcet":
        assert claims == {"bound"}
        # Another method may have a tighter bound than the job chains.
        assert values["max_reaction_time"] <= case["safe_upper_bound"]["guenzel23_mrt"]
        assert values["max_reaction_time"] >= case["achieved"]["wcet"]["mrt"]
    else:
        exact = case["exact"]
        assert claims == {"exact"}
        assert values["max_reaction_time"] == exact["mrt"]
        assert values["max_reduced_reaction_time"] == exact["mrrt"]
        assert values["max_data_age"] == exact["mda"]
        assert values["max_reduced_data_age"] == exact["mrda"]
        first_to_first = case["distribution_one_hyperperiod"]["first_to_first"]
        assert values["min_first_to_first"] == first_to_first["min"]
        assert values["mean_first_to_first"] == pytest.approx(first_to_first["sum"] / first_to_first["count"], abs=0.001)


class TestTheThesis:
    """From the start of the executor job that took the message to the end of the first control function that uses it."""

    SAMPLE = ROOT / "samples" / "bodas-test-advanced.yaml"

    def test_over_all_phases_of_the_message(self):
        _, values, claims, _ = results(analysis_of(self.SAMPLE))
        assert claims == {"exact"}
        # By hand: taken in the tick of Message_Factor 1000 + 16; taken in the tick after it, up to the long job 20 ticks later.
        assert ends(values) == (1016, 20029)
        # Ticks 0 to 19 after Message_Factor: 20 in steps of one, each of which ends at 16 or, where it meets a message, at 29.
        assert values["mean_first_to_first"] == pytest.approx(sum(range(1, 21)) * 1000 / 20 + 16 + 13 / 20)
        assert (values["min_last_to_last"], values["max_reduced_data_age"]) == (1016, 39016)
        # What was measured is not further than five per cent from that.
        measured = {"min_first_to_first": 970, "mean_first_to_first": 10320, "max_reduced_reaction_time": 19978}
        for quantity, value in measured.items():
            assert values[quantity] == pytest.approx(value, rel=0.05)

    @pytest.mark.parametrize(("start", "end", "expected"), [(END, END, (991, 20004)), (END, ACTIVATION, (975, 19975))])
    def test_other_end_points(self, start, end, expected):
        events = (at("Executor_Task", start), at("Message_Factor", END), at("Control_Function", end))
        built = replace(
            describe(self.SAMPLE).system, events=Events(events=events, chains=(chain("c", *(event.name for event in events)),))
        )
        _, values, _, _ = evaluate(built)
        assert ends(values) == expected

    def test_logical_execution_times(self):
        _, values, claims, _ = evaluate(describe(self.SAMPLE).system, communication=Communication.LET)
        assert claims == {"exact"}
        assert ends(values) == (22000, 41000)


def producer_and_consumer(*chain, communication=None, **more):
    """A producer of 2 + 3 that writes after its 2, every 10; a consumer of 4 + 1 every 20 that reads after its 4."""
    runnables = [
        Runnable(name="make", activities=(ticks(2), access("L", WRITE, communication))),
        Runnable(name="rest", activities=(ticks(3),)),
        Runnable(name="prepare", activities=(ticks(4),)),
        Runnable(name="use", activities=(access("L", READ, communication), ticks(1))),
    ]
    tasks = [
        ("producer", 10, [Call(runnable="make"), Call(runnable="rest")]),
        ("consumer", 20, [Call(runnable="prepare"), Call(runnable="use")]),
    ]
    return system(tasks, chain, runnables=runnables, **more)


class TestCommunication:
    ENDS = (at("producer", START), at("consumer", END))

    def test_implicit(self):
        # The producer at 0 to 5, the consumer at 5 to 10: it reads what has just been written.
        _, values, claims, _ = evaluate(producer_and_consumer(*self.ENDS))
        assert claims == {"exact"}
        assert ends(values) == (10, 20)

    def test_explicit(self):
        # Written at 2, read at 9; the job of 10 writes at 12 what is read at 29.
        events = (
            RunnableEvent(name="made", runnable="make", change=RunnableChange.TERMINATE),
            RunnableEvent(name="used", runnable="use", change=RunnableChange.START),
        )
        _, values, claims, _ = evaluate(producer_and_consumer(*events), communication=Communication.EXPLICIT)
        assert claims == {"exact"}
        assert ends(values) == (9 - 2, 29 - 12)

    def test_logical(self):
        _, values, _, _ = evaluate(producer_and_consumer(*self.ENDS), communication=Communication.LET)
        # The job of 0 writes at 10, read at 20, out at 40; the one of 10 writes at 20.
        assert ends(values) == (30, 40)

    def test_as_the_model_says(self):
        built = producer_and_consumer(*self.ENDS, communication=Communication.LET)
        # Written at 10 and 20, read at 20 and out at its end after the producer, at 30.
        assert ends(evaluate(built)[1]) == (20, 30)

    def test_logical_execution_times_need_jobs_that_end_within_their_periods(self):
        tasks = [("high", 20, [ticks(10), write("L")]), ("low", 10, [read("L"), ticks(4)])]
        chain, _, _, rules = evaluate(system(tasks, [at("high", START), at("low", END)]), communication=Communication.LET)
        assert rules == ["CHN003"]
        assert "does not always end within its period" in chain.reason


class TestWhatCarries:
    def test_within_one_job(self):
        events = (
            RunnableEvent(name="prepared", runnable="prepare", change=RunnableChange.START),
            RunnableEvent(name="used", runnable="use", change=RunnableChange.TERMINATE),
        )
        chain, values, _, _ = evaluate(producer_and_consumer(*events))
        assert chain.routes == ("prepared -[the same job]-> used",)
        assert values["max_reduced_reaction_time"] == 5

    @pytest.mark.parametrize("change", [RunnableChange.TERMINATE, RunnableChange.START])
    def test_the_accesses_of_a_runnable_precede_its_end(self, change):
        # The write comes 2 us after the start of the job, which takes 6 us; nothing takes its effect to the start of the next job.
        runnables = [
            Runnable(name="outer", activities=(ticks(1), Call(runnable="inner"), ticks(1))),
            Runnable(name="inner", activities=(ticks(1), write("L"), ticks(3))),
        ]
        events = (
            LabelEvent(name="written", label="L", change=LabelChange.WRITE),
            RunnableEvent(name="reached", runnable="outer", change=change),
        )
        built = system([("T", 10, [Call(runnable="outer")])], events, runnables=runnables)
        chain, values, _, rules = evaluate(built, communication=Communication.EXPLICIT)
        if change is RunnableChange.START:
            assert (rules, values) == (["CHN002"], {})
            return
        assert chain.routes == ("written -[the same job]-> reached",)
        assert values["min_first_to_first"] == 4
        assert values["max_reduced_reaction_time"] >= 4
        assert not rules

    def test_the_end_of_a_runnable_follows_that_of_one_that_it_calls(self):
        runnables = [
            Runnable(name="outer", activities=(Call(runnable="inner"),)),
            Runnable(name="inner", activities=(ticks(1),)),
        ]
        ends = [RunnableEvent(name=name, runnable=name, change=RunnableChange.TERMINATE) for name in ("inner", "outer")]
        built = system([("T", 10, [Call(runnable="outer")])], ends, runnables=runnables)
        chain, *_ = evaluate(built)
        assert chain.routes == ("inner -[the same job]-> outer",)

    def test_an_earlier_runnable_needs_the_next_job(self):
        # As in the first chain of the challenge of 2017.
        runnables = [
            Runnable(name="first", activities=(read("L"), ticks(1))),
            Runnable(name="second", activities=(ticks(2), write("L"))),
        ]
        events = (
            RunnableEvent(name="start", runnable="second", change=RunnableChange.START),
            RunnableEvent(name="end", runnable="first", change=RunnableChange.TERMINATE),
        )
        built = system([("T", 10, [Call(runnable="first"), Call(runnable="second")])], events, runnables=runnables)
        chain, values, _, rules = evaluate(built)
        assert chain.routes == ("start -[data L]-> end",)
        assert not rules
        assert values["max_reduced_reaction_time"] == 10
        # Two periods from the read, and one of sampling before it.
        _, values, _, _ = evaluate(built, communication=Communication.LET)
        assert (values["max_reduced_reaction_time"], values["max_reaction_time"]) == (20, 30)

    def test_a_label_event_determines_reader_and_writer(self):
        events = (
            at("producer", START),
            LabelEvent(name="written", label="L", change=LabelChange.WRITE),
            LabelEvent(name="read", label="L", change=LabelChange.READ),
            at("consumer", END),
        )
        chain, values, _, rules = evaluate(producer_and_consumer(*events))
        assert chain.routes == (
            "producer start -[the same job]-> written -[data L]-> read -[the same job]-> consumer terminate",
        )
        assert not rules
        assert values["max_reduced_reaction_time"] == 20

    def test_a_channel(self):
        tasks = [("sender", 10, [ticks(1), Send(channel="C")]), ("receiver", 10, [Receive(channel="C"), ticks(1)])]
        events = (ChannelEvent(name="sent", channel="C", change=ChannelChange.SEND), at("receiver", END))
        chain, values, _, _ = evaluate(system(tasks, events))
        assert chain.routes == ("sent -[data C]-> receiver terminate",)
        assert values["max_reduced_reaction_time"] == 1

    def test_a_trigger(self):
        tasks = [
            ("source", 10, [ticks(2), Trigger(stimulus="go")]),
            ("sink", None, [ticks(3)]),
            ("low", 20, [read("L"), ticks(1)]),
        ]
        built = system(tasks, [at("source", START), at("sink", END)], stimuli=[InterProcess(name="go")])
        chain, values, claims, _ = evaluate(changed(built, "sink", stimuli=("go",)))
        assert chain.routes == ("source start -[a trigger go]-> sink terminate",)
        assert claims == {"bound"}
        # 2, and 3 after another job of the source that may come in between.
        assert values["max_reduced_reaction_time"] == 2 + 3 + 2

    @pytest.mark.parametrize(
        "event",
        [
            CustomEvent(name="event"),
            LabelEvent(name="event", label="L", change=LabelChange.WRITE),
            RunnableEvent(name="event", runnable="prepare", change=RunnableChange.TERMINATE),
            RunnableEvent(name="event", runnable="prepare", change=RunnableChange.START),
        ],
        ids=["raised", "written", "ended", "started"],
    )
    def test_an_event_that_activates_a_task(self, event):
        prepare = Runnable(name="prepare", activities=(ticks(2), RaiseEvent(event="event"), write("L")))
        tasks = [("source", 10, [Call(runnable="prepare"), ticks(1)]), ("sink", None, [ticks(3)])]
        stimulus = EventTriggered(name="sink", events=("event",))
        events = [at("source", START), at("sink", END), event]
        chain = EventChain(name="chain", stimulus=events[0].name, response=events[1].name)
        built = system(tasks, events, chains=(chain,), stimuli=[stimulus], runnables=[prepare])
        found, values, _, rules = evaluate(built)
        assert found.routes == ("source start -[a trigger sink]-> sink terminate",)
        assert not rules
        # The source goes on, before the sink can run.
        assert values["max_reduced_reaction_time"] >= 3 + 3

    @pytest.mark.parametrize(("change", "latency"), [(RunnableChange.START, 1 + 3), (RunnableChange.TERMINATE, 1 + 2 + 3)])
    def test_an_event_that_activates_a_task_on_another_core(self, change, latency):
        runnables = [Runnable(name="prepare", activities=(ticks(2),))]
        tasks = [("source", 10, [ticks(1), Call(runnable="prepare"), ticks(5)]), ("sink", None, [ticks(3)], "other")]
        events = [at("source", START), at("sink", END), RunnableEvent(name="event", runnable="prepare", change=change)]
        chain = EventChain(name="chain", stimulus=events[0].name, response=events[1].name)
        stimuli = [EventTriggered(name="sink", events=("event",))]
        built = system(tasks, events, chains=(chain,), stimuli=stimuli, runnables=runnables, cores=("core", "other"))
        _, values, _, _ = evaluate(built)
        # The sink starts at once, and nothing delays it or the source.
        assert values["min_first_to_first"] <= latency <= values["max_reduced_reaction_time"]

    def test_a_frame_on_a_bus(self):
        # A bus is a core whose frames are non-preemptive tasks; the longer frame of lower priority follows this one, and has been sent
        # before this one comes again.
        tasks = [
            ("sensor", 10, [ticks(1), write("raw")], "one"),
            ("frame", 10, [read("raw"), ticks(2), write("received")], "bus"),
            ("other frame", 20, [ticks(5)], "bus"),
            ("actuator", 10, [read("received"), ticks(1)], "two"),
        ]
        built = system(tasks, [at("sensor", START), at("frame", END), at("actuator", END)], cores=("one", "bus", "two"))
        for frame in ("frame", "other frame"):
            built = changed(built, frame, preemption=Preemption.NON_PREEMPTIVE)
        chain, values, claims, _ = evaluate(built)
        assert chain.routes == ("sensor start -[data raw]-> frame terminate -[data received]-> actuator terminate",)
        assert claims == {"exact"}
        # Written at 1; read by the frame of 10, which is there at 12; used by the actuator of 20, out at 21.
        assert values["max_reduced_reaction_time"] == 21

    def test_a_critical_section(self):
        events = (
            SemaphoreEvent(name="locked", semaphore="S", change=SemaphoreChange.LOCK),
            SemaphoreEvent(name="unlocked", semaphore="S", change=SemaphoreChange.UNLOCK),
        )
        chain, values, _, _ = evaluate(system([("A", 10, [ticks(1), *locked("S", 2)])], events))
        assert chain.routes == ("locked -[the same job]-> unlocked",)
        assert 2 <= values["max_reduced_reaction_time"] <= 3

    @pytest.mark.parametrize("accesses", [([], []), ([read("L")], [write("L")])], ids=["no data", "data that go the other way"])
    def test_no_link(self, accesses):
        tasks = [(name, 10, [ticks(1), *body]) for name, body in zip("AB", accesses, strict=True)]
        chain, values, _, rules = evaluate(system(tasks, [at("A", START), at("B", END)]))
        assert (rules, values) == (["CHN002"], {})
        assert chain.reason == "no data flow or trigger connects 'A start' to 'B terminate'"

    def test_an_access_that_no_activity_makes(self):
        tasks = [("A", 10, [ticks(1)]), ("B", 10, [read("L"), ticks(1)])]
        written = LabelEvent(name="written", label="L", change=LabelChange.WRITE, process="A")
        chain, values, _, rules = evaluate(system(tasks, [written, at("B", END)]))
        assert (rules, values) == (["CHN004"], {})
        assert chain.reason == "no activity in the model raises the event 'written'"

    def test_a_stimulus_is_the_activation_of_what_it_activates(self):
        events = (StimulusEvent(name="tick", stimulus="producer"), at("consumer", END))
        _, values, _, _ = evaluate(producer_and_consumer(*events))
        assert values["max_reduced_reaction_time"] == 20

    def test_an_event_that_software_raises(self):
        tasks = [("A", 10, [ticks(2), RaiseEvent(event="done"), ticks(3), write("L")]), ("B", 10, [read("L"), ticks(1)])]
        _, values, _, _ = evaluate(system(tasks, [CustomEvent(name="done"), at("B", END)]))
        assert values["max_reduced_reaction_time"] == 3 + 1

    def test_counters_let_only_some_jobs_take_part(self):
        runnable = Runnable(name="take", activities=(write("L"),))
        counter = Counter(prescaler=3, offset=2)
        tasks = [("A", 10, [ticks(1), Call(runnable="take", counter=counter)]), ("B", 10, [read("L"), ticks(1)])]
        _, values, claims, _ = evaluate(system(tasks, [at("A", START), at("B", END)], runnables=[runnable]))
        assert claims == {"exact"}
        assert (values["max_reduced_reaction_time"], values["max_reaction_time"]) == (2, 32)
        assert values["max_reduced_data_age"] == 22

    def test_several_cores(self):
        tasks = [("A", 10, [ticks(4), write("L")], "one"), ("B", 10, [read("L"), ticks(1)], "two")]
        events = [at("A", START), at("B", END)]
        _, values, claims, _ = evaluate(system(tasks, events, cores=("one", "two")))
        assert claims == {"exact"}
        # B reads at 0 and 10, A writes at 4.
        assert (values["max_reduced_reaction_time"], values["max_reaction_time"]) == (11, 21)
        _, values, claims, _ = evaluate(system(tasks, events, cores=("one", "two"), controllers=True))
        assert claims == {"bound"}
        # Clocks that are not synchronized: a period and a response time at each task.
        assert values["max_reaction_time"] == 10 + 4 + 10 + 1


MADE, WRITTEN, OUT = "producer start", "producer terminate", "consumer terminate"
WHOLE = f"{MADE} -[the same job]-> {WRITTEN} -[data L]-> {OUT}"
DIRECT = f"{MADE} -[data L]-> {OUT}"


def form(items=None, name="c", stimulus=MADE, response=OUT):
    return EventChain(name=name, stimulus=stimulus, response=response, items=items)


def segments(*pairs):
    return Sequence(tuple(Segment(stimulus=first, response=then) for first, then in pairs))


def references(*names):
    return Sequence(tuple(ChainReference(chain=name) for name in names))


COMPLETE = segments((MADE, WRITTEN), (WRITTEN, OUT))


def of_form(*chains, more=()):
    events = (at("producer", START), at("producer", END), at("consumer", END), *more)
    return evaluate(producer_and_consumer(*events, chains=chains))


@pytest.mark.parametrize(
    ("chains", "routes", "rules"),
    [
        pytest.param([form()], (DIRECT,), [], id="both ends alone"),
        pytest.param(
            [form(references("one", "two")), form(name="one", response=WRITTEN), form(name="two", stimulus=WRITTEN)],
            (WHOLE,),
            [],
            id="references",
        ),
        pytest.param(
            [form(segments((MADE, WRITTEN), ("read", OUT)))],
            (f"{MADE} -[the same job]-> {WRITTEN} -[data L]-> read -[the same job]-> {OUT}",),
            [],
            id="a gap between segments",
        ),
        pytest.param([form(segments((OUT, WRITTEN), (WRITTEN, OUT)))], (WHOLE,), ["CHN005"], id="a part that starts elsewhere"),
        pytest.param([form(segments((MADE, WRITTEN), ("nothing", OUT)))], (WHOLE,), ["CHN008"], id="an empty set"),
        pytest.param([form(COMPLETE)], (WHOLE,), [], id="both ends"),
        pytest.param([form(COMPLETE, response=None)], (WHOLE,), ["CHN007"], id="the end of its segments"),
        pytest.param(
            [form(COMPLETE, stimulus=None, response=None)], (WHOLE,), ["CHN007", "CHN007"], id="those of its segments"
        ),
    ],
)
def test_forms_of_one_path(chains, routes, rules):
    events = LabelEvent(name="read", label="L", change=LabelChange.READ), EventSet(name="nothing", events=())
    chain, values, _, found = of_form(*chains, more=events)
    assert (chain.routes, found) == (routes, rules)
    assert values["max_reduced_reaction_time"] == 20


@pytest.mark.parametrize(
    ("chains", "reason", "rules"),
    [
        pytest.param(
            [form(references("d")), form(references("c"), "d", None, None)],
            "it contains itself: c -> d -> c",
            ["CHN001", "CHN001"],
            id="a cycle",
        ),
        pytest.param([form(stimulus=None)], "", ["CHN001"], id="no stimulus"),
        pytest.param([form(response=None)], "", ["CHN001"], id="no response"),
        pytest.param([form(response="unknown")], "", ["CHN001"], id="an unknown response"),
    ],
)
def test_forms_without_a_path(chains, reason, rules):
    chain, values, _, found = of_form(*chains)
    assert (values, found) == ({}, rules)
    assert chain.reason
    assert chain.reason.startswith(reason)


@pytest.mark.parametrize(
    ("chain", "count", "value"),
    [
        # The branch within the producer takes 5, the one through the consumer up to 20.
        *(
            pytest.param(
                EventChain(
                    name="c",
                    stimulus=MADE,
                    items=Parallel(items=(Segment(response=WRITTEN), Segment(response=OUT)), completed=completed),
                ),
                2,
                value,
                id=f"{completed} of two branches",
            )
            for completed, value in ((1, 5), (2, 20))
        ),
        pytest.param(form(response="at the end"), 2, 20, id="a set is complete with its last event"),
        # Once both have occurred it cannot take longer than from the first one.
        pytest.param(form(stimulus="at the start"), 2, 20, id="a set at the start"),
        pytest.param(form(segments((MADE, "at the start"), ("at the start", OUT))), None, 20, id="a set in between"),
    ],
)
def test_forms_of_several_paths(chain, count, value):
    sets = EventSet(name="at the start", events=(MADE, WRITTEN)), EventSet(name="at the end", events=(WRITTEN, OUT))
    found, values, _, _ = of_form(chain, more=sets)
    assert len(found.routes) == (count or len(found.routes)) > 0
    assert values["max_reduced_reaction_time"] == value


class TestNoFiniteBound:
    def test_overload(self):
        tasks = [("A", 10, [ticks(8), write("L")]), ("B", 10, [read("L"), ticks(4)])]
        chain, values, _, rules = evaluate(system(tasks, [at("A", START), at("B", END)]))
        assert rules == ["CHN003"]
        assert "'B' is unbounded: overload: tasks at this priority or higher need 120.0 % of the core" in chain.reason
        assert not values

    def test_what_may_stay_away(self):
        tasks = [("A", None, [ticks(1), write("L")]), ("B", 10, [read("L"), ticks(4)])]
        sporadic = RelativePeriodic(name="A", distance=Boundaries(lower=20 * US, upper=50 * US))
        built = system(tasks, [at("A", START), at("B", END)], stimuli=[sporadic])
        _, values, claims, _ = evaluate(built)
        assert claims == {"bound"}
        # 50 from one to the next; it comes before B, which reads within 10 and takes 4 after another job of A.
        assert values["max_reaction_time"] == 50 + 10 + 4 + 1

    def test_hyperperiods_that_are_too_long(self):
        primes = [9973, 9967, 9949, 9941]
        tasks = [(f"T{p}", p, [read(f"L{i}"), ticks(1), write(f"L{i + 1}")]) for i, p in enumerate(primes)]
        events = [at(f"T{primes[0]}", START), *(at(f"T{p}", END) for p in primes[1:])]
        _, values, claims, _ = evaluate(system(tasks, events))
        assert claims == {"bound"}
        assert sum(primes) < values["max_reaction_time"] <= sum(primes) + 4 * 4


@pytest.mark.parametrize("path", sorted((SHARED / "vectors" / "am2inc").glob("*chain*.amxmi")), ids=lambda path: path.stem)
def test_chains_that_the_importer_drops_or_distorts(path):
    """Each is evaluated, or refused with the reason."""
    analysis = analyze_system(extract(load(path)).system)
    assert analysis.chains
    for each in analysis.chains:
        assert each.reason or each.value(LatencyQuantity.MAX_REACTION_TIME) is not None
        assert bool(each.reason) == any(
            f.rule in ("CHN001", "CHN002", "CHN003", "CHN004") and f.object == each.name for f in analysis.findings
        )


def test_a_chain_through_a_task_that_loses_activations_is_unknown():
    # A ends 12 after its release: with a limit of 1 every other activation is lost, and nobody knows which jobs write.
    built = system([("B", 20, [ticks(6), read("L")]), ("A", 10, [ticks(6), write("L")])], [at("A", START), at("B", END)])
    chain, values, _, _ = evaluate(changed(built, activation_limit=1))
    assert values == {}
    assert chain.reason == "'A', or a process that precedes it, can lose activations"
