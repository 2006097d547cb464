"""Small models of APP4MC inside tests, and what migrations make of them."""

import random
import re

from itea import model as itea_model
from migration import meaning, migrated, model, opened

# Files


def written(folder, version, *contents, root="Amalthea"):
    """Write files of a version into a new folder, each with some content of the root."""
    folder = folder / str(len(list(folder.iterdir())))
    folder.mkdir()
    paths = []
    for number, content in enumerate(contents):
        paths.append(folder / f"m{number}.amxmi")
        _, mark, number = version.partition("ITEA ")
        text = itea_model(number, content.replace(' t="', ' xsi:type="')) if mark else model(version, content, root)
        paths[-1].write_text(text, "utf-8")
    return paths


def text_property(key, value):
    """A custom property with a text."""
    return f'<customProperties key="{key}"><value t="StringObject" value="{value}"/></customProperties>'


def damaged(content, values, seed):
    """A copy of a content in which up to six attributes are missing or have one of some values instead."""
    rng = random.Random(seed)
    pieces = re.findall(r' [\w:]+="[^"]*"', content)
    for piece in rng.sample(pieces, min(6, len(pieces))):
        name = piece.partition("=")[0]
        content = content.replace(piece, rng.choice(["", f'{name}="{rng.choice(values)}"']), 1)
    return content


# Checks


def check_step(folder, source, target, before, after):
    """Assert what one file or several become, and give the notes of it."""
    before, after = ([texts] if isinstance(texts, str) else texts for texts in (before, after))
    models, notes = migrated(written(folder, source, *before), target)
    assert meaning(models) == meaning(opened(*written(folder, target, *after)))
    return notes


def of_kind(notes, kind):
    """Message and detail of the notes of a kind."""
    return [(note.message, note.detail) for note in notes if note.kind is kind]


# Results


class Migrated:
    """The result of a migration.

    Attributes
    ----------
    text : what the files mean afterwards
    lines : the lines of that, without indentation
    notes : kind, message and detail of each note
    """

    def __init__(self, models, notes):
        self.models = models
        self.text = "\n".join(meaning(models))
        self.lines = [" ".join(line.split()) for line in self.text.splitlines()]
        self.notes = [(note.kind.name, note.message, note.detail) for note in notes]

    def of(self, kind):
        """The messages of a kind."""
        return [message for found, message, _ in self.notes if found == kind]


def migrate(folder, source, target, *contents, root="Amalthea"):
    """Migrate the contents of one or more files."""
    return Migrated(*migrated(written(folder, source, *contents, root=root), target))


class InlineModels:
    """Writes models into a folder and migrates them.

    Attributes
    ----------
    notes : of the last migration
    """

    def __init__(self, folder):
        self.folder = folder
        self.notes = []

    def files(self, where, version, *contents):
        """Write files into a folder of that name."""
        folder = self.folder / where
        folder.mkdir(exist_ok=True)
        return written(folder, version, *contents)

    def migrate(self, source, target, *contents):
        """The meaning of files after migration."""
        models, self.notes = migrated(self.files("before", source, *contents), target)
        return meaning(models)

    def read(self, version, *contents):
        """The meaning of files as they are."""
        return meaning(opened(*self.files("expected", version, *contents)))

    def messages(self, kind):
        """What was noted of one kind."""
        return [note.message for note in self.notes if note.kind == kind]


#: The head of a robot: everything takes the same time always, and each loop waits whenever a message arrives.
LOOPING_CONTROLLER = """
amuros: 1
name: robot
controllers:
  - name: a
    hardware: &hardware {platform: single-core, frequency: 1 GHz}
    middleware: &middleware
      executor: {name: E, priority: 1, loop: {spin: 1 s}, execution_time: {base: 10 us, per_message: 5 us}}
      limits: {RMW_UXRCE_MAX_HISTORY: 64}
      reliable: {waits: false}
      transport: {udp: {bitrate: 100 Mbit/s, latency: 2 ms}}
      agent: {to_controller: 500 us, to_host: 500 us, acknowledgement: 500 us}
"""
