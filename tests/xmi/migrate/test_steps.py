"""Steps of a migration, stated in steps/*.txt as differences between the model before and after.

A line `from A to B` states the versions of a file or of one case, `== TITLE` starts a case, `--` the next one of the same title,
and `file` the next file of the model. Lines of the model are in both versions, or after "-" in the old one only, or after "+" in the
new one only. `early` versions are those that files of old content may declare, because their namespace was raised too soon.
`KIND MESSAGE | DETAIL` is one of the notes, `only KIND ...` lines are all notes of the kind, `no KIND` means that there is none, and
`2 KIND` that there are two.
"""

from dataclasses import dataclass, field
from pathlib import Path

import pytest
from effort import every
from inline_models import damaged, written
from migration import meaning, migrated, opened

from amalthea_uros.xmi.migrate.chain import migrate
from amalthea_uros.xmi.tree.notes import NoteKind, StepNotes
from amalthea_uros.xmi.tree.results import tree_text


@dataclass
class Step:
    """A case: the contents of the files before and after, and what is stated of the notes."""

    name: str
    versions: tuple[str, str]
    before: list[str] = field(default_factory=lambda: [""])
    after: list[str] = field(default_factory=lambda: [""])
    notes: list[str] = field(default_factory=list)
    early: list[str] = field(default_factory=list)


def read_steps(path):
    """The cases of a file."""
    first, *lines = path.read_text("utf-8").splitlines()
    steps: list[Step] = []
    for line in lines:
        mark, text = line[:2], line[2:].strip()
        if mark == "==":
            steps.append(Step(f"{path.stem}: {text}", versions_of(first)))
        elif mark == "--":
            steps.append(Step(steps[-1].name, versions_of(first)))
        elif line.startswith("from "):
            steps[-1].versions = versions_of(line)
        elif line.startswith("early "):
            steps[-1].early = line.split()[1:]
        elif line == "file":
            steps[-1].before.append("")
            steps[-1].after.append("")
        elif mark in ("  ", "- ", "+ "):
            if mark != "+ ":
                steps[-1].before[-1] += text
            if mark != "- ":
                steps[-1].after[-1] += text
        elif line and mark != "# ":
            steps[-1].notes.append(line)
    return steps


def versions_of(line):
    """The versions of "from 0.9.2 to 0.9.3"."""
    source, _, target = line.removeprefix("from ").partition(" to ")
    return source, target


STEPS = [step for path in sorted((Path(__file__).parent / "steps").glob("*.txt")) for step in read_steps(path)]


@pytest.mark.parametrize("step", STEPS, ids=[step.name for step in STEPS])
def test_a_step(step, tmp_path):
    source, target = step.versions
    models, notes = migrated(written(tmp_path, source, *step.before), target)
    assert meaning(models) == meaning(opened(*written(tmp_path, target, *step.after)))
    only: dict[str, list[str]] = {}
    for line in step.notes:
        quantity, _, rest = line.partition(" ")
        if quantity == "no":
            only[rest] = []
            continue
        if quantity.isdigit():
            assert len(stated(notes, rest, False)) == int(quantity)
            continue
        kind, _, text = (rest if quantity == "only" else line).partition(" ")
        if quantity == "only":
            only.setdefault(kind, []).append(text)
        else:
            assert text in stated(notes, kind, " |" in text)
    for kind, texts in only.items():
        assert stated(notes, kind, any(" |" in text for text in texts)) == texts


def stated(notes, kind, with_details):
    """The notes of a kind, as they are written in a file of steps."""
    return [
        f"{note.message} | {note.detail}".rstrip() if with_details else note.message for note in notes if note.kind.name == kind
    ]


@pytest.mark.parametrize("step", [step for step in STEPS if step.early], ids=lambda step: step.name)
def test_a_file_whose_namespace_was_raised_early_takes_the_step(step, tmp_path):
    source, target = step.versions
    for declared in step.early:
        early, _ = migrated(written(tmp_path, declared, *step.before), max(target, declared))
        proper, _ = migrated(written(tmp_path, source, *step.before), max(target, declared))
        assert meaning(early) == meaning(proper)


@pytest.mark.parametrize("step", [step for step in STEPS if not step.name.startswith("back")], ids=lambda step: step.name)
def test_what_is_converted_stays(step, tmp_path):
    source, target = step.versions
    models, _ = migrated(written(tmp_path, source, *step.before), target)
    expected = meaning(models)
    for tree in models.trees:
        tree.version = source
    notes = StepNotes()
    migrate(models, target, notes)
    assert meaning(models) == expected
    assert not [note for note in notes.all if note.kind in (NoteKind.CONVERTED, NoteKind.MOVED, NoteKind.KEPT)]


#: Steps back of which the step up restores what has no place in the older version.
RESTORED = (("3.0.0", "2.2.0"), ("2.0.0", "1.2.0"))


@pytest.mark.parametrize("step", [step for step in STEPS if step.versions in RESTORED], ids=lambda step: step.name)
def test_what_a_step_back_does_not_lose_comes_back(step, tmp_path):
    source, target = step.versions
    newer = written(tmp_path, source, *step.before)
    models, notes = migrated(newer, target)
    if not any(note.kind is NoteKind.LOST for note in notes):
        older = written(tmp_path, target, *step.before)
        for path, tree in zip(older, models.trees, strict=True):
            path.write_text(tree_text(tree), "utf-8")
        restored, notes = migrated(older, source)
        assert not any(note.kind is NoteKind.LOST for note in notes)
        assert meaning(restored) == meaning(opened(*newer))


@pytest.mark.parametrize("step", STEPS, ids=[step.name for step in STEPS])
def test_damaged_files_are_migrated(step, tmp_path):
    source, target = step.versions
    values = ["", "0", "x", "T?type=Task", "gone?type=Label gone?type=Core"]
    for number in every(6, range(6)):
        migrated(written(tmp_path, source, *(damaged(text, values, number) for text in step.before)), target)
