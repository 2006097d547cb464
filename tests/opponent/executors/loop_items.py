"""Random descriptions in which threads do more than spin: loops as lists of executors, publications, pings, sleeps and busy waits."""

from __future__ import annotations

from random import Random

from opponent.executors.descriptions import Section, random_description


def description_with_items(seed: int) -> Section:
    """A random description, one loop of which is a list; perhaps a thread besides that only sends."""
    content, chance = random_description(seed), Random(f"items {seed}")
    middleware = content["middleware"]
    owner, *others = middleware["executors"]
    topics = _own_topics(chance, content)
    items: list[Section] = [{"spin_some": _timeout(chance)}]
    for other in others:
        if chance.random() < 0.5:
            items.append({"spin_some": _timeout(chance), "executor": other["name"]})
            other.pop("loop"), other.pop("priority")
    items += [_sent(chance, topics) for _ in range(chance.choice((0, 1, 1, 2, 3)))]
    items += [chance.choice(({"sleep": f"{chance.choice((1, 2, 5))} ms"}, {"busy_wait": f"{chance.choice((100, 1000))} us"}))]
    if chance.random() < 0.6:
        items.append({"sleep": f"{chance.choice((1, 2, 5, 10))} ms"})
    chance.shuffle(items)
    owner["loop"] = items
    if chance.random() < 0.2:
        sent = [_sent(chance, topics) for _ in range(chance.choice((1, 2)))]
        sender = {
            "name": "Sender",
            "priority": chance.choice((20, 70)),
            "loop": [*sent, {"sleep": f"{chance.choice((5, 20))} ms"}],
        }
        middleware["executors"].append(sender)
        middleware["multithread"] = True
    return content


def _timeout(chance: Random) -> str:
    return f"{chance.choice((0, 1, 2, 10, 20))} ms"


def _own_topics(chance: Random, content: Section) -> list[str]:
    """Topics that only loops publish, and those of callbacks; not those that come back, whose interval is that of a timer."""
    node = content["application"]["nodes"][0]
    received = {each["topic"] for each in node.get("subscriptions", ())}
    for number in range(chance.choice((1, 2))):
        publisher = {"topic": f"loop{number}", "message_size": f"{chance.choice((4, 24))} B"}
        if chance.random() < 0.6:
            publisher["reliability"] = "best-effort"
        node["publishers"].append(publisher)
    return [each["topic"] for each in node["publishers"] if each["topic"] not in received]


def _sent(chance: Random, topics: list[str]) -> Section:
    match chance.choice(("publish", "publish", "ping", "sync")):
        case "publish":
            item: Section = {"publish": chance.sample(topics, min(len(topics), chance.choice((1, 1, 2))))}
        case "ping":
            item = {"ping": f"{chance.choice((2, 10, 100))} ms"}
            if chance.random() < 0.2:
                item["attempts"] = chance.choice((2, 3))
        case _:
            item = {"sync": f"{chance.choice((2, 10, 100))} ms"}
    if chance.random() < 0.4:
        item["every"] = f"{chance.choice((10, 50, 200))} ms"
    return item
