"""Random descriptions of one thread on a wire that loses a stated number of messages."""

from __future__ import annotations

from random import Random

from opponent.executors.descriptions import MS, Section, latency, random_description

_WIRES = frozenset({"serial", "usb_cdc", "udp", "tcp", "custom"})
_PERIODS = (50, 100, 200, 400)


def description_with_losses(seed: int) -> Section:
    """A random description with slow messages, losses, and sometimes a loop that pings, too."""
    content, chance = _of_one_thread(seed), Random(f"losses {seed}")
    middleware = content["middleware"]
    middleware.pop("reliable", None)
    _without_what_has_no_bound(content)
    middleware["agent"] = {key: latency(chance, 2 * MS) for key in ("to_controller", "to_host", "acknowledgement")}
    middleware["limits"] = {
        "RMW_UXRCE_STREAM_HISTORY": chance.choice((2, 4, 8, 16)),
        "UCLIENT_MIN_HEARTBEAT_TIME_INTERVAL": f"{chance.choice((5, 20, 100))} ms",
    }
    seconds = chance.choice((1, 2, 4))
    rate = f"{chance.choice((1, 1, 1, 2))} per {seconds} s"
    middleware["transport"]["losses"] = chance.choice((rate, rate, {"to_controller": rate}, {"to_agent": rate}))
    for sections in content["application"]["nodes"][0].values():
        for section in (each for each in sections if isinstance(sections, list)):
            for key in {"interval", "period"} & section.keys():
                section[key] = f"{chance.choice(_PERIODS) * 1000 + chance.choice((0, 137))} us"
    (executor,) = middleware["executors"]
    if "spin_some" in executor["loop"] and chance.random() < 0.3:
        ping: Section = {"ping": f"{chance.choice((5, 50))} ms", "attempts": chance.choice((1, 1, 2)), "every": "200 ms"}
        sleep = executor["loop"].pop("sleep", "1 ms")
        executor["loop"] = [executor["loop"], ping, {"sleep": sleep}]
    return content


def _of_one_thread(seed: int) -> Section:
    while True:
        content = random_description(seed)
        if len(content["middleware"]["executors"]) == 1 and _WIRES & content["middleware"]["transport"].keys():
            return content
        seed += 1_000_000


def _without_what_has_no_bound(content: Section) -> None:
    """Leave out what makes unknown how often messages are sent again: bare loops, clients, callbacks with their own tasks."""
    (executor,), node = content["middleware"]["executors"], content["application"]["nodes"][0]
    if "sleep" not in executor["loop"]:
        executor["loop"] = {"spin_some": "10 ms", "sleep": "2 ms"}
    for client in node.pop("clients", ()):
        content["chains"] = [each for each in content["chains"] if client["name"] not in each["path"]]
        for section in (each for sections in node.values() if isinstance(sections, list) for each in sections):
            section["requests"] = [name for name in section.get("requests", ()) if name != client["name"]]
        for key in ("order", "trigger"):
            executor.pop(key, None)
        content["requirements"] = [each for each in content["requirements"] if each["process"] != client["name"]]
    for section in (each for sections in node.values() if isinstance(sections, list) for each in sections):
        section.pop("runs_in", None)
        if not section.get("requests", True):
            section.pop("requests")
        for key in ("message_size", "request_size", "response_size"):
            if section.get(key) == "400 B":
                section[key] = "120 B"
