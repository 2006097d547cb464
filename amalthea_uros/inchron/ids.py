"""Ids of objects, as the importer of INCHRON forms them from names (am2inc, StableIntrinsicIds).

They stay the same while names stay, so that a project that is written again can replace the one before.
"""

from __future__ import annotations

from base64 import b64encode
from uuid import UUID, uuid5

from amalthea_uros.inchron.facts import is_a
from amalthea_uros.inchron.objects import ProjectObject

#: What all ids depend on, unless another namespace is wanted.
NAMESPACE = uuid5(UUID(int=0), "com.inchron.am2inc")


def intrinsic_ids(model: ProjectObject, namespace: UUID = NAMESPACE) -> dict[ProjectObject, str]:
    """The ids of a model and of all referable objects in it; unlike the importer's they are unique, also where names are not."""
    # The model is the part `model` of the root, whose id is that of the namespace; the root itself has no attribute for it.
    result = {model: _text(uuid5(namespace, f"{_text(namespace)}/@model.{model.name}"))}
    _add(model, result[model], result, namespace, set(result.values()))
    return result


def _add(item: ProjectObject, above: str, result: dict[ProjectObject, str], namespace: UUID, used: set[str]) -> None:
    counts: dict[str, int] = {}
    for feature, part in item.parts():
        own = above
        if is_a(part.kind, "root.Referable"):
            number = counts[feature.name] = counts.get(feature.name, -1) + 1
            path = f"{above}/@{feature.name}"
            if part.name:
                path += f".{part.name}"
            elif feature.many:
                path += f".{number}"
            own = _text(uuid5(namespace, path))
            if own in used:
                own = _text(uuid5(namespace, f"{path}#{number}"))
            used.add(own)
            result[part] = own
        _add(part, own, result, namespace, used)


def _text(uuid: UUID) -> str:
    return "_" + b64encode(uuid.bytes).decode().rstrip("=")
