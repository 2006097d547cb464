"""Chains over wires and executors, hop by hop, on a board that is described in `message_board`.

On the wire to the board, /cmd can be blocked by one acknowledgement that is being sent (non-preemptive, Davis and others 2007), and
the other way round: CMD + ACK. On the other wire /odom is alone: ODOM.
"""

from dataclasses import replace

import pytest
from hand_made_systems import changed, reallocated, ticks
from message_board import ACK, CMD, MS, ODOM, US, Publication, Span, Wire, WireKind, board, message_chains, tick

from amalthea_uros.analyze.chains.message_chains import evaluate_executors_and_messages
from amalthea_uros.analyze.response_times.propagation import solve
from amalthea_uros.analyze.results.chains import LatencyQuantity
from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.executors.bounds.backlog import Arriving, max_backlog
from amalthea_uros.executors.bounds.cycle import Cycle
from amalthea_uros.executors.bounds.publications import sending_times
from amalthea_uros.executors.bounds.sequences import CycleSequence
from amalthea_uros.executors.bounds.transmissions import arrival_jitter
from amalthea_uros.executors.results import HopKind
from amalthea_uros.executors.semantics.loops import timing_context
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.perf.activities import Call, Trigger
from amalthea_uros.perf.constraints import Constraints, LatencyConstraint, LatencyKind
from amalthea_uros.perf.distributions import Constant, Uniform
from amalthea_uros.perf.executors import Handle, HandleKind
from amalthea_uros.perf.network import Purpose
from amalthea_uros.perf.os import Policy, Scheduler
from amalthea_uros.perf.software import Runnable
from amalthea_uros.perf.stimuli import InterProcess, Periodic, RelativePeriodic
from amalthea_uros.timing.event_models.models import SporadicEvents
from amalthea_uros.uros.described import describe_text

TO_PWM = ("to pwm", "cmd_published", "on_cmd_end", "speed_written", "pwm_end")
TO_HOST = ("to host", "cmd_published", "on_cmd_end", "odom_at_host")
BY_TIMER = ("by timer", "sensor_start", "on_tick_end", "pwm_end")
#: Reliable: the callback waits for the acknowledgement.
RELIABLE = Publication(
    topic="odom", transmission="odom_out", acknowledgement="odom_ack", reliable=True, waits=True, timeout=1000 * MS
)


def solution(found):
    return solve(timing_context(found))


def with_sender(found, task, transmission):
    """The system, in which a task queues a transmission."""
    fired = (*found.processes[task].activities, Trigger(stimulus="sent"))
    found = changed(changed(found, task, activities=fired), transmission, stimuli=("sent",))
    return with_stimulus(found, InterProcess(name="sent"))


def with_stimulus(found, stimulus):
    return replace(found, stimuli=replace(found.stimuli, stimuli=(*found.stimuli.stimuli, stimulus)))


def with_transmissions(found, *transmissions):
    return replace(found, network=replace(found.network, transmissions=transmissions))


def with_limits(found, *limits):
    return replace(found, constraints=Constraints(constraints=limits))


def response_of(found, name):
    """The worst response time of a handle."""
    return analyze_system(found).executors["Executor"].handles[name].response.worst


def test_the_hops_of_a_message_to_an_output_add_up():
    found = board(TO_PWM)
    chain = message_chains(found)["to pwm"]
    assert (chain.start, chain.end, chain.reason, chain.loss) == ("/cmd", "pwm", "", "")
    assert [hop.kind for hop in chain.hops] == [HopKind.AGENT, HopKind.WIRE, HopKind.EXECUTOR, HopKind.SAMPLING]
    agent, wire, executor, pwm = chain.hops
    assert (agent.best, agent.worst) == (MS, 2 * MS)
    assert (wire.best, wire.worst) == (CMD * US, (CMD + ACK) * US)
    assert executor.worst == response_of(found, "cmd")
    # Written just after pwm has read: a period, and its response time; nothing is above it.
    assert pwm.worst == 5 * MS + 50 * US
    assert chain.worst == sum(hop.worst for hop in chain.hops)
    assert chain.best == sum(hop.best for hop in chain.hops)
    assert sum(hop.share for hop in chain.hops) == 1


def test_the_parts_of_each_hop_add_up_to_it():
    for publication in (None, RELIABLE):
        for chain in message_chains(board(TO_PWM, TO_HOST, BY_TIMER, handles=[tick()], publication=publication)):
            for hop in filter(lambda hop: hop.parts, chain.hops):
                assert sum(part.most for part in hop.parts) == hop.worst


def test_a_message_to_the_host_does_not_wait_for_its_own_acknowledgement():
    found = board(TO_HOST, publication=RELIABLE)
    *_, executor, wire, agent = message_chains(found)["to host"].hops
    # To the agent, there, and back, where one /cmd can be on the wire.
    wait = sending_times(solution(found))["odom_out"]
    assert wait == Span(least=ODOM * US + MS + ACK * US, most=ODOM * US + 2 * MS + (ACK + CMD) * US)
    assert executor.worst == response_of(found, "cmd") - wait.most
    assert (wire.worst, agent.worst) == (ODOM * US, 2 * MS)


def test_a_write_that_can_block_holds_up_its_callback_until_the_message_is_on_the_wire():
    assert sending_times(solution(board()))["odom_out"] == Span(most=ODOM * US)


@pytest.mark.parametrize(
    "changes",
    [{"agent": Span(least=MS)}, {"wire": Wire(name="UART", kind=WireKind.SERIAL, cores=("c1", "c2"), loses_messages=True)}],
    ids=["unknown agent", "lost frames"],
)
def test_a_callback_waits_up_to_the_timeout_if_its_round_trip_has_no_bound(changes):
    # The timeout begins when the message is written.
    assert sending_times(solution(board(publication=RELIABLE, **changes)))["odom_out"].most == ODOM * US + RELIABLE.timeout


def test_an_unknown_latency_of_the_agent_leaves_the_chain_unknown_and_names_the_key():
    chain = message_chains(board(TO_PWM, agent=Span(least=MS)))["to pwm"]
    assert (chain.worst, chain.worst_if_not_lost) == (None, None)
    assert "to_controller" in chain.reason
    assert "middleware.agent.to_controller" in chain.remedy
    assert chain.best == sum(hop.best for hop in chain.hops) > CMD * US


def test_messages_that_a_wire_can_lose_have_no_bound_but_one_for_those_that_arrive():
    lossy = Wire(name="UART", kind=WireKind.SERIAL, cores=("c1", "c2"), loses_messages=True)
    safe, chain = (message_chains(board(TO_PWM, **changes))["to pwm"] for changes in ({}, {"wire": lossy}))
    assert chain.worst is None
    assert chain.worst_if_not_lost == safe.worst
    assert "UART" in chain.loss


def test_data_that_a_timer_reads_wait_for_its_period_and_its_response_time():
    found = board(BY_TIMER, handles=[tick(interval=50_000)])
    sensor, timer, pwm = message_chains(found)["by timer"].hops
    # The sensor executes for 20 us, and pwm preempts it once.
    assert sensor.worst == 70 * US
    assert timer.worst == 50 * MS + response_of(found, "tick")
    assert pwm.worst == 5 * MS + 50 * US


def test_data_that_a_callback_for_messages_reads_have_no_bound_if_these_are_irregular():
    handle, cost = tick()
    handle = replace(handle, kind=HandleKind.SUBSCRIPTION, is_periodic=False, depth=10)
    chain = message_chains(board(BY_TIMER, handles=[(handle, cost)]))["by timer"]
    assert chain.worst is None
    assert "tick" in chain.reason


def test_arrivals_vary_by_what_varies_before_them():
    # The agent by 1 ms, the wire by one acknowledgement.
    found = board()
    assert arrival_jitter(solution(found), {}) == {"cmd": MS + ACK * US}
    unknown, *others = found.network.transmissions
    found = with_transmissions(found, replace(unknown, agent=Span(least=MS)), *others)
    assert arrival_jitter(solution(found), {}) == {"cmd": ACK * US}


def test_arrivals_are_unknown_if_the_wire_is():
    # Nobody knows when acknowledgements come, which /cmd waits for on the wire.
    assert arrival_jitter(solution(board(agent=Span(least=MS))), {}) == {"cmd": None}


def test_a_callback_that_does_not_publish_the_topic_is_not_on_its_path():
    other = Publication(topic="other", transmission="odom_ack")
    chain = message_chains(board(TO_HOST, publication=other))["to host"]
    assert chain.worst is None
    assert chain.reason == "'cmd' does not publish '/odom'"


def test_what_nothing_connects_is_no_chain():
    chain = message_chains(board(("unconnected", "on_cmd_end", "on_tick_end"), handles=[tick()]))["unconnected"]
    assert chain.worst is None
    assert chain.reason == "no data flow or trigger connects 'cmd' to 'tick'"


def test_a_round_as_a_whole_is_no_member_of_a_chain():
    found = board()
    events = found.events.events
    whole = replace(events[0], name="round_start", process="Executor")
    chain = board(("round", "round_start", "on_cmd_end")).events.chains
    found = replace(found, events=replace(found.events, events=(*events, whole), chains=chain))
    assert "whole iteration" in message_chains(found)["round"].reason


@pytest.mark.parametrize("waits", [False, True])
def test_a_task_that_publishes_is_bounded_if_it_does_not_wait_for_the_acknowledgement(waits):
    found = board(("by task", "sensor_start", "odom_at_host"))
    waiting = [replace(each, waits=waits and each.name == "odom_out") for each in found.network.transmissions]
    found = with_transmissions(found, *waiting)
    assert "does not publish" in message_chains(found)["by task"].reason
    chain = message_chains(with_sender(found, "sensor", "odom_out"))["by task"]
    # To the end of the job, which pwm preempts once.
    assert chain.worst == (None if waits else (70 + ODOM) * US + 2 * MS)
    assert ("acknowledgement of '/odom'" in chain.reason) is waits


@pytest.mark.parametrize("waits", [False, True])
def test_a_task_of_its_own_that_waits_has_no_known_response_time(waits):
    """Its job is suspended until the acknowledgement comes, which its execution time does not contain."""
    found = with_sender(board(), "sensor", "odom_out")
    sent = (replace(each, waits=waits and each.name == "odom_out") for each in found.network.transmissions)
    analysis = analyze_system(with_transmissions(found, *sent))
    response, reason = analysis.processes["sensor"].response, analysis.processes["sensor"].reason
    # 20 us of its own, and pwm once.
    assert (response and response.worst) == (None if waits else 70 * US)
    assert ("acknowledgement of '/odom'" in reason) is waits
    # The executor below it may be delayed by it later than its activation.
    assert (analysis.executors["Executor"].handles["cmd"].response.worst is None) is waits


def test_limits_are_judged_by_the_hops():
    limits = [(LatencyKind.REACTION, 200, Verdict.MET), (LatencyKind.REACTION, 3, Verdict.MISSED)]
    limits += [(LatencyKind.REACTION, 20, Verdict.UNKNOWN), (LatencyKind.AGE, 200, Verdict.UNKNOWN)]
    found = board(TO_PWM)
    chain = message_chains(found)["to pwm"]
    assert 3 * MS < chain.best < 20 * MS < chain.worst < 200 * MS
    constraints = tuple(
        LatencyConstraint(name=f"limit {index}", chain="to pwm", kind=kind, maximum=limit * MS)
        for index, (kind, limit, _) in enumerate(limits)
    )
    analysis = analyze_system(with_limits(found, *constraints))
    assert [analysis.requirements[each.name].verdict for each in constraints] == [verdict for *_, verdict in limits]
    assert analysis.chains["to pwm"].value(LatencyQuantity.MAX_REDUCED_REACTION_TIME).value == chain.worst
    assert list(analysis.message_chains) == [chain]


def test_an_unknown_chain_is_never_met():
    limit = LatencyConstraint(name="limit", chain="to pwm", kind=LatencyKind.REACTION, maximum=10**15)
    analysis = analyze_system(with_limits(board(TO_PWM, agent=Span(least=MS)), limit))
    assert analysis.requirements["limit"].verdict is Verdict.UNKNOWN
    assert [finding.rule for finding in analysis.findings if finding.rule.startswith("CHN")] == ["CHN009"]


def test_chains_with_limits_come_first():
    limit = LatencyConstraint(name="limit", chain="to pwm", kind=LatencyKind.REACTION, maximum=200 * MS)
    found = analyze_system(with_limits(board(TO_HOST, TO_PWM), limit))
    assert [chain.name for chain in found.message_chains] == ["to pwm", "to host"]


def test_a_message_never_waits_for_one_of_the_thread_that_its_driver_keeps():
    wire = Wire(name="UART", kind=WireKind.SERIAL, cores=("c1", "c2"), keeps_sender=True)
    # Three at once as far as its stimulus says: calls of a timer can be late.
    sent = Periodic(name="late", period=200 * MS, jitter=Uniform(lower=0, upper=400 * MS))
    times = {}
    for keeps in (False, True):
        found = changed(board(TO_HOST, wire=replace(wire, keeps_sender=keeps)), "odom_out", stimuli=("late",))
        times[keeps] = sending_times(solution(with_stimulus(found, sent)))["odom_out"].most
    assert times == {False: 3 * ODOM * US, True: ODOM * US}


def test_another_sender_on_the_wire_is_waited_for():
    wire = Wire(name="UART", kind=WireKind.SERIAL, cores=("c1", "c2"), keeps_sender=True)
    found = board(TO_HOST, wire=wire)
    other = replace(found.transmissions["odom_out"], name="odom_ack", topic="other")
    found = reallocated(with_transmissions(found, *found.network.transmissions[:2], other), "odom_ack", scheduler="tx")
    assert sending_times(solution(found))["odom_out"].most == (ODOM + ACK) * US


@pytest.mark.parametrize(
    ("parts", "unread"),
    [
        # One every 10 ms, up to 40 ms late, in cycles of 6 ms. Until the end of the first one: 5, of the second: 6 less the one that is
        # read, of the third: 6 less 2, ..., and after the eleventh nothing is unread.
        (1, 5),
        # In two parts, which take two cycles: 12 ms.
        (2, None),
    ],
)
def test_messages_that_come_late_lie_unread_together(parts, unread):
    assert (
        max_backlog(
            [Arriving(events=SporadicEvents(10 * MS), jitter=40 * MS, parts=parts)], 6 * MS, CycleSequence(6 * MS, 6 * MS)
        )
        == unread
    )


def with_answers(found, interval, write):
    """The system in which /cmd comes at intervals and is acknowledged, which takes a time on a wire of its own."""
    stimuli = [
        replace(each, distance=Constant(interval * US)) if each.name == "cmd_in_queued" else each
        for each in found.stimuli.stimuli
    ]
    name, (structure,) = "cmd_in_acknowledgement", found.hardware.structures
    task = replace(found.processes["odom_out"], name=name, stimuli=("cmd_in_queued",), activities=(ticks(write),))
    allocated = replace(next(each for each in found.mapping.tasks if each.task == "odom_out"), task=name, scheduler="answers")
    core = replace(structure.cores[-1], name="c3")
    answer = replace(
        found.transmissions["odom_out"],
        name=name,
        topic=None,
        purpose=Purpose.ACKNOWLEDGEMENT,
        callback="On_cmd",
        acknowledges="cmd_in",
    )
    (operating,) = found.os.systems
    scheduler = Scheduler(name="answers", policy=Policy.OSEK, cores=("c3",))
    operating = replace(operating, schedulers=(*operating.schedulers, scheduler))
    return replace(
        found,
        hardware=replace(found.hardware, structures=(replace(structure, cores=(*structure.cores, core)),)),
        os=replace(found.os, systems=(operating,)),
        software=replace(found.software, tasks=(*found.software.tasks, task)),
        mapping=replace(found.mapping, tasks=(*found.mapping.tasks, allocated)),
        stimuli=replace(found.stimuli, stimuli=tuple(stimuli)),
        network=replace(found.network, transmissions=(*found.network.transmissions, answer)),
    )


@pytest.mark.parametrize(
    ("interval", "write", "answered"),
    [
        # A cycle has 10 ms of sleep, 12.55 ms of publication, 1 ms to answer what the wait reads, and 0.75 ms of execution: 24.3 ms. In
        # it and in its 1.74 ms of jitter one comes, which is unread for 24.3 ms at most; in 24.3 + 12.55 + 1.74 ms one.
        (50_000, 1000, 1),
        # One cycle of 25.3 ms and the jitter are still less than 30 ms, but 25.3 + 13.55 + 1.74 ms are more.
        (30_000, 1000, 2),
        # A cycle has 22.7 ms: two come in it and in the jitter, and one of them is unread for two; in 45.4 + 11.85 + 1.74 ms three.
        (24_000, 100, 3),
    ],
)
def test_a_publication_answers_what_was_unread_and_what_comes_while_it_waits(interval, write, answered):
    round_trip = ODOM * US + 2 * MS + (ACK + CMD) * US
    found = with_answers(board(publication=RELIABLE), interval, write)
    assert sending_times(solution(found))["odom_out"].most == round_trip + answered * write * US


def test_messages_that_come_faster_than_rounds_read_them_keep_a_publication_until_its_timeout():
    # A cycle takes at least 10 ms of sleep, also without a publication; the last answer can begin when the timeout ends.
    found = with_answers(board(publication=RELIABLE), 10_000, 1000)
    assert sending_times(solution(found))["odom_out"].most == (ODOM + 1000) * US + RELIABLE.timeout


def test_a_publication_reads_what_came_before_its_acknowledgement_so_that_nothing_older_is_unread():
    # Without it a cycle takes 12 ms, with it 27 ms: more than 20 ms, but no message is unread for longer than two cycles. In 54 ms,
    # 15.55 ms and the jitter of 1.74 ms, four come at 20 ms each.
    found = with_answers(board(publication=RELIABLE), 20_000, 1000)
    assert sending_times(solution(found))["odom_out"].most == (ODOM + 2000 + ACK + CMD + 4000) * US


def test_a_publication_has_no_bound_if_its_write_has_none():
    # More is sent than the wire can carry, so that the timeout begins at an unknown time.
    found = changed(board(publication=RELIABLE), "odom_out", activities=(ticks(300_000),))
    assert sending_times(solution(found))["odom_out"].most is None
    result = evaluate_executors_and_messages(solution(found))[0]["Executor"]
    assert result.handles["cmd"].response.worst is None
    assert "'odom_out', or what it writes while it waits, takes to be written has no bound" in result.reason


def with_timer_only_executor(sleep):
    """An executor that answers messages, and one of the same session whose waits do not read, with a reliable publication."""
    found = with_answers(board(publication=Publication(topic="odom", transmission=None)), 50_000, 1000)
    reader = found.executors[0]
    loop = replace(reader.loop, sleep=sleep, timeout=0)
    handles = tuple(replace(handle, publications=()) for handle in reader.handles)
    reader = replace(reader, loop=loop, session="s", handles=handles)
    timer = Handle(name="tick", kind=HandleKind.TIMER, runnable="On_tick", interval=1000 * MS, publications=(RELIABLE,))
    fast = replace(reader, name="Fast", task="Fast", spin="Spin_Fast", loop=replace(loop, sleep=MS), handles=(timer,))
    calls = (Call(runnable="Spin_Fast"), Call(runnable="On_tick"))
    task = replace(found.processes["Executor"], name="Fast", stimuli=("iterations",), activities=calls)
    runnables = (Runnable(name="Spin_Fast", activities=(ticks(10),)), Runnable(name="On_tick", activities=(ticks(10),)))
    software = found.software
    software = replace(software, tasks=(*software.tasks, task), runnables=(*software.runnables, *runnables))
    allocation = next(each for each in found.mapping.tasks if each.task == "Executor")
    mapping = replace(found.mapping, tasks=(*found.mapping.tasks, replace(allocation, task="Fast", priority=6)))
    iterations = RelativePeriodic(name="iterations", distance=Constant(MS), has_maximum=False)
    return with_stimulus(replace(found, executors=(reader, fast), software=software, mapping=mapping), iterations)


@pytest.mark.parametrize(("sleep", "is_bounded"), [(10 * MS, True), (100 * MS, False)])
def test_what_an_executor_that_does_not_read_finds_unread_is_left_by_the_one_that_reads(sleep, is_bounded):
    solved = solution(with_timer_only_executor(sleep))
    sending = sending_times(solved)
    reader, fast = (Cycle.of(each, solved, sending) for each in solved.context.system.executors)
    assert fast.longest < reader.longest
    assert fast.backlog_age == reader.backlog_age
    assert (fast.backlog_age is not None) is is_bounded


def test_a_chain_from_the_start_of_a_callback_does_not_include_taking_its_message():
    """The callback takes 100 us; to take the message before takes 30 us."""
    found = describe_text("""
amuros: 1
name: p
hardware: {platform: single-core, frequency: 1 GHz}
middleware:
  executor: {name: main, loop: {spin_some: 1 ms, sleep: 1 ms}, execution_time: {base: 10 us, per_message: 30 us}}
  transport: {custom: {table: [{size: 512 B, time: 1 ms}]}}
  agent: {to_controller: 0 ms}
application:
  nodes:
    - name: n
      subscriptions:
        - {name: on_cmd, topic: cmd, rate: 10 Hz, message_size: 8 B, execution_time: 100 us, writes: [speed], reliability: best-effort}
labels: {speed: 4 B}
chains: [{name: inside, path: [on_cmd, speed]}, {name: whole, path: [/cmd, on_cmd, speed]}]
""").assembly.system
    chains = message_chains(found)
    assert chains["inside"].best == 100 * US
    assert chains["whole"].best == MS + 130 * US
