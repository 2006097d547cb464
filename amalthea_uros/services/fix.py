"""What rules find, repaired where there is only one way to do so."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

from amalthea_uros.metamodel.model import Model
from amalthea_uros.services.check import selection_of
from amalthea_uros.services.paths import StrPath, as_paths, by_model, is_description
from amalthea_uros.services.settings import CheckSettings, project_settings
from amalthea_uros.validate import registry
from amalthea_uros.validate.repair import repair
from amalthea_uros.validate.rule import ModelRule
from amalthea_uros.xmi.load import load


@dataclass(frozen=True, slots=True, kw_only=True)
class ModelRepairs:
    """What was repaired in the files of one model.

    Attributes
    ----------
    repaired : the number of objects by the id of the rule
    """

    paths: tuple[Path, ...]
    repaired: Mapping[str, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class FixResult:
    """What was repaired.

    Attributes
    ----------
    descriptions : the files that were not repaired, since only their authors know what is meant
    older : the files of models that have to be migrated first, with their AMALTHEA version
    """

    models: tuple[ModelRepairs, ...]
    descriptions: tuple[Path, ...]
    older: tuple[tuple[Path, str], ...] = ()


def fix_files(paths: StrPath | Iterable[StrPath], settings: CheckSettings | None = None, *, each: bool = False) -> FixResult:
    """Repair AMALTHEA models, and write the files that changed.

    Parameters
    ----------
    settings, each : as for `check_files`

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
    for group in by_model(files, each):
        if is_description(group[0]):
            descriptions.append(group[0])
            continue
        model = load(*group)
        migrated = [(d.path, d.migrated_from) for d in model.documents if d.path is not None and d.migrated_from is not None]
        older += migrated
        if not migrated:
            models.append(ModelRepairs(paths=group, repaired=_repair(model, rules)))
    return FixResult(models=tuple(models), descriptions=tuple(descriptions), older=tuple(older))


def _repair(model: Model, rules: Collection[str]) -> Counter[str]:
    from amalthea_uros.xmi.save import save_documents

    repairs = repair(model, [rule for rule in map(registry.rule, rules) if isinstance(rule, ModelRule)])
    save_documents(repairs.changed, repairs.rewritten)
    return repairs.done
