"""Migrated files written, all of a set or none."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from amalthea_uros._internal.files import is_file, is_stream, resolved
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import WriteError
from amalthea_uros.services.migrated_paths import Destination
from amalthea_uros.services.migration import FileState, MigratedFile
from amalthea_uros.xmi.files import ZIP_ENTRY, FileText, write_texts
from amalthea_uros.xmi.migrate.load import MigratedSet
from amalthea_uros.xmi.migrate.versions import migrated_name


class Writer:
    """Writes the files of one set after the other."""

    def __init__(self, goal: Destination, force: bool, compress: bool | None, is_dry_run: bool) -> None:
        self.goal, self.force, self.compress, self.is_dry_run = goal, force, compress, is_dry_run
        #: What was written, and from which file, so that no two files become one.
        self.taken: dict[Path, Path] = {}

    def write(self, migrated: MigratedSet) -> list[MigratedFile]:
        """Write all files of a set or none.

        Raises
        ------
        ReadError, WriteError : it cannot be written.
        """
        trees = migrated.models.trees
        state = FileState.PLANNED if self.is_dry_run else FileState.WRITTEN
        done: list[MigratedFile] = []
        contents: dict[Path, FileText] = {}
        removed: list[Path] = []
        for place, (tree, text, version) in enumerate(zip(trees, migrated.texts(), migrated.versions, strict=True)):
            name = migrated_name(tree.path.name, migrated.target)
            target = self.goal.target(tree.path, name, has_others=len(trees) > 1)
            if migrated.is_unchanged(place) and self.goal.leaves_what_is_unchanged(tree.path):
                done.append(MigratedFile(path=tree.path, version=version, target=None, state=FileState.AS_IS))
                continue
            self.claim(target, tree.path)
            contents[target] = self.packed(text)
            if self.goal.in_place and target != tree.path:
                removed.append(tree.path)
            done.append(MigratedFile(path=tree.path, version=version, target=target, state=state))
        if not self.is_dry_run:
            self.goal.make_folders(contents)
            write_texts(contents, removed)
        return done

    def claim(self, target: Path, source: Path) -> None:
        """Refuse to write a file twice, or over a file that exists."""
        place = resolved(target)
        other = self.taken.setdefault(place, source)
        if other != source:
            message = f"two files would be written here: {other} and {source}"
            help_text = "Migrate them one by one, or rename one of them."
            raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(target), help_text)])
        is_itself = self.goal.in_place and place == resolved(source)
        if is_file(target) and not is_stream(target) and not self.force and not is_itself:
            message = "the file exists already"
            help_text = "Use --force to overwrite it, --in-place to replace the old file, or write to another place with -o."
            raise WriteError([Finding("XMI101", Severity.ERROR, message, Location(target), help_text)])

    def packed(self, text: FileText) -> FileText:
        """The content, zipped or not as it is wanted."""
        if self.compress is None:
            return text
        return replace(text, zip_entry=(text.zip_entry or ZIP_ENTRY) if self.compress else None)
