"""Hardware that property constraints contain in 0.7.1: in 0.7.2 it is in the hardware model, and they refer to it."""

from __future__ import annotations

from amalthea_uros.xmi.migrate.model_set import ModelSet
from amalthea_uros.xmi.migrate.node import Node, remove_all
from amalthea_uros.xmi.migrate.notes import Notes
from amalthea_uros.xmi.migrate.steps.v0_7_tools import content_of, relink

#: Element of propertyConstraintsModel -> element of hwModel.
_DEFINITIONS = {"coreTypeDefinitions": "coreTypes", "memoryTypeDefinitions": "memoryTypes"}

#: The containers of new cores and memories, with the names that APP4MC generates.
_SYSTEM = ("system", "migration_gen_system")
_MICROCONTROLLER = (_SYSTEM, ("ecus", "migration_gen_ecu"), ("microcontrollers", "migration_gen_microcontroller"))

#: Element of a condition -> class of the condition, element of the hardware, and its containers.
_PARTS = {"core": ("HwCoreProperty", "cores", _MICROCONTROLLER), "memory": ("HwMemoryProperty", "memories", (_SYSTEM,))}


def move_hardware(models: ModelSet, notes: Notes) -> None:
    """Move what has a new name to the hardware model, and let the rest mean the hardware of the same name."""
    mover = _Mover(models, notes)
    for tag, new_tag in _DEFINITIONS.items():
        for definition in models.parts("propertyConstraintsModel", tag):
            mover.move(definition, new_tag, ())
    for tag, (condition_class, new_tag, containers) in _PARTS.items():
        for part in models.nodes(tag):
            condition = part.parent
            if condition is None or condition.type != condition_class:
                continue
            meant = mover.move(part, new_tag, containers)
            if meant is not None:
                condition.references[tag] = [meant]
    mover.finish()


class _Mover:
    """Moves hardware, and remembers what is there.

    Attributes
    ----------
    known : hardware by element and name
    moved : what goes into which container
    removed : what is not needed
    replaced : what is meant instead of it
    """

    def __init__(self, models: ModelSet, notes: Notes) -> None:
        self.models, self.notes = models, notes
        self.known: dict[tuple[str, str], Node] = {}
        self.moved: dict[Node, list[Node]] = {}
        self.removed: list[Node] = []
        self.replaced: dict[Node, Node] = {}
        for model in models.parts("hwModel"):
            self.register(model)

    def register(self, hardware: Node) -> None:
        """Remember everything in it; of several things of one name the first."""
        for node in hardware.walk():
            if node.name:
                self.known.setdefault((node.tag, node.name), node)

    def move(self, node: Node, tag: str, containers: tuple[tuple[str, str], ...]) -> Node | None:
        """Move hardware to a place below the hardware model, unless there is such a thing; what is meant by it now."""
        if not node.name:
            self.removed.append(node)
            self.notes.lost(node, f"unnamed {node.tag} of a property constraint", content_of(node))
            return None
        known = self.known.get((tag, node.name))
        if known is not None:
            self.removed.append(node)
            self.replace(node, known)
            return known
        self.notes.moved(node, f"{node.tag} of a property constraint -> {tag} of the hardware model", node.name)
        holder = self.hardware_model()
        for container, name in containers:
            holder = _part(holder, container, name)
        self.moved.setdefault(holder, []).append(node)
        node.tag = tag
        self.known[tag, node.name] = node
        self.register(node)
        return node

    def replace(self, node: Node, known: Node) -> None:
        """Let references to a node, and to what is in it, mean what has its name in the hardware model."""
        self.replaced[node] = known
        for part in node.walk():
            if part is not node and (part.tag, part.name) in self.known:
                self.replaced[part] = self.known[part.tag, part.name]
        message = f"{node.tag} of a property constraint: the one of the same name in the hardware model is meant"
        if node.children or node.references or not node.attributes.items() <= known.attributes.items():
            self.notes.lost(node, f"{message}; what it states besides is dropped", content_of(node))
        else:
            self.notes.converted(node, message, node.name)

    def hardware_model(self) -> Node:
        """The first hardware model, else a new one in the first file, as in APP4MC."""
        roots = [tree.root for tree in sorted(self.models.active, key=lambda tree: tree.path)]
        models = [model for root in roots for model in root.all("hwModel")]
        return models[0] if models else roots[0].add("hwModel")

    def finish(self) -> None:
        """Move and remove all at once, and let nothing refer to what is removed."""
        for holder, nodes in self.moved.items():
            holder.take(nodes)
        remove_all(self.removed)
        relink(self.models, self.replaced)


def _part(holder: Node, tag: str, name: str) -> Node:
    """The part of that name, made if there is none; a system of any name, as there is only one."""
    for part in holder.all(tag):
        if part.name == name or tag == "system":
            return part
    return holder.add(tag, name=name)
