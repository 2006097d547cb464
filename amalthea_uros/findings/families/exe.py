"""Findings about executors that spin in loops."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

_APPLICATION = """
amuros: 1
name: app
hardware: {{platform: single-core, frequency: 100 MHz}}
middleware:
  executor: {executor}
application:
  nodes:
    - name: node
{callbacks}
"""
_TIMER = "      timers: [{name: Control, period: 10 ms, execution_time: 4 us}]"
_SUBSCRIPTION = (
    "      subscriptions: [{name: On_Command, topic: command, rate: 50 Hz, message_size: 4 B, execution_time: 4 us}]"
)
_GUARD = "      guard_conditions: [{name: Stop, execution_time: 4 us}]"
_ACTION = """      action_servers:
        - {name: Move, rate: 1 Hz, goal_size: 4 B, result_size: 4 B, feedback_size: 4 B, execution_time: 4 us}"""

_PUBLISHING = """      publishers: [{{topic: odom, message_size: 48 B}}]
      timers: [{{name: Report, period: 10 s, execution_time: 1 ms, publishes: [odom]}}]
      subscriptions:
        - {{name: On_Command, topic: command, interval: 4 s, message_size: 4 B, execution_time: 4 us{more}}}
        - {{name: On_Map, topic: map, interval: 4 s, message_size: 4 B, execution_time: 4 us}}"""


def _example(executor: str, *callbacks: str) -> str:
    return _APPLICATION.format(executor=executor, callbacks="\n".join(callbacks))


KINDS = (
    FindingKind(
        id="EXE001",
        title="more handles than the executor was initialised with",
        severity=Severity.ERROR,
        rationale="The handles are allocated once. Adding one more returns an error, and its callback never runs.",
        remedy="Increase the number in rclc_executor_init and 'max_handles'; a parameter server needs 6 handles.",
        fails=_example("{max_handles: 1, loop: {spin: 1 s}}", _TIMER, _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE002",
        title="timeout longer than the period of the loop",
        severity=Severity.WARNING,
        rationale="rclc_executor_spin_period waits for the timeout of the executor, not for the period. The timeout is 1 s by "
        "default, so that each round takes 1 s if no message arrives and no timer expires; after that, rounds follow "
        "each other without a pause.",
        remedy="Call rclc_executor_set_timeout with less than the period, and set 'timeout'.",
        fails=_example("{loop: {spin_period: 10 ms}}", _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE003",
        title="executor that does not wait",
        severity=Severity.WARNING,
        rationale="The timeout of a wait is cut to whole milliseconds, so that a shorter one is 0. And a timer that is due, but "
        "kept back by the trigger condition, ends each wait at once. Without a sleep, the loop then uses all the time "
        "that other tasks leave it.",
        remedy="Set a timeout of 1 ms or more, add a sleep, or use the trigger condition 'any'.",
        fails=_example("{loop: {spin_some: 100 ns}}", _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE004",
        title="trigger condition 'one' with actions",
        severity=Severity.WARNING,
        rationale="rclc_executor_trigger_one does not know actions: it answers 'false' when it comes to a ready one before its "
        "own handle.",
        remedy="Add the handle to the executor before the actions, or use a trigger function of your own.",
        fails=_example("{loop: {spin: 1 s}, order: [Move], trigger: {one: On_Command}}", _SUBSCRIPTION, _ACTION),
    ),
    FindingKind(
        id="EXE005",
        title="guard condition that can be lost",
        severity=Severity.WARNING,
        rationale="The middleware clears a guard condition when it has seen it. If the trigger condition is false in that round, "
        "its callback does not run, then or later.",
        remedy="Use a trigger condition that the guard condition alone makes true.",
        fails=_example("{loop: {spin: 1 s}, trigger: all}", _SUBSCRIPTION, _GUARD),
    ),
    FindingKind(
        id="EXE006",
        title="executor with timers only that does not wait",
        severity=Severity.WARNING,
        rationale="Without a subscription, service or client, the wait of rmw_microxrcedds returns at once "
        "(rmw_microxrcedds#297), and the loop uses all the time that other tasks leave it. With the change #305 it "
        "waits for the whole timeout, also if a guard condition is set. Nothing reads the transport, except publications that wait "
        "for their acknowledgement: what the agent sends fills the buffers (micro_ros_arduino#183).",
        remedy="Add a sleep to the loop, or a subscription, and check which version is built.",
        fails=_example("{loop: {spin: 1 s}}", _TIMER),
    ),
    FindingKind(
        id="EXE007",
        title="timer that expires more often than the loop spins",
        severity=Severity.WARNING,
        rationale="A timer is called at most once per round, and the periods that it missed are skipped.",
        remedy="Shorten the sleep or the period of the loop to less than the period of the timer.",
        fails=_example("{loop: {spin_some: 100 ms, sleep: 100 ms}}", _TIMER, _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE008",
        title="several threads, but no locking in the middleware",
        severity=Severity.WARNING,
        rationale="Without UCLIENT_PROFILE_MULTITHREAD, the session is not locked: messages of two threads can destroy each "
        "other.",
        remedy="Build with UCLIENT_PROFILE_MULTITHREAD=ON and set 'multithread: true', or use one executor for all callbacks.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  executors:
    - {name: Fast, loop: {spin: 1 s}}
    - {name: Slow, loop: {spin: 1 s}}
application:
  nodes:
    - name: node
      subscriptions:
        - {name: On_Command, topic: command, rate: 50 Hz, message_size: 4 B, execution_time: 4 us}
        - {name: On_Map, topic: map, rate: 1 Hz, message_size: 4 B, execution_time: 4 us, runs_in: Slow}
""",
    ),
    FindingKind(
        id="EXE009",
        title="callback that is listed twice in the order of an executor",
        severity=Severity.WARNING,
        rationale="Each handle is added once; the first place counts.",
        remedy="Remove one of them.",
        fails=_example("{loop: {spin: 1 s}, order: [On_Command, On_Command]}", _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE010",
        title="timer that can lose periods",
        severity=Severity.WARNING,
        rationale=(
            "A timer keeps its grid: when it is called after further periods have passed, these are lost, and no burst "
            "follows. Rounds, and the sleep of the loop, are longer than its period."
        ),
        remedy="Shorten the sleep of the loop and the callbacks, lengthen the period, or move the timer to an executor of its own.",
        fails=_example("{loop: {spin_some: 100 ms, sleep: 100 ms}}", _TIMER, _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE011",
        title="timer that is called late",
        severity=Severity.WARNING,
        rationale=(
            "A timer is only checked once in a round. When it becomes due during the sleep of the loop, it waits for "
            "the rest of it; as waits are cut to whole milliseconds, this even happens if the loop waited for the "
            "timer."
        ),
        remedy="Shorten the sleep of the loop, or use `spin` without a sleep and a timeout.",
        fails=_example("{loop: {spin_some: 100 ms, sleep: 5 ms}}", _TIMER),
    ),
    FindingKind(
        id="EXE012",
        title="messages arrive faster than rounds serve them",
        severity=Severity.ERROR,
        rationale=(
            "A wait takes one message, so that a round serves one message of all topics. The others wait before it, in "
            "the order of their arrival: the overload is seen as growing age of the data, not as lost messages."
        ),
        remedy="Shorten the sleep of the loop, reduce the rate of messages, or use several executors.",
        fails=_example("{loop: {spin_some: 100 ms, sleep: 100 ms}}", _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE013",
        title="messages near the capacity of a loop",
        severity=Severity.WARNING,
        rationale=(
            "A wait takes one message, so that a loop with a sleep has a limit of messages per second for all topics "
            "together. The rest of this capacity is small, and bursts take long to be served."
        ),
        remedy="Shorten the sleep of the loop, or reduce the rate of messages.",
        fails=_example("{loop: {spin_some: 100 ms, sleep: 15 ms}}", _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE014",
        title="messages dropped because the pool is exhausted",
        severity=Severity.WARNING,
        rationale=(
            "All subscriptions, services and clients share the slots for received messages. A new message of any topic "
            "is dropped when none is free, also with reliable QoS."
        ),
        remedy="Increase RMW_UXRCE_MAX_HISTORY, shorten the timeout of publications, or let messages be taken earlier.",
        fails=_example("{loop: {spin_some: 100 ms}}\n  limits: {RMW_UXRCE_MAX_HISTORY: 1}", _PUBLISHING.format(more="")),
    ),
    FindingKind(
        id="EXE015",
        title="messages lost in the history of a handle",
        severity=Severity.WARNING,
        rationale=(
            "A handle keeps as many messages as the depth of its QoS: a further one overwrites the oldest, or is "
            "dropped. A stored message is also removed when it gets older than the lifespan."
        ),
        remedy="Increase the depth, reduce the rate of messages, or let them be taken earlier.",
        fails=_example("{loop: {spin_some: 100 ms}}", _PUBLISHING.format(more=", jitter: 3.5 s, depth: 1")),
    ),
    FindingKind(
        id="EXE016",
        title="trigger condition that makes the loop busy",
        severity=Severity.WARNING,
        rationale=(
            "A timer that is due makes waits return at once. If the trigger condition keeps it back, the thread polls "
            "without a pause until it is true."
        ),
        remedy="Put timers into an executor whose trigger condition is `any`.",
        fails=_example("{loop: {spin: 1 s}, trigger: all}", _TIMER, _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE017",
        title="stored messages that do not end the wait",
        severity=Severity.WARNING,
        rationale=(
            "Messages that arrive while a publication waits for its acknowledgement are stored. The following wait "
            "does not look at them, and lasts until the next message, timer or timeout."
        ),
        remedy="Shorten the timeout of the executor, or publish with best-effort QoS.",
        fails=_example("{loop: {spin_some: 100 ms}}", _PUBLISHING.format(more="")),
    ),
    FindingKind(
        id="EXE018",
        title="guard condition that does not wake the executor",
        severity=Severity.WARNING,
        rationale=(
            "The middleware looks at guard conditions only after the wait, so that a trigger is seen when a message, a "
            "timer or the timeout ends it."
        ),
        remedy="Shorten the timeout of the executor, or add a timer with the period at which triggers must be seen.",
        fails=_example("{loop: {spin: 1 s}}", _SUBSCRIPTION, _GUARD),
    ),
    FindingKind(
        id="EXE020",
        title="loop with a period that must catch up",
        severity=Severity.WARNING,
        rationale=(
            "The wait of `spin_period` uses the timeout of the executor, not the period. After a longer round it does "
            "not sleep until it has caught up, so that a burst of rounds follows."
        ),
        remedy="Set a timeout that is shorter than the period less the execution time of a round (rclc_executor_set_timeout).",
        fails=_example("{loop: {spin_period: 10 ms}}", _SUBSCRIPTION),
    ),
    FindingKind(
        id="EXE022",
        title="publications that wait for the session",
        severity=Severity.WARNING,
        rationale=(
            "With a middleware for several threads, the thread that waits for input keeps the session for the rest of "
            "its timeout; others cannot publish meanwhile."
        ),
        remedy="Use a short timeout in all executors of the session, or one executor only.",
        fails="""
amuros: 1
name: app
hardware: {platform: single-core, frequency: 100 MHz}
middleware:
  multithread: true
  executors:
    - {name: Fast, loop: {spin: 1 s}}
    - {name: Slow, loop: {spin_some: 10 ms, sleep: 10 ms}}
application:
  nodes:
    - name: node
      publishers: [{topic: state, message_size: 8 B, reliability: best-effort}]
      subscriptions:
        - {name: On_Command, topic: command, rate: 2 Hz, message_size: 4 B, execution_time: 4 us}
      timers:
        - {name: Report, period: 500 ms, execution_time: 1 ms, publishes: [state], runs_in: Slow}
""",
    ),
    FindingKind(
        id="EXE023",
        title="guard condition whose triggers can be lost",
        severity=Severity.WARNING,
        rationale=(
            "A trigger sets a flag, which is cleared when it is seen: two triggers before that are one, and one that "
            "is seen while the trigger condition of the executor is false is lost."
        ),
        remedy="Trigger it less often, or see it earlier with a shorter timeout.",
        fails=_example("{loop: {spin: 1 s}, trigger: all}", _SUBSCRIPTION, _GUARD),
    ),
)
