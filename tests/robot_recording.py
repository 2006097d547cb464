"""The recording that the tutorial reads: a planner and a logger on one core for a second, of which the planner preempts the logger.

python tests/robot_recording.py samples/robot-recording
"""

import shutil
import sys
from pathlib import Path
from random import Random

from ctf_traces import ros2_writer

MS, US = 10**6, 10**3
START = 5 * 10**9
PLANNER, LOGGER = (100, 100, "control"), (200, 200, "log")
#: An idle thread, and threads of SCHED_FIFO with the priorities 80 and 20: number, and the priority that LTTng records.
THREADS = {"swapper/0": (0, 20), "control": (100, -81), "log": (200, -21)}
#: Handles and addresses, the same in both processes.
NODE, COMMAND, LOG, SUBSCRIPTION, ON_MESSAGE, TIMER, ON_TIMER = 0x10, 0x20, 0x30, 0x40, 0x50, 0x60, 0x70
#: What the executor takes before a callback and after it.
BEFORE, AFTER = 10 * US, 5 * US


class Recording:
    """Events of the nodes and of the scheduler, in ns from the start."""

    def __init__(self) -> None:
        self.writer = ros2_writer()
        self.streams: dict[str, list[tuple[int, bytes]]] = {"ust": [], "kernel": []}

    def add(self, time: int, name: str, thread: tuple, *values: object) -> None:
        self.streams["ust"].append((time, self.writer.event(START + time, f"ros2:{name}", thread, *values, is_extended=True)))

    def switch(self, time: int, before: str, after: str, state: int) -> None:
        values = before, *THREADS[before], state, after, *THREADS[after]
        event = self.writer.event(START + time, "sched_switch", (0, 0, ""), *values, is_extended=True)
        self.streams["kernel"].append((time, event))

    def call(self, thread: tuple, callback: int, start: int, end: int, stamp: int = 0) -> None:
        if stamp:
            self.add(start - 2, "rmw_take", thread, SUBSCRIPTION + 1, 9, stamp, 1)
        self.add(start, "callback_start", thread, callback, 0)
        self.add(end, "callback_end", thread, callback)

    def publish(self, time: int, handle: int) -> None:
        self.add(time, "rcl_publish", PLANNER, handle, 9)
        self.add(time + 1, "rmw_publish", PLANNER, handle + 1, 9, time)

    def write(self, folder: Path) -> None:
        for name, events in self.streams.items():
            ordered = [event for _, event in sorted(events, key=lambda each: each[0])]
            self.writer.write(folder / name, [self.writer.packet(START, ordered, length=2 * 10**9)])


def create(recording: Recording) -> None:
    for time, (thread, node, topic, depth) in enumerate([(PLANNER, "planner", "/odom", 5), (LOGGER, "logger", "/log", 10)]):
        recording.add(time, "rcl_init", thread, 1, "4.1.1")
        recording.add(time, "rcl_node_init", thread, NODE, 0, node, "/")
        recording.add(time, "rcl_subscription_init", thread, SUBSCRIPTION, SUBSCRIPTION + 1, NODE, topic, depth)
        recording.add(time, "rclcpp_subscription_init", thread, SUBSCRIPTION, SUBSCRIPTION + 2)
        recording.add(time, "rclcpp_subscription_callback_added", thread, SUBSCRIPTION + 2, ON_MESSAGE)
    for handle, topic in ((COMMAND, "/cmd_vel"), (LOG, "/log")):
        recording.add(2, "rcl_publisher_init", PLANNER, handle, handle + 1, NODE, topic, 10)
    recording.add(2, "rcl_timer_init", PLANNER, TIMER, 20 * MS)
    recording.add(2, "rclcpp_timer_callback_added", PLANNER, TIMER, ON_TIMER)
    recording.add(2, "rclcpp_timer_link_node", PLANNER, TIMER, NODE)


def plan(recording: Recording, random: Random) -> tuple[list[tuple[int, int]], list[int]]:
    """When the planner executes, in the order of release, and when it publishes to the logger."""
    timers = [(number * 20 * MS, ON_TIMER) for number in range(1, 50)]
    odometry = [(number * 100 * MS + 18 * MS + random.randrange(3 * MS), ON_MESSAGE) for number in range(10)]
    parts, published, now = [], [], 0
    for release, callback in sorted([*timers, *odometry]):
        first = max(release + 20 * US, now)
        least, most = (1000, 2900) if callback == ON_TIMER else (250, 780)
        start, end = first + BEFORE, first + BEFORE + random.randrange(least, most) * US
        recording.call(PLANNER, callback, start, end, release if callback == ON_MESSAGE else 0)
        if callback == ON_MESSAGE:
            recording.publish(end - 20 * US, COMMAND)
            recording.publish(end - 10 * US, LOG)
            published.append(end - 10 * US)
        now = end + AFTER
        parts.append((first, now))
    return parts, published


def log(recording: Recording, random: Random, planner: list[tuple[int, int]], published: list[int]) -> list[tuple[int, int]]:
    """When the logger executes: for each message, while the planner does not."""
    parts = []
    for stamp in published:
        now, left, start = stamp + random.randrange(60, 300) * US, random.randrange(16000, 21000) * US, 0
        while left:
            now = next((end for first, end in planner if first <= now < end), now)
            end = min(now + left, *(first for first, _ in planner if first > now), now + left)
            start = start or now
            if end > now:
                parts.append((now, end))
            left, now = left - (end - now), end
        recording.call(LOGGER, ON_MESSAGE, start + BEFORE, now - AFTER, stamp)
    return parts


def schedule(recording: Recording, planner: list[tuple[int, int]], logger: list[tuple[int, int]]) -> None:
    running = sorted([(*part, "control") for part in planner] + [(*part, "log") for part in logger])
    starts = {start: name for start, _, name in running}
    ends = {end for _, end, _ in running}
    for start, end, name in running:
        if start not in ends:
            recording.switch(start, "swapper/0", name, 0)
        # Where the planner ends a part of the logger, that is preempted and ready; everything else blocks.
        after = starts.get(end, "swapper/0")
        recording.switch(end, name, after, 0 if (name, after) == ("log", "control") else 1)


def main(folder: Path, seed: int = 1) -> None:
    recording, random = Recording(), Random(seed)
    create(recording)
    planner, published = plan(recording, random)
    schedule(recording, planner, log(recording, random, planner, published))
    recording.write(folder)


if __name__ == "__main__":
    target = Path(sys.argv[1])
    shutil.rmtree(target, ignore_errors=True)
    main(target)
