"""Small models of old versions inside tests of migration steps."""

from migration import meaning, migrated, model, opened


def written(folder, version, *contents):
    """Write files of a version into a new folder, each with some content of the root."""
    folder = folder / str(len(list(folder.iterdir())))
    folder.mkdir()
    paths = []
    for number, content in enumerate(contents):
        paths.append(folder / f"m{number}.amxmi")
        paths[-1].write_text(model(version, content), "utf-8")
    return paths


def check_step(folder, source, target, before, after, official=False):
    """Assert what one file or several become, and give the notes of it."""
    before, after = ([texts] if isinstance(texts, str) else texts for texts in (before, after))
    models, notes = migrated(written(folder, source, *before), target, official)
    assert meaning(models) == meaning(opened(*written(folder, target, *after)))
    return notes


def text_property(key, value):
    """A custom property with a text."""
    return f'<customProperties key="{key}"><value xsi:type="am:StringObject" value="{value}"/></customProperties>'


def of_kind(notes, kind):
    """Message and detail of the notes of a kind."""
    return [(note.message, note.detail) for note in notes if note.kind is kind]
