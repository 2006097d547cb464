"""Small models written inline, migrated and compared by meaning."""

from migration import meaning, migrated, model, opened


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
        folder = self.folder / where
        folder.mkdir(exist_ok=True)
        paths = [folder / f"{number}.amxmi" for number in range(len(contents))]
        for path, content in zip(paths, contents, strict=True):
            path.write_text(model(version, content), encoding="utf-8")
        return paths

    def migrate(self, source, target, *contents, official=False):
        """The meaning of files after migration."""
        models, self.notes = migrated(self.files("before", source, *contents), target, official)
        return meaning(models)

    def read(self, version, *contents):
        """The meaning of files as they are."""
        return meaning(opened(*self.files("expected", version, *contents)))

    def messages(self, kind):
        """What was noted of one kind."""
        return [note.message for note in self.notes if note.kind == kind]
