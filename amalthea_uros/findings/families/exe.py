"""Findings about executors."""

from __future__ import annotations

from amalthea_uros.diagnostics import Severity
from amalthea_uros.findings.kind import FindingKind

KINDS = (
    FindingKind(
        id="EXE010",
        title="timer that can lose periods",
        severity=Severity.WARNING,
        rationale=(
            "A timer keeps its grid: when it is called after further periods have passed, these are lost, and no burst "
            "follows. Rounds, and the sleep of the loop, are longer than its period."
        ),
        remedy="Shorten the sleep of the loop and the callbacks, lengthen the period, or move the timer to an executor of its own.",
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
    ),
    FindingKind(
        id="EXE018",
        title="guard condition that wakes nobody",
        severity=Severity.WARNING,
        rationale=(
            "The middleware looks at guard conditions only after the wait, so that a trigger is seen when a message, a "
            "timer or the timeout ends it."
        ),
        remedy="Shorten the timeout of the executor, or add a timer with the period at which triggers must be seen.",
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
    ),
)
