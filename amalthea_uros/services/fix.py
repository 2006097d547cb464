"""What rules find, repaired where there is only one way to do so."""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from amalthea_uros.services.check import selection_of
from amalthea_uros.services.paths import StrPath, as_paths, by_model, is_description
from amalthea_uros.services.settings import CheckSettings, project_settings
from amalthea_uros.validate import registry
from amalthea_uros.validate.repair import repair
from amalthea_uros.validate.rule import ModelRule


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
    """

    models: tuple[ModelRepairs, ...]
    descriptions: tuple[Path, ...]


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
    groups = list(by_model(files, each))
    return FixResult(
        models=tuple(
            ModelRepairs(paths=group, repaired=_repair(group, rules)) for group in groups if not is_description(group[0])
        ),
        descriptions=tuple(group[0] for group in groups if is_description(group[0])),
    )


def _repair(paths: Sequence[Path], rules: Collection[str]) -> Counter[str]:
    from amalthea_uros.xmi.load import load
    from amalthea_uros.xmi.save import save_documents

    repairs = repair(load(*paths), [rule for rule in map(registry.rule, rules) if isinstance(rule, ModelRule)])
    save_documents(repairs.changed, repairs.rewritten)
    return repairs.done
