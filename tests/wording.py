"""Finds words that `wording.yaml` replaces, in pages, and in messages, docstrings, comments and names of the package."""

from __future__ import annotations

import ast
import re
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[1]
WORDS = Path(__file__).with_suffix(".yaml")

FENCE = re.compile(r"^(`{3,})[^\n]*\n.*?^\1", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"`[^`\n]*`|<[^>\n]*>|\]\([^)\n]*\)|https?://\S+")


@dataclass(frozen=True)
class Use:
    """A word that has a better one."""

    path: str
    line: int
    word: str
    better: str

    def __str__(self):
        return f"{self.path}:{self.line}: {self.word!r}: write {self.better}"


class Words:
    """The regular expressions of a section, tried together."""

    def __init__(self, section):
        self.better = [(re.compile(rf"\b(?:{word})\b"), instead) for word, instead in section.items()]
        self.any = re.compile("|".join(rf"\b(?:{word})\b" for word in section))

    def uses(self, text):
        """(Position, word, what is better) of each use."""
        for match in self.any.finditer(text):
            better = next(instead for word, instead in self.better if word.match(text, match.start()))
            yield match.start(), match.group(), better

    @cache  # noqa: B019 - there are few of them
    def use_of(self, name):
        """What is better than a name; None if it may be used."""
        return next((instead for word, instead in self.better if word.fullmatch(name)), None)


@cache
def words():
    """The list."""
    return yaml.safe_load(WORDS.read_text())


@cache
def section(name):
    """A section of the list."""
    return Words(words()[name])


def blank(match):
    """Spaces and line ends instead of a match, so that positions remain."""
    return re.sub(r"[^\n]", " ", match.group())


def uses_in_page(path):
    """The uses in a page, besides its code."""
    text = CODE.sub(blank, FENCE.sub(blank, path.read_text()))
    return [_use(path, text[:at].count("\n") + 1, *found) for at, *found in section("prose").uses(text)]


def uses_in_module(path):
    """The uses in messages, docstrings, comments and names of a module."""
    source, uses = path.read_text(), set()
    for line, text in enumerate(source.splitlines(), start=1):
        if "#" in text:
            uses |= _in_text(path, line, text.partition("#")[2])
    for node in ast.walk(ast.parse(source)):
        match node:
            case ast.Constant(value=str(text)) if " " in text.strip():
                uses |= _in_text(path, node.lineno, text)
            case ast.ClassDef(name=name) | ast.FunctionDef(name=name) | ast.arg(arg=name) | ast.Name(id=name, ctx=ast.Store()):
                if better := section("names").use_of(name):
                    uses.add(_use(path, node.lineno, name, better))
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and (text := ast.get_docstring(node)):
            uses |= {_use(path, node.body[0].lineno, *found) for at, *found in section("openings").uses(text) if at == 0}
    return sorted(uses, key=lambda use: use.line)


def _in_text(path, line, text):
    plain = CODE.sub(blank, text)
    return {_use(path, line + plain[:at].count("\n"), *found) for at, *found in section("prose").uses(plain)}


def _use(path, line, word, better):
    return Use(str(path.relative_to(ROOT)), line, word, better)


def pages():
    """The pages for readers."""
    return [ROOT / "README.md", ROOT / "CHANGELOG.md", *sorted((ROOT / "docs").rglob("*.md"))]


def modules():
    """The modules of the package."""
    exempt = [ROOT / each for each in words()["exempt"]]
    found = sorted((ROOT / "amalthea_uros").rglob("*.py"))
    return [path for path in found if not any(path.is_relative_to(each) for each in exempt)]


def catalogues():
    """The texts of rules and other findings."""
    folders = (ROOT / "amalthea_uros" / room for room in ("findings", "validate"))
    return sorted(path for folder in folders for path in folder.rglob("*.yaml"))


def place(use):
    """What a use is counted for: a page, or the package."""
    return use.path if use.path.endswith(".md") else "amalthea_uros"


def all_uses():
    """Every use."""
    yield from (use for path in pages() for use in uses_in_page(path))
    yield from (use for path in catalogues() for use in uses_in_page(path))
    yield from (use for path in modules() for use in uses_in_module(path))


if __name__ == "__main__":
    chosen = [str(Path(each)) for each in sys.argv[1:]]
    for each in all_uses():
        if not chosen or any(Path(each.path).is_relative_to(where) for where in chosen):
            print(each)  # noqa: T201
