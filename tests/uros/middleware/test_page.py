"""The tables of docs/middlewares.md, computed from the profiles."""

import re

import pytest
from support import ROOT

from amalthea_uros.spec.middleware import Middleware
from amalthea_uros.spec.profiles import ProfileData, SendingData, ThreadData, WaitingData
from amalthea_uros.units import data_size_text, time_text
from amalthea_uros.uros.application.messages import ASKING, MessageKind
from amalthea_uros.uros.profiles import KNOWN, known_data, profile_of

TEXT = (ROOT / "docs" / "middlewares.md").read_text()


def rows(heading):
    """The rows below a heading of a table."""
    table = TEXT[TEXT.index(f"| {heading} |") :].split("\n\n")[0]
    return [tuple(cell.strip() for cell in line.strip("|").split("|")) for line in table.splitlines()[2:]]


def figures(name):
    described = Middleware(profile=name)
    profile = profile_of(described)
    waiting, sending = profile.waiting, profile.sending
    (int32,) = profile.parts(MessageKind.PUBLICATION, 4, reliable=False)
    (reliable,) = profile.parts(MessageKind.PUBLICATION, 4, reliable=True)

    def longest(kind, reliable):
        return f"{profile.largest_content(kind, reliable=reliable)} B"

    def yes(value):
        return "yes" if value else "no"

    return {
        "messages that a wait takes": str(waiting.messages_per_wait or "all"),
        "a wait ends early by up to": time_text(waiting.resolution),
        "messages that are stored end the wait": yes(waiting.stored_data_ends_wait),
        "guard conditions end the wait": yes(waiting.guard_conditions_end_wait),
        "an executor with timers only waits": yes(not waiting.polls_without_messages),
        "timeout of executors by default": time_text(waiting.default_timeout),
        "messages that can be stored": str(waiting.slots or "any number"),
        "a reliable message keeps its sender": f"up to {time_text(sending.timeout)}" if sending.waits else "no",
        "a lost message is asked for after": time_text(sending.resends_after)
        if sending.resends_after
        else "never: the transport does it",
        "a message is dropped when another thread sends": yes(sending.drops_when_busy),
        "several threads may use it": "yes" if sending.is_protected else "with `multithread`",
        "threads of its own": ", ".join(f"`{thread.name}`" for thread in profile.threads) or "none",
        "bytes of an Int32 (4 B) on the wire": str(int32.length),
        "bytes of its acknowledgement": str(reliable.acknowledgement or "none"),
        "longest best-effort message": longest(MessageKind.PUBLICATION, False),
        "longest reliable message to the host": longest(MessageKind.PUBLICATION, True),
        "longest reliable message from the host": longest(MessageKind.DELIVERY, True),
    }


def test_the_figures_of_the_profiles():
    columns = [figures(name) for name in KNOWN]
    assert rows(f"figure | {' | '.join(f'`{name}`' for name in KNOWN)}") == [
        (key, *(column[key] for column in columns)) for key in columns[0]
    ]


def test_the_headers_of_messages():
    described = Middleware()
    profile = profile_of(described)

    def length(kind, content):
        (part,) = profile.parts(kind, content, reliable=True)
        return part.length

    assert rows("message | headers | alignment") == [
        (str(kind), f"{length(kind, 4) - 4} B", "4 B" if length(kind, 5) == length(kind, 8) else "-")
        for kind in MessageKind
        if kind not in ASKING
    ]


def test_all_keys_of_a_profile_are_explained():
    explained = {re.sub(r"`", "", key) for key, _ in rows("key | meaning")}
    sections = {"waiting": WaitingData, "sending": SendingData, "threads": ThreadData}
    keys = {f"{section}.{key}" for section, kind in sections.items() for key in kind.model_fields}
    keys |= ProfileData.model_fields.keys() - sections.keys() - {"amuros"}
    assert explained == keys


@pytest.mark.parametrize("name", KNOWN)
def test_all_sizes_of_a_profile_are_named(name):
    (line,) = re.findall(rf"^\| `{name}` \| (.*) \|$", TEXT, re.MULTILINE)
    assert line.split(", ") == [f"`{size}` {data_size_text(bits)}" for size, bits in known_data(name).sizes.items()]
