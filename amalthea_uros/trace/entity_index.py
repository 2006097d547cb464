"""The entities of a trace that is being read, in the order in which they appear."""

from __future__ import annotations

from collections.abc import Sequence

from amalthea_uros.trace.table import Entity, EntityKind


class EntityIndex:
    """Gives entities their indices.

    Attributes
    ----------
    entities : grows while the trace is read
    """

    def __init__(self) -> None:
        self.entities: list[Entity] = []
        self._indices: dict[Entity, int] = {}
        self._assumed: dict[str, int] = {}

    def index(self, kind: EntityKind, name: str) -> int:
        """The index of an entity whose type is known."""
        entity = Entity(kind, name)
        if entity not in self._indices:
            assumed = self._assumed.pop(name, None)
            if assumed is not None and _are_alike(self.entities[assumed].kind, kind):
                # So far it has only been a source, and its type a guess.
                self.entities[assumed] = entity
                self._indices[entity] = assumed
            else:
                self._indices[entity] = len(self.entities)
                self.entities.append(entity)
        return self._indices[entity]

    def source_index(self, name: str, kinds: Sequence[EntityKind]) -> int:
        """The index of an entity that is of one of some types: of the first that is known, or else of the first."""
        known = (self._indices.get(Entity(kind, name)) for kind in kinds)
        found = next((index for index in known if index is not None), None)
        if found is not None:
            return found
        assumed = self._assumed.get(name)
        if assumed is not None and self.entities[assumed].kind in kinds:
            return assumed
        if len(kinds) == 1:
            return self.index(kinds[0], name)
        self._assumed[name] = len(self.entities)
        self.entities.append(Entity(kinds[0], name))
        return self._assumed[name]


def _are_alike(assumed: EntityKind, kind: EntityKind) -> bool:
    """Whether something that was taken for one type as a source can be of another."""
    sources = (EntityKind.TASK, EntityKind.ISR, EntityKind.STIMULUS)
    return assumed in sources and kind in sources
