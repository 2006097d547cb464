"""A copy of a model whose attributes are changed for a while."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from amalthea_uros._internal.files import overlaid
from amalthea_uros._internal.records import dataclass
from amalthea_uros.design.changes.change import Change
from amalthea_uros.design.model_attributes.keys import ModelKey, keys_of, the_key
from amalthea_uros.design.model_attributes.values import Assigned, checked
from amalthea_uros.errors import InvalidArgumentError, WriteError
from amalthea_uros.metamodel.features import features_of
from amalthea_uros.metamodel.model import Model

if TYPE_CHECKING:
    from amalthea_uros.bridge.extract import Extraction


@dataclass(frozen=True, slots=True)
class ModelTexts:
    """A model as the texts of its files; other than a model, they can be compared, and sent to other processes.

    Attributes
    ----------
    paths : of the files, for messages; None for one that is not saved
    """

    texts: tuple[str, ...]
    paths: tuple[Path | None, ...]

    @classmethod
    def of(cls, model: Model) -> ModelTexts:
        """The texts of a model.

        Raises
        ------
        InvalidArgumentError : the model has values that its version does not allow.
        """
        from amalthea_uros.xmi.emf.writer import document_text

        try:
            return cls(
                tuple(map(document_text, model.documents)),
                tuple(document.path for document in model.documents),
            )
        except WriteError as error:
            reason = next((finding.message for finding in error.findings), str(error))
            raise InvalidArgumentError(f"attributes of the model cannot be changed: {reason}") from None

    def read(self) -> Model:
        """A new model from the texts, with the paths of the former one."""
        from amalthea_uros.xmi.load import load

        # Under a device there is no file that could be read instead.
        contents = {Path("/dev/null", f"{number}.amxmi"): text.encode() for number, text in enumerate(self.texts)}
        with overlaid(contents):
            model = load(*contents, max_size=8 * max(map(len, contents.values())))
        for document, own in zip(model.documents, self.paths, strict=True):
            document.path = own
        return model


class EditableModel:
    """A model of its own, with its keys."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._found: dict[str, ModelKey | None] = {}
        self._extracted: tuple[tuple[Change, ...], Extraction] | None = None

    @cached_property
    def keys(self) -> tuple[ModelKey, ...]:
        """All of them."""
        return tuple(keys_of(self.model))

    def key(self, target: str) -> ModelKey | None:
        """The key with a name, None if there is none; InvalidArgumentError if the name means several ones."""
        if target not in self._found:
            self._found[target] = the_key(target, self.keys)
        return self._found[target]

    @contextmanager
    def edited(self, changes: Sequence[tuple[ModelKey, Change]]) -> Iterator[Model]:
        """The model with changes, which are undone afterwards.

        Raises
        ------
        InvalidArgumentError : a value is wrong.
        """
        present: list[tuple[Assigned, Any]] = []
        try:
            for key, change in changes:
                for each in checked(key, change.target, change.value, self.model):
                    present.append((each, _present(each)))
                    setattr(each.element, each.feature, each.value)
            yield self.model
        finally:
            for each, value in reversed(present):
                setattr(each.element, each.feature, value)

    def extracted(self, changes: Sequence[tuple[ModelKey, Change]]) -> Extraction:
        """The system of the model with changes, and what cannot be extracted; raises as `edited`."""
        from amalthea_uros.bridge.extract import extract

        asked = tuple(change for _, change in changes)
        if self._extracted is None or self._extracted[0] != asked:
            with self.edited(changes) as model:
                self._extracted = asked, extract(model)
        return self._extracted[1]


def _present(assigned: Assigned) -> Any:
    value = assigned.element.__dict__.get(assigned.feature)
    return list(value or ()) if features_of(type(assigned.element))[assigned.feature].many else value


class ModelSource:
    """A model that can be edited for a while, here or in another process.

    Parameters
    ----------
    model : None in another process
    texts : of the model, where there is none
    is_own : whether nobody else has the model, so that no copy is needed
    """

    def __init__(self, model: Model | None, texts: ModelTexts | None = None, *, is_own: bool = False) -> None:
        self._model = model
        self._texts = texts
        self._is_own = is_own

    @cached_property
    def editable(self) -> EditableModel:
        """The model that is edited; InvalidArgumentError if a copy cannot be made of the model."""
        if self._is_own and self._model is not None:
            return EditableModel(self._model)
        return _copied(self.texts)

    @property
    def texts(self) -> ModelTexts:
        """The texts of the files; raises as `ModelTexts.of`."""
        if self._texts is None:
            assert self._model is not None
            self._texts = ModelTexts.of(self._model)
        return self._texts

    def __reduce__(self) -> tuple[object, ...]:
        return ModelSource, (None, self.texts)


@lru_cache(maxsize=2)
def _copied(texts: ModelTexts) -> EditableModel:
    """A copy of a model; searches and campaigns ask for the same one again."""
    return EditableModel(texts.read())
