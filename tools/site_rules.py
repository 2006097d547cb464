"""A page for each kind of finding, rules included; `validate.registry.rule_url` gives its address."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.findings import catalogue
from amalthea_uros.findings.kind import FindingKind
from amalthea_uros.validate import registry
from amalthea_uros.validate.rule import RuleProfile

#: Families of findings whose examples are logs.
_TRACES = ("CAN", "TRC")


def rule_pages() -> Iterator[tuple[str, str]]:
    """Path and text of each page; rules of users have none."""
    built_in = (profile for profile in RuleProfile if profile is not RuleProfile.USER)
    for identifier in (*registry.ids(built_in), *catalogue.ids()):
        kind = registry.kind(identifier)
        assert kind is not None
        yield f"rules/{identifier}.md", _page(kind)


def _page(kind: FindingKind) -> str:
    return (
        "\n\n".join([f"# {kind.id}", f"**{kind.title}** ({kind.severity})", *_origin(kind), *_text(kind), *_examples(kind)])
        + "\n"
    )


def _origin(kind: FindingKind) -> Iterator[str]:
    top = "../" * (kind.id.count("/") + 1)
    if (profile := registry.profile_of(kind.id)) is not None:
        yield f"A rule of the profile [`{profile}`]({top}rules/{profile}.md) of `amuros check`."
    else:
        family = kind.id[:3]
        page = f"{top}findings/{family.lower()}.md"
        yield f"A [finding]({page}) that is reported without being asked for: {catalogue.FAMILIES[family].lower()}."


def _text(kind: FindingKind) -> Iterator[str]:
    yield f"## Why it matters\n\n{kind.rationale}"
    yield f"## What to do\n\n{kind.remedy}"
    yield f"On the command line: `amuros explain {kind.id}`."


def _examples(kind: FindingKind) -> Iterator[str]:
    if kind.beside is not None:
        yield _example("With another file of the model", kind.beside)
    if kind.fails:
        yield _example("Fails", kind.fails, "text" if kind.id[:3] in _TRACES else "yaml")
    if kind.passes:
        yield _example("Passes", kind.passes)


def _example(title: str, text: str, other: str = "yaml") -> str:
    language = "xml" if text.lstrip().startswith("<") else other
    return f"## {title}\n\n```{language}\n{text.strip(chr(10)).rstrip()}\n```"
