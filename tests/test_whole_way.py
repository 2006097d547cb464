"""Nothing that a player of whole applications observes contradicts the analysis of their descriptions."""

import random

import pytest
from effort import IS_THOROUGH
from whole_player import MS, US, Player, S

from amalthea_uros.analyze.system import analyze_system
from amalthea_uros.spec.transports import CanFd
from amalthea_uros.uros.described import describe_content
from amalthea_uros.uros.transports.can import CanFdLine

SEEDS = range(5000 if IS_THOROUGH else 12)
BLOCK = 12
ACKNOWLEDGEMENT = 13
#: The player counts in whole picoseconds, which a message need not take.
ROUNDING = 10_000


def between(chance, low, high):
    first, second = sorted((chance.randint(low, high), chance.randint(low, high)))
    return first, second


def span(times):
    return {"min": f"{times[0]} ps", "max": f"{times[1]} ps"}


def drawn(chance):
    """The content of a description, and what the player needs to know of it."""
    wire = chance.choice(("serial", "serial", "serial", "udp", "tcp", "usb_cdc", "custom", "can_fd"))
    loop = chance.choice(("spin_some", "spin_some", "spin_period", "spin"))
    plan = {
        "wire": wire,
        "loop": loop,
        "priority": 50,
        "timeout": chance.choice((0, 1, 2, 10, 100)) * MS,
        "sleep": chance.choice((0, 1, 2, 5, 10)) * MS if loop == "spin_some" else 0,
        "overhead": chance.choice((10, 50, 200)) * US,
        "take": chance.choice((5, 50)) * US,
        "semantics": chance.choice(("ROS", "LET")),
        "to_controller": between(chance, 0, 5 * MS),
        "to_host": between(chance, 0, 5 * MS),
        "acknowledgement": between(chance, 0, 5 * MS),
        "waits": chance.random() < 0.8,
        "blocks": chance.random() < 0.7,
        "slots": 8,
        "tick": 1 * MS if wire in ("serial", "udp") and chance.random() < 0.3 else 0,
        "link": (0, 0),
        "stages": [],
        "foreign": [],
        "begin": chance.randrange(20 * MS),
    }
    if loop == "spin":
        plan["timeout"] = max(plan["timeout"], MS)
    executor = {
        "name": "Executor",
        "priority": 50,
        "execution_time": {"base": f"{plan['overhead']} ps", "per_message": f"{plan['take']} ps"},
        "semantics": plan["semantics"],
    }
    if loop == "spin_some":
        executor["loop"] = {"spin_some": f"{plan['timeout']} ps", "sleep": f"{plan['sleep']} ps"}
    elif loop == "spin":
        executor["loop"] = {"spin": f"{plan['timeout']} ps"}
    else:
        plan["period"], plan["timeout"] = chance.choice((5, 10, 20)) * MS, max(plan["timeout"], MS)
        executor["loop"] = {"spin_period": f"{plan['period']} ps", "timeout": f"{plan['timeout']} ps"}
    section = transport(chance, plan)
    subscriptions, timers, publishers = callbacks(chance, plan)
    tasks = plan["tasks"] = []
    for name, priority, reads in (("Load", 60, None), ("Pwm", chance.choice((40, 70)), "command")):
        if name == "Load" and chance.random() < 0.5:
            continue
        period = chance.choice((2, 5, 10)) * MS
        task = {"name": name, "period": period, "priority": priority, "cost": between(chance, 2 * US, period // 8)}
        tasks.append({**task, "reads": reads})
    reliable = {} if plan["waits"] else {"reliable": {"waits": False}}
    first = plan["handles"][0]
    chains = [
        {"name": "On_0-motor", "path": [first["topic"], "On_0", "command"]},
        {"name": "Pwm", "path": [first["topic"], "On_0", "command", "Pwm"]},
        {"name": "Control_0-motor", "path": [first["topic"], "On_0", "Control_0", "motor"]},
    ]
    for handle in plan["handles"]:
        if handle["name"] not in ("On_0", "Control_0"):
            continue
        for topic, *_ in handle["publishes"]:
            path = [first["topic"], *dict.fromkeys(("On_0", handle["name"])), f"/{topic}"]
            chains.append({"name": f"{handle['name']}-{topic}", "path": path})
    content = {
        "amuros": 1,
        "name": "drawn",
        "hardware": {"platform": "single-core", "frequency": "1000 GHz"},
        "os": {"tick": "1 ms"},
        "middleware": {
            "executor": executor,
            "transport": {wire: section},
            "agent": {key: span(plan[key]) for key in ("to_controller", "to_host", "acknowledgement")},
            **reliable,
        },
        "application": {
            "nodes": [{"name": "node", "subscriptions": subscriptions, "timers": timers, "publishers": publishers}]
        },
        "tasks": [
            {
                "name": task["name"],
                "period": f"{task['period']} ps",
                "priority": task["priority"],
                "execution_time": span(task["cost"]),
                **({"reads": [task["reads"]]} if task["reads"] else {}),
            }
            for task in tasks
        ],
        "labels": {"command": "4 B", "motor": "4 B"},
        "chains": chains,
    }
    return content, plan


def transport(chance, plan):
    """The section of the wire."""
    wire, section = plan["wire"], {}
    if chance.random() < 0.5:
        cost = chance.choice((2, 20)) * US
        plan["stages"].append(((cost, cost), 200))
        section["interrupt"] = {"name": "Receive", "execution_time": f"{cost} ps", "priority": 5}
    if wire == "serial":
        plan["rate"] = chance.choice((115200, 921600))
        section["baud_rate"] = plan["rate"]
    elif wire in ("udp", "tcp"):
        plan["rate"], plan["link"] = chance.choice((10, 100)) * 1_000_000, between(chance, 0, 2 * MS)
        section |= {"bitrate": f"{plan['rate']} bit/s", "latency": span(plan["link"])}
    elif wire == "usb_cdc":
        plan["rate"], plan["link"] = 12_000_000, between(chance, 0, 2 * MS)
        section["latency"] = span(plan["link"])
    elif wire == "custom":
        # Wires are counted in whole nanoseconds.
        plan["transfer"] = tuple(time // 1000 * 1000 for time in between(chance, 1 * US, 3 * MS))
        section["table"] = [{"size": "512 B", "time": span(plan["transfer"])}]
    else:
        section |= {"bitrate": "500 kbit/s", "data_bitrate": "2 Mbit/s"}
        names = [f"foreign_{number}" for number in range(chance.randrange(3))]
        section["foreign"] = [
            {"name": name, "identifier": 16 + number, "bytes": 8, "period": f"{chance.choice((5, 20))} ms"}
            for number, name in enumerate(names)
        ]
    if plan["tick"]:
        section["driver"] = {"write": "dma", "read": "dma"}
        plan["blocks"] = True
    return section


def callbacks(chance, plan):
    """The sections of callbacks and publishers; the plan gets the handles in the order of the executor."""
    subscriptions, timers, publishers, found = [], [], [], []
    for number in range(chance.randint(1, 3)):
        handle = {
            "kind": "subscription",
            "name": f"On_{number}",
            "topic": f"in_{number}",
            "period": chance.choice((20, 50, 100, 200)) * MS,
            "size": chance.choice((4, 24, 40)),
            "reliable": chance.random() < 0.3,
            "depth": chance.choice((1, 5)),
            "cost": between(chance, 5 * US, chance.choice((100 * US, 2 * MS))),
            "publishes": [],
            "writes": "command" if number == 0 else None,
        }
        found.append(handle)
        subscriptions.append(
            {
                **_callback(handle),
                "topic": handle["topic"],
                "interval": f"{handle['period']} ps",
                "message_size": f"{handle['size']} B",
                "reliability": "reliable" if handle["reliable"] else "best-effort",
                "depth": handle["depth"],
            }
        )
    for number in range(chance.randint(1, 2)):
        handle = {
            "kind": "timer",
            "name": f"Control_{number}",
            "period": chance.choice((10, 20, 50, 100)) * MS,
            "cost": between(chance, 5 * US, chance.choice((100 * US, 2 * MS))),
            "publishes": [],
            "writes": "motor" if number == 0 else None,
        }
        found.append(handle)
        timers.append({**_callback(handle), "period": f"{handle['period']} ps"})
        if number == 0:
            timers[-1]["reads"] = ["command"]
    sections = {section["name"]: section for section in (*subscriptions, *timers)}
    for number in range(chance.randint(1, 3)):
        handle, size, reliable = chance.choice(found), chance.choice((4, 20, 36)), chance.random() < 0.4
        topic = f"out_{number}"
        handle["publishes"].append((topic, size, reliable))
        publishers.append(
            {"topic": topic, "message_size": f"{size} B", "reliability": "reliable" if reliable else "best-effort"}
        )
        sections[handle["name"]].setdefault("publishes", []).append(topic)
    for handle in found:
        handle["phase"] = plan["begin"] + chance.randrange(handle["period"])
    plan["handles"] = found
    return subscriptions, timers, publishers


def _callback(handle):
    section = {"name": handle["name"], "execution_time": span(handle["cost"])}
    return {**section, "writes": [handle["writes"]]} if handle["writes"] else section


def prepared(content, plan):
    """What the player takes from the wire model, whose frames are proved elsewhere: times of CAN FD frames, and foreign ones."""
    if plan["wire"] != "can_fd":
        return
    line = CanFdLine(section=CanFd.model_validate(content["middleware"]["transport"]["can_fd"]))
    ticks = line.ticks_per_second

    def time(frame):
        return frame.least * S // ticks, frame.most * S // ticks

    sizes = {ACKNOWLEDGEMENT, *(12 + each["size"] for each in plan["handles"] if each["kind"] == "subscription")}
    sizes |= {8 + -(-(4 + size) // 4) * 4 for each in plan["handles"] for _, size, _ in each["publishes"]}
    plan["frame_times"] = {size: time(line.frames(size, None)[0]) for size in sizes}
    for frame in content["middleware"]["transport"]["can_fd"]["foreign"]:
        period = int(frame["period"].split()[0]) * MS
        plan["foreign"].append({"period": period, "time": time(line.foreign(frame["bytes"], extended=False))})


def contradictions(seed, until=S):
    """What a run contradicts; and how many bounds it was compared with."""
    chance = random.Random(seed)
    content, plan = drawn(chance)
    assembly = describe_content(content).assembly
    analysis = analyze_system(assembly.system)
    prepared(content, plan)
    player = Player(plan, chance)
    seen = player.play(until)
    found, compared = [], [0]

    def at_most(what, observed, bound):
        if bound is None:
            return
        compared[0] += 1
        if observed and max(observed) > bound + ROUNDING:
            found.append(f"{what}: {max(observed) / MS:.4f} ms observed, at most {bound / MS:.4f} ms")

    (executor,) = analysis.executors
    for handle in executor.handles:
        at_most(f"response of {handle.name}", seen.responses[handle.name], handle.response.worst)
        if seen.responses[handle.name] and min(seen.responses[handle.name]) + ROUNDING < handle.response.best:
            found.append(f"{handle.name} is faster than {handle.response.best}")
        if handle.lateness is not None:
            at_most(f"lateness of {handle.name}", seen.lateness[handle.name], handle.lateness.most)
        if handle.name in seen.lost and handle.lost is None and executor.reason == "" and handle.response.worst is not None:
            found.append(f"{handle.name} loses something")
    processes = {each.name: each for each in analysis.processes}
    for name, times in seen.sent.items():
        result = processes[name]
        at_most(f"{name} on the wire", times, result.response.worst if result.response else None)
    for way in analysis.message_chains:
        end = "On_0-command" if way.name == "On_0-motor" else way.name
        end = end if end in ("On_0-command", "Pwm", "Control_0-motor") else end.replace("-", "-/")
        outputs = player.pending_outputs[end]
        times = []
        for (name, number), published in player.published.items():
            if name != "On_0":
                continue
            later = [time for value, time in outputs if value[0] >= number]
            if later:
                times.append(min(later) - published)
                if min(later) - published + ROUNDING < way.best:
                    found.append(f"{way.name}: {(min(later) - published) / MS} ms is faster than {way.best / MS}")
            else:
                times.append(until - published)
        at_most(f"way {way.name}", times, way.worst)
    return found, compared[0], content


@pytest.mark.parametrize("block", range(0, len(SEEDS), BLOCK))
def test_no_observation_contradicts_a_bound(block):
    compared = 0
    for seed in SEEDS[block : block + BLOCK]:
        found, count, content = contradictions(seed)
        assert not found, (seed, found, content)
        compared += count
    assert compared > 20, "hardly anything has a bound"
