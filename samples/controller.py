"""A virtual controller: logs of a CAN bus as the controller of the thesis may have written them, made by simulation.

It is not the model that predicts: it behaves as was measured (S. R. Bappanadu, University of Stuttgart, 2022, tables 6.1, 6.2 and 6.5).
Empty tasks take 41 us at 1 kHz and 31 us at 50 Hz on average, and vary. The agent delays each message by up to 20 ms.

| log | software on the controller |
|---|---|
| profile.log | each function has a task of its own; no timer belongs to the executor |
| application.log, other.log | the control function shares the task of the executor, which also serves its timer |
| improved.log | the same, with the message callback in a task of 1 ms |

The timer takes 11.165 us that nobody profiled, so that executor and control function take 68.83 us on average, and 100 us at most.

FILE.log.markers.yaml says which frame is what: `amuros measure FILE.log --markers FILE.log.markers.yaml`.

Usage: python controller.py [DURATION]
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import amalthea_uros as amuros
from amalthea_uros.trace.table import EntityKind, EventKind, EventTable


def shares(**counts: int) -> str:
    """A histogram: how often each number of microseconds occurs."""
    bins = (f"{{min: {us[1:]} us, max: {us[1:]} us, count: {count}}}" for us, count in counts.items())
    return f"{{histogram: [{', '.join(bins)}]}}"


#: The means are 41 us, 31 us, 13.3 us, 1.2 us, 4 us and 11.165 us.
FAST = shares(_25=20, _41=960, _57=20)
SLOW = shares(_25=8, _31=986, _39=6)
MESSAGE = shares(_13=7, _14=3)
FACTOR = shares(_1=8, _2=2)
CONTROL = shares(_3=1, _4=8, _5=1)
TIMER = shares(_11=835, _12=165)

DESCRIPTION = f"""\
amuros: 1
name: controller
hardware: {{platform: single-core}}
middleware:
  task_periods: [1 ms, 20 ms]
  executor:
    name: Executor_Task
    period: 1 ms
    execution_time: {{base: 12 us, per_message: {MESSAGE}TIMER}}
    overhead: {FAST}
application:
  nodes:
    - name: bodas
      subscriptions:
        - {{name: Message_Factor, topic: factor, rate: 50 Hz, message_size: 4 B, buffer: memory_1, writes: [memory_2],
           priority: 3, execution_time: {FACTOR}, overhead: MAPPED}}
      timers:
        - {{name: Control_Function, period: 1 ms, reads: [memory_2], writes: [output], execution_time: {CONTROL}, overhead: SHARED}}
tasks:
  - {{name: Empty_1kHz, period: 1 ms, priority: 2, overhead: {FAST}}}
  - {{name: Empty_50Hz, period: 20 ms, priority: 1, overhead: {SLOW}}}
chains:
  - {{name: factor-to-output, path: [Executor_Task, Message_Factor, Control_Function], reaction: 25 ms}}
"""
#: It sends every 20 ms from the start of the controller on, and delays each message by up to 20 ms.
AGENT = ("Message_Factor.phase=0ms", "Message_Factor.arrival_jitter=20ms")
#: What each build has for the words in capitals.
BUILDS = {
    "profile": {"TIMER": "", "SHARED": FAST, "MAPPED": SLOW},
    "application": {"TIMER": f", per_timer: {TIMER}", "SHARED": "0", "MAPPED": SLOW},
    "improved": {"TIMER": f", per_timer: {TIMER}", "SHARED": "0", "MAPPED": f"{FAST}, task_period: 1 ms"},
}
#: The build and the seed of each log.
LOGS = {"profile": ("profile", 1), "application": ("application", 1), "other": ("application", 2), "improved": ("improved", 3)}

#: What is instrumented; each has an identifier on the debug bus for its start, and the next one for its end.
TASKS = ("Executor_Task", "Control_Function", "Message_Factor", "Empty_1kHz", "Empty_50Hz")
FUNCTIONS = ("Executor_Task_Spin", "Take_Message_Factor", "Message_Factor_Callback", "Control_Function_Callback")
FIRST_OF_TASKS, FIRST_OF_FUNCTIONS = 0x18000001, 0x18000011
MESSAGE_TAKEN, OUTPUT_WRITTEN, STATISTICS = 0x18000021, 0x18000022, 0x18000101
MARKERS = """\
Executor_Task: {start: 18000001, end: 18000002, counter: bytes 0..3, kind: process, quantity: net_execution_time, baseline: Empty_1kHz}
Control_Function: {start: 18000003, end: 18000004, counter: bytes 0..3, kind: process, quantity: net_execution_timeSHARED}
Message_Factor: {start: 18000005, end: 18000006, counter: bytes 0..3, kind: process, quantity: net_execution_time, baseline: MAPPED}
Empty_1kHz: {start: 18000007, end: 18000008, counter: bytes 0..3}
Empty_50Hz: {start: 18000009, end: 1800000A, counter: bytes 0..3}
"""
#: What only the application has: its functions, two of them as one interval, and the chain, with the number of the message.
MARKERS_OF_APPLICATION = """\
Executor_Task_Spin: {start: 18000011, end: 18000012, counter: bytes 0..3, kind: runnable, quantity: net_execution_time}
Take_Message_Factor: {start: 18000013, end: 18000014, counter: bytes 0..3, kind: runnable, quantity: net_execution_time}
Message_Factor_Callback: {start: 18000015, end: 18000016, counter: bytes 0..3, kind: runnable, quantity: net_execution_time}
Control_Function_Callback: {start: 18000017, end: 18000018, counter: bytes 0..3, kind: runnable, quantity: net_execution_time}
Executor_and_Control: {start: 18000001, end: 18000004, counter: bytes 0..3}
factor-to-output: {from: 18000021, to: 18000022, counter: bytes 0..3}
"""
MICROSECOND, SECOND = 10**6, 10**12
ENDS = {
    EntityKind.TASK: (EventKind.START, EventKind.TERMINATE),
    EntityKind.RUNNABLE: (EventKind.RUNNABLE_START, EventKind.RUNNABLE_TERMINATE),
}
#: The recording begins on 15 April 2022.
EPOCH = 1_650_000_000

Frame = tuple[int, int, bytes]


def main(duration: str = "10 s", folder: Path = Path()) -> None:
    """Write all logs."""
    for name, (build, seed) in LOGS.items():
        trace = run(build, duration, seed).trace
        assert trace is not None
        write(folder / f"{name}.log", trace, build)


def run(build: str, duration: str, seed: int) -> amuros.Simulation:
    """What the controller does."""
    text = DESCRIPTION
    for name, value in BUILDS[build].items():
        text = text.replace(name, value)
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"{build}.yaml"
        path.write_text(text)
        return amuros.simulate(path, duration, seed=seed, changes=AGENT, trace=True)


def write(path: Path, table: EventTable, build: str) -> None:
    """Write a log, and the file with its markers beside it."""
    frames = [*interval_frames(table, EntityKind.TASK, TASKS, FIRST_OF_TASKS)]
    markers = MARKERS.replace("SHARED", ", baseline: Empty_1kHz" if build == "profile" else "")
    markers = markers.replace("MAPPED", "Empty_1kHz" if build == "improved" else "Empty_50Hz")
    if build != "profile":
        markers += MARKERS_OF_APPLICATION
        frames += interval_frames(table, EntityKind.RUNNABLE, FUNCTIONS, FIRST_OF_FUNCTIONS)
        frames += [*chain_frames(table), *statistics_frames(table)]
    with path.open("w") as log:
        log.writelines(line(*frame) for frame in sorted(frames))
    path.with_name(f"{path.name}.markers.yaml").write_text(markers)


def events(table: EventTable, kind: EventKind, entity: EntityKind, name: str) -> Iterator[tuple[int, int]]:
    """Time and number of the job of events of an object."""
    number = next(index for index, each in enumerate(table.entities) if (each.kind, each.name) == (entity, name))
    found = table.where((table.kind == kind) & (table.target == number))
    return zip(found.time.tolist(), found.target_instance.tolist(), strict=True)


def interval_frames(table: EventTable, entity: EntityKind, names: tuple[str, ...], first: int) -> Iterator[Frame]:
    """The start and the end of each job of tasks or functions."""
    for number, name in enumerate(names):
        for place, kind in enumerate(ENDS[entity]):
            for time, job in events(table, kind, entity, name):
                yield time, first + 2 * number + place, job.to_bytes(4, "little")


def chain_frames(table: EventTable) -> Iterator[Frame]:
    """The start of the executor's job that takes a message, and the ends of the jobs whose output is based on it."""
    starts = {job: time for time, job in events(table, EventKind.START, EntityKind.TASK, "Executor_Task")}
    steps = table.where(table.kind == EventKind.CHAIN_STEP)
    rows = zip(
        *(column.tolist() for column in (steps.time, steps.source_instance, steps.target_instance, steps.note)), strict=True
    )
    for time, job, message, step in rows:
        if step == 0:
            yield starts[job], MESSAGE_TAKEN, message.to_bytes(4, "little")
        elif step == 2:
            yield time, OUTPUT_WRITTEN, message.to_bytes(4, "little")


def statistics_frames(table: EventTable) -> Iterator[Frame]:
    """What a controller reports that measures itself: executor and control function together, each second, in steps of 0.1 us."""
    starts = {job: time for time, job in events(table, EventKind.START, EntityKind.TASK, "Executor_Task")}
    seconds: dict[int, list[int]] = {}
    for time, job in events(table, EventKind.TERMINATE, EntityKind.TASK, "Control_Function"):
        seconds.setdefault(time // SECOND, []).append((time - starts[job]) * 10 // MICROSECOND)
    for second, times in seconds.items():
        values = min(times), round(sum(times) / len(times)), max(times), len(times)
        yield (second + 1) * SECOND, STATISTICS, b"".join(value.to_bytes(2, "little") for value in values)


def line(time: int, identifier: int, data: bytes) -> str:
    """A frame as candump logs it."""
    seconds, rest = divmod(time, SECOND)
    return f"({EPOCH + seconds}.{rest // MICROSECOND:06}) can0 {identifier:08X}#{data.hex().upper()}\n"


if __name__ == "__main__":
    main(" ".join(sys.argv[1:]) or "10 s")
