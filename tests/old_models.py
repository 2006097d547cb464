"""Small models of versions 0.7.0 to 0.8.0, and what the migration makes of them."""

from migration import meaning, migrated, model


class Migrated:
    """The result of a migration.

    Attributes
    ----------
    text : what the files mean afterwards
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


def migrate(folder, source, target, *contents, official=False, root="Amalthea"):
    """Migrate the contents of one or more files."""
    paths = []
    for number, content in enumerate(contents):
        path = folder / f"{chr(97 + number)}.amxmi"
        path.write_text(model(source, content, root), encoding="utf-8")
        paths.append(path)
    return Migrated(*migrated(paths, target, official=official))
