"""Mutations of AMALTHEA models: attributes, elements, references, versions."""

from __future__ import annotations

import re
from collections.abc import Callable
from random import Random
from xml.sax.saxutils import quoteattr

from fuzzing import line_mutations
from fuzzing.hostile_values import VALUES

_ATTRIBUTE = re.compile(r"(?<=\s)([\w:.-]+)=(\"[^\"]*\"|'[^']*')")
_REFERENCE = re.compile(r"(?<=[\"/ #])([^\"/ #?]+)\?type=(\w+)")
_NAME = re.compile(r"\bname=\"([^\"]*)\"")
_TAG = re.compile(r"<(/?)([A-Za-z]\w*)")
_VERSION = re.compile(r"(amalthea/)(\d+\.\d+\.\d+)")
_VERSIONS = ("0.9.7", "1.2.0", "2.0.0", "2.2.0", "3.0.0", "3.3.0", "9.9.9")
_INSERTED = (
    "<!-- comment -->",
    "<?pi data?>",
    "<![CDATA[ & ]]>",
    "text",
    "<unknown/>",
    '<customProperties key="k"/>',
    '<commonElements xsi:type="am:Nothing"/>',
)


def _replaced(rng: Random, text: str, pattern: re.Pattern[str], new: Callable[[re.Match[str]], str]) -> str:
    """The text with one of the matches replaced."""
    matches = list(pattern.finditer(text))
    if not matches:
        return text
    match = rng.choice(matches)
    return text[: match.start()] + new(match) + text[match.end() :]


def change_value(rng: Random, text: str) -> str:
    """With another value of an attribute."""
    return _replaced(rng, text, _ATTRIBUTE, lambda match: f"{match[1]}={quoteattr(rng.choice(VALUES))}")


def swap_value(rng: Random, text: str) -> str:
    """With the value of another attribute of the file."""
    values = [match[2] for match in _ATTRIBUTE.finditer(text)]
    return _replaced(rng, text, _ATTRIBUTE, lambda match: f"{match[1]}={rng.choice(values)}")


def drop_attribute(rng: Random, text: str) -> str:
    """Without an attribute."""
    return _replaced(rng, text, _ATTRIBUTE, lambda _: "")


def swap_attribute(rng: Random, text: str) -> str:
    """With the name of another attribute of the file."""
    names = [match[1] for match in _ATTRIBUTE.finditer(text)]
    return _replaced(rng, text, _ATTRIBUTE, lambda match: f"{rng.choice(names)}={match[2]}")


def retarget(rng: Random, text: str) -> str:
    """With a reference to another object of the file, or to one of another type."""
    targets = [match[0] for match in _REFERENCE.finditer(text)]
    return _replaced(
        rng, text, _REFERENCE, lambda match: rng.choice((rng.choice(targets), f"{match[1]}?type=Task", "?type=", ""))
    )


def rename(rng: Random, text: str) -> str:
    """With an object that has the name of another one."""
    names = [match[1] for match in _NAME.finditer(text)]
    return _replaced(rng, text, _NAME, lambda _: f'name="{rng.choice(names)}"')


def swap_tag(rng: Random, text: str) -> str:
    """With the start or end of an element that has the name of another one."""
    tags = [match[2] for match in _TAG.finditer(text)]
    return _replaced(rng, text, _TAG, lambda match: f"<{match[1]}{rng.choice(tags)}")


def insert_content(rng: Random, text: str) -> str:
    """With content that a model rarely has."""
    return _replaced(rng, text, re.compile(r">"), lambda _: f">{rng.choice(_INSERTED)}")


def change_version(rng: Random, text: str) -> str:
    """In the namespace of another version."""
    version = rng.choice(_VERSIONS)
    return _VERSION.sub(rf"\g<1>{version}", text)


MUTATIONS = (
    *(change_value, swap_value) * 3,
    drop_attribute,
    swap_attribute,
    *(retarget,) * 3,
    rename,
    swap_tag,
    insert_content,
    change_version,
    *line_mutations.MUTATIONS,
)
