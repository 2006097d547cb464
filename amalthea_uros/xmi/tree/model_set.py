"""A set of files that refer to each other, as nodes; the nodes are indexed by tag and by type, because most steps change little."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator
from pathlib import Path

from amalthea_uros._internal.records import dataclass, field
from amalthea_uros.diagnostics import Location
from amalthea_uros.metamodel.source import FileText, SourceText
from amalthea_uros.xmi.emf.problems import location
from amalthea_uros.xmi.tree.node import Node, NodeIndex, all_below
from amalthea_uros.xmi.tree.notes import Postponed, StepNotes


@dataclass(eq=False)
class Tree:
    """One file.

    Attributes
    ----------
    path : the file
    content : what it held
    version : that of its present content
    root : its content
    prolog, epilog : comments and processing instructions around the root
    names : the tags and types that occurred in it
    """

    path: Path
    content: FileText
    version: str
    root: Node
    prolog: list[str] = field(default_factory=list)
    epilog: list[str] = field(default_factory=list)
    names: frozenset[str] = frozenset()


class Origins:
    """The elements of all files as they were read, by the index that nodes have as origin.

    Attributes
    ----------
    starts, ends : offsets of the start tag, and of the end tag or after an empty element, in bytes of UTF-8
    parents : the container, -1 for roots
    labels : tag and name
    """

    def __init__(self) -> None:
        self.starts: list[int] = []
        self.ends: list[int] = []
        self.parents: list[int] = []
        self.labels: list[tuple[str, str]] = []
        self._files: list[tuple[int, Path, SourceText]] = []

    def begin_file(self, path: Path, file: FileText) -> None:
        """All elements from now on are in that file."""
        self._files.append((len(self.starts), path, SourceText(file)))

    def add(self, start: int, parent: int, tag: str, name: str) -> int:
        """An element more; what it has as origin."""
        self.starts.append(start)
        self.ends.append(0)
        self.parents.append(parent)
        self.labels.append((tag, name))
        return len(self.starts) - 1

    def location(self, origin: int, attribute: str = "") -> Location | None:
        """Where an element is, or one of its attributes; None for -1."""
        if origin < 0:
            return None
        _, path, source = self._files[bisect_right(self._files, origin, key=lambda file: file[0]) - 1]
        return location(path, source, self.starts[origin], attribute)

    def object_name(self, origin: int) -> str:
        """The names of an element and its containers: `swModel / tasks 'T' / callGraph`; shortened to what follows the last name."""
        steps: list[str] = []
        while origin >= 0:
            tag, name = self.labels[origin]
            steps.append(f"{tag} {name!r}" if name else tag)
            if name:
                break
            origin = self.parents[origin]
        return " / ".join(reversed(steps))


class ModelSet:
    """The files that are migrated together.

    Attributes
    ----------
    trees : the files
    origins : where everything comes from
    proxies : what stands for objects to which the files refer, but which no file contains
    set_aside : targets of references that the versions in between cannot express, by object and name; the step to the version that
        can do so again takes them back (`pop`), and what is left in the end is lost
    postponed : content that belongs to the result from a later version on
    """

    def __init__(self, trees: list[Tree], origins: Origins) -> None:
        self.trees = trees
        self.origins = origins
        self.proxies: list[Node] = []
        self.set_aside: dict[tuple[Node, str], list[Node]] = {}
        self.postponed: list[Postponed] = []
        self._index = NodeIndex()
        self._is_current = False
        self._active: list[Tree] = trees

    def begin_step(self, version: str) -> None:
        """From now on only the files of that version are meant; nodes are indexed anew."""
        self._active = [tree for tree in self.trees if tree.version == version]
        self._is_current = False

    @property
    def active(self) -> list[Tree]:
        """The files that the present step is about."""
        return self._active

    @property
    def roots(self) -> list[Node]:
        """The roots of the files that the present step is about."""
        return [tree.root for tree in self._active]

    def walk(self) -> Iterator[Node]:
        """Every node of the files that the present step is about, as of now."""
        return iter(all_below(self.roots))

    @property
    def index(self) -> NodeIndex:
        """The nodes by tag and by type, as of the first use within the step."""
        if not self._is_current:
            self._index.update(self.roots)
            self._is_current = True
        return self._index

    def nodes(self, *tags: str) -> list[Node]:
        """Every node of these tags, in order for one tag; as of the first use of the index within the step."""
        index = self.index
        return [node for tag in tags for node in index.of_tag(tag)]

    def of_type(self, *types: str) -> list[Node]:
        """Every node that states one of these types, in order for one type; as of the first use of the index within the step."""
        index = self.index
        return [node for name in types for node in index.of_type(name) if node.type == name]

    def parts(self, *path: str) -> list[Node]:
        """Everything below the roots that a path of tags leads to."""
        return [node for root in self.roots for node in root.find(*path)]

    def rename_classes(self, renamed: dict[str, str]) -> list[Node]:
        """Rename classes, in `xsi:type` and where references name them; the objects (not the proxies) whose class was renamed."""
        found = []
        for old, new in renamed.items():
            for node in self.of_type(old):
                node.type = new
                found.append(node)
        for node in self.index.all():
            if node.target_class in renamed:
                node.target_class = renamed[node.target_class]
        for node in self.proxies:
            node.target_class = renamed.get(node.target_class, node.target_class)
        return found


#: Changes the active files of the set.
Change = Callable[[ModelSet, StepNotes], None]


@dataclass(frozen=True)
class Step:
    """How the content of one version becomes that of a neighbouring one.

    Attributes
    ----------
    source, target : the versions
    change : what has to be done, None if only the namespace differs
    leftovers : tags and types (`xsi:type`) that do not occur any more after this step. In public histories the namespace was raised
        when the work on a version began, so a file of a later version in which one occurs takes this step, too; a step leaves alone
        what is already converted
    """

    source: str
    target: str
    change: Change | None = None
    leftovers: frozenset[str] = frozenset()
