"""The recording of a robot's host that the tutorial reads: a planner that preempts a logger on one core, for a second.

    python tests/robot_recording.py samples/robot-recording
"""

import shutil
import sys
from pathlib import Path
from random import Random

from ctf_traces import PacketWriter, ros2_writer

MS, US = 10**6, 10**3
START = 5 * 10**9
PLANNER, LOGGER = (100, 100, "control"), (200, 200, "log")
PRIORITIES = {"control": -81, "log": -21, "swapper/0": 20}
#: Handles and addresses: node, publishers in rcl and rmw, subscription in rcl, rmw and rclcpp, its callback, timer, its callback.
NODE, COMMAND, LOG, SUBSCRIPTION, ON_MESSAGE, TIMER, ON_TIMER = 0x10, 0x20, 0x30, 0x40, 0x50, 0x60, 0x70


class Recording:
    """Events of the nodes and of the scheduler, in ns from the start."""

    def __init__(self) -> None:
        self.writer: PacketWriter = ros2_writer()
        self.nodes: list[tuple[int, bytes]] = []
        self.kernel: list[tuple[int, bytes]] = []

    def ros(self, time: int, name: str, thread: tuple, *values: object) -> None:
        self.nodes.append((time, self.writer.event(START + time, f"ros2:{name}", thread, *values, is_extended=True)))

    def switch(self, time: int, before: str, after: str, state: int) -> None:
        numbers = {"control": 100, "log": 200, "swapper/0": 0}
        first = before, numbers[before], PRIORITIES[before], state
        values = *first, after, numbers[after], PRIORITIES[after]
        self.kernel.append((time, self.writer.event(START + time, "sched_switch", (0, 0, ""), *values, is_extended=True)))

    def write(self, folder: Path) -> None:
        for name, events in (("ust", self.nodes), ("kernel", self.kernel)):
            ordered = [event for _, event in sorted(events, key=lambda each: each[0])]
            self.writer.write(folder / name, [self.writer.packet(START, ordered, length=2 * 10**9)])


def create(recording: Recording) -> None:
    for time, (thread, node, topic, depth) in enumerate([(PLANNER, "planner", "/odom", 5), (LOGGER, "logger", "/log", 10)]):
        recording.ros(time, "rcl_init", thread, 1, "4.1.1")
        recording.ros(time, "rcl_node_init", thread, NODE, 0, node, "/")
        recording.ros(time, "rcl_subscription_init", thread, SUBSCRIPTION, SUBSCRIPTION + 1, NODE, topic, depth)
        recording.ros(time, "rclcpp_subscription_init", thread, SUBSCRIPTION, SUBSCRIPTION + 2)
        recording.ros(time, "rclcpp_subscription_callback_added", thread, SUBSCRIPTION + 2, ON_MESSAGE)
    for handle, topic in ((COMMAND, "/cmd_vel"), (LOG, "/log")):
        recording.ros(2, "rcl_publisher_init", PLANNER, handle, handle + 1, NODE, topic, 10)
    recording.ros(2, "rcl_timer_init", PLANNER, TIMER, 20 * MS)
    recording.ros(2, "rclcpp_timer_callback_added", PLANNER, TIMER, ON_TIMER)
    recording.ros(2, "rclcpp_timer_link_node", PLANNER, TIMER, NODE)


def call(recording: Recording, thread: tuple, callback: int, start: int, end: int, stamp: int = 0) -> None:
    if stamp:
        recording.ros(start - 2, "rmw_take", thread, SUBSCRIPTION + 1, 9, stamp, 1)
    recording.ros(start, "callback_start", thread, callback, 0)
    recording.ros(end, "callback_end", thread, callback)


def plan(recording: Recording, random: Random) -> tuple[list[tuple[int, int]], list[int]]:
    """What the planner executes, in the order of release: when its core is busy, and when it publishes to the logger."""
    timers = [(number * 20 * MS, ON_TIMER) for number in range(1, 50)]
    odometry = [(number * 100 * MS + random.randrange(3 * MS), ON_MESSAGE) for number in range(10)]
    busy, logs, now = [], [], 0
    for release, callback in sorted([*timers, *odometry]):
        start = max(release + 30 * US, now)
        time = random.randrange(1000, 2900) if callback == ON_TIMER else random.randrange(250, 780)
        end = start + time * US
        call(recording, PLANNER, callback, start, end, release + 1 if callback == ON_MESSAGE else 0)
        if callback == ON_MESSAGE:
            for handle in (COMMAND, LOG):
                recording.ros(end - 1000 + handle, "rcl_publish", PLANNER, handle, 9)
                recording.ros(end - 990 + handle, "rmw_publish", PLANNER, handle + 1, 9, end)
            logs.append(end)
        busy.append((start - 10 * US, end + 5 * US))
        now = end + 20 * US
    return busy, logs


def log(recording: Recording, random: Random, busy: list[tuple[int, int]], logs: list[int]) -> list[tuple[int, int]]:
    """What the logger executes while the planner does not: when it does."""
    parts = []
    for stamp in logs:
        left, now = random.randrange(16000, 21000) * US, stamp + 100 * US
        start = now
        while left:
            until = min((first for first, _ in busy if first > now), default=now + left)
            blocked = next((last for first, last in busy if first <= now < last), None)
            if blocked is not None:
                now = blocked
                start = max(start, now) if not parts or parts[-1][1] <= stamp else start
                continue
            part = min(left, until - now)
            parts.append((now, now + part))
            left, now = left - part, now + part
        call(recording, LOGGER, ON_MESSAGE, start + 3 * US, now - 3 * US, stamp)
    return parts


def main(folder: Path) -> None:
    recording, random = Recording(), Random(1)
    create(recording)
    busy, logs = plan(recording, random)
    parts = log(recording, random, busy, logs)
    ends = {time + 3 * US for time in []}
    running = sorted([(*each, "control") for each in busy] + [(*each, "log") for each in parts])
    for index, (start, end, name) in enumerate(running):
        before = running[index - 1] if index and running[index - 1][1] == start else None
        after = running[index + 1] if index + 1 < len(running) else None
        if before is None:
            recording.switch(start, "swapper/0", name, 0)
        is_next = after is not None and after[0] == end
        # A part of the logger that the planner ends is preempted; everything else blocks.
        is_preempted = name == "log" and is_next and after is not None and (end, ) and any(first == end for first, _ in busy)
        recording.switch(end, name, after[2] if is_next and after is not None else "swapper/0", 0 if is_preempted else 1)
    del ends
    recording.write(folder)


if __name__ == "__main__":
    target = Path(sys.argv[1])
    shutil.rmtree(target, ignore_errors=True)
    main(target)
