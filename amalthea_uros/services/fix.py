"""What rules find, repaired where there is only one way to do so."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from pathlib import Path

from amalthea_uros._internal.files import reading_once
from amalthea_uros._internal.paths import StrPath, by_model, is_description, without_other_yaml
from amalthea_uros._internal.records import dataclass
from amalthea_uros.metamodel.model import Model
from amalthea_uros.services.check import selection_of
from amalthea_uros.services.files import FileChange
from amalthea_uros.services.inputs import as_paths
from amalthea_uros.validate import registry
from amalthea_uros.validate.engine import repair
from amalthea_uros.validate.rule import ModelCheck
from amalthea_uros.validate.settings import CheckSettings, project_settings
from amalthea_uros.xmi.load import load


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelRepairs:
    """What was repaired in the files of one model.

    Attributes
    ----------
    repaired : the number of objects by the id of the rule
    changed : the files with their texts before and after
    """

    paths: tuple[Path, ...]
    repaired: Mapping[str, int]
    changed: tuple[FileChange, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class FixResult:
    """What was repaired.

    Attributes
    ----------
    descriptions : the files that were not repaired, since only their authors know what is meant
    older : the files of models that have to be migrated first, with their AMALTHEA version
    is_written : whether the repairs are in the files
    """

    models: tuple[ModelRepairs, ...]
    descriptions: tuple[Path, ...]
    older: tuple[tuple[Path, str], ...] = ()
    is_written: bool = True

    @property
    def changed(self) -> tuple[FileChange, ...]:
        """The files of all models that change."""
        return tuple(file for model in self.models for file in model.changed)


@reading_once()
def fix_files(
    paths: StrPath | Iterable[StrPath],
    settings: CheckSettings | None = None,
    *,
    each: bool = False,
    only_amuros: bool = False,
    write: bool = True,
) -> FixResult:
    """Repair AMALTHEA models, and write the files that changed.

    Parameters
    ----------
    settings, each, only_amuros : as for `check_files`
    write : False: only find out what would change

    Raises
    ------
    ReadError : a file cannot be read, or the settings of the project are wrong.
    WriteError : a file cannot be written; then no file of its model is changed.
    InvalidArgumentError : a rule does not exist.
    """
    files = as_paths(paths)
    rules = selection_of((settings or CheckSettings()).over(project_settings(files[0]))).rules()
    models: list[ModelRepairs] = []
    descriptions: list[Path] = []
    older: list[tuple[Path, str]] = []
    for group in by_model(without_other_yaml(files) if only_amuros else files, each):
        if is_description(group[0]):
            descriptions.append(group[0])
            continue
        model = load(*group)
        migrated = [(d.path, d.migrated_from) for d in model.documents if d.path is not None and d.migrated_from is not None]
        older += migrated
        if not migrated:
            models.append(_repair(group, model, rules, write))
    return FixResult(models=tuple(models), descriptions=tuple(descriptions), older=tuple(older), is_written=write)


def _repair(paths: tuple[Path, ...], model: Model, rules: Collection[str], write: bool) -> ModelRepairs:
    from amalthea_uros.xmi.emf.writer import document_text
    from amalthea_uros.xmi.save import save_documents

    repairs = repair(model, [rule for rule in map(registry.check, rules) if isinstance(rule, ModelCheck)])
    changed = tuple(
        FileChange(document.path, document.source.text, document_text(document, document in repairs.rewritten))
        for document in model.documents
        if document in repairs.changed and document.path is not None and document.source is not None
    )
    if write:
        save_documents(repairs.changed, repairs.rewritten)
    return ModelRepairs(paths=paths, repaired=repairs.done, changed=changed)
