"""Names in the description: those of the code, each once."""

from __future__ import annotations

from collections import defaultdict

from amalthea_uros.source.facts import CodeEntityKind, CodeFacts, CodeHandle

_LONGEST = 150


class CodeNames:
    """The names of executors and callbacks.

    Attributes
    ----------
    executors : by key
    senders : those of the loops that only send, in their order
    topics : of publishers, by key, as far as they are constant
    handles : names of callbacks by the key of what they were added with
    handle_by_entity : the handle of an entity, and the name of its executor
    """

    def __init__(self, facts: CodeFacts) -> None:
        self._used: set[str] = set()
        self._numbers: dict[str, int] = defaultdict(lambda: 1)
        self.executors: dict[str, str] = {}
        self.handles: dict[str, str] = {}
        self.topics = {each.key: each.name for each in facts.of_kind(CodeEntityKind.PUBLISHER) if each.name is not None}
        self.handle_by_entity: dict[str, tuple[CodeHandle, str]] = {}
        for executor in facts.executors.values():
            name = executor.thread.name if executor.thread is not None else executor.variable
            self.executors[executor.key] = self._unique(name, executor.variable)
        self.senders = [self._unique(each.name, "sender") for each in facts.senders]
        for executor in facts.executors.values():
            for handle in executor.handles:
                entity = facts.entities.get(handle.entity)
                if entity is None or handle.entity in self.handles:
                    continue
                callback = next(iter(handle.callbacks), entity.callback)
                name = callback.name if callback is not None else entity.variable
                self.handle_by_entity[entity.key] = handle, self.executors[executor.key]
                if entity.kind.value not in ("parameter server", "lifecycle node"):
                    self.handles[entity.key] = self._unique(name, entity.variable)

    def _unique(self, name: str, variable: str) -> str:
        text = "".join(each if each.isprintable() else "?" for each in name).strip()[:_LONGEST] or "unnamed"
        if text in self._used:
            text = f"{text}_{variable}"[:_LONGEST]
        plain = text
        while text in self._used:
            self._numbers[plain] += 1
            text = f"{plain}_{self._numbers[plain]}"
        self._used.add(text)
        return text
