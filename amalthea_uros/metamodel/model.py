"""A model: one or several documents that refer to each other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import NamedTuple, TypeVar

from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.similar import did_you_mean
from amalthea_uros.diagnostics import Finding, Location
from amalthea_uros.metamodel.classes_base import Amalthea
from amalthea_uros.metamodel.classes_sw import CallArgument, RunnableCall
from amalthea_uros.metamodel.containment import Revision, path_of
from amalthea_uros.metamodel.editing import Editing
from amalthea_uros.metamodel.element import Element, references_of
from amalthea_uros.metamodel.naming import qualified_name
from amalthea_uros.metamodel.source import SourceText
from amalthea_uros.metamodel.versions import nearest_version, newest_version

E = TypeVar("E", bound=Element)

#: So many names are listed.
_MOST_NAMES = 10


class Changes:
    """The modifications of a document since it was read; the rest can be copied from the source.

    Attributes
    ----------
    modified : modified objects and all their containers
    renamed : objects whose unique names may have changed, or which were added or removed
    """

    def __init__(self) -> None:
        self.modified: set[Element] = set()
        self.renamed: set[Element] = set()

    def note(self, path: list[Element], renames: bool) -> None:
        """Note the change of an object, given with its containers."""
        self.modified.update(path)
        if renames:
            self.renamed.add(path[0])


class Spelling(NamedTuple):
    """A text of the file and its canonical form; as long as the canonical form stays the same, the text of the file is kept."""

    written: str
    canonical: str


class Reference(NamedTuple):
    """A use of an object: the object that refers to it and the feature (its Python name) by which it does."""

    holder: Element
    feature: str


class Document:
    """One file of a model, read or to be written.

    Attributes
    ----------
    root : the content
    version : AMALTHEA version of the file; may be newer than what is known
    path : the file, None for a new one
    source : the text it was read from, None for a new one
    changes : the modifications since it was read
    prolog : comments and processing instructions before the root element, `epilog` those after it
    spellings : ids and references that are not in canonical form, by object and XML name
    href_features : references that are `href` elements although EMF would write an attribute (or the reverse: False)
    href_content : what is inside the `href` elements of a reference, as written in the file; by the object that refers, the XML name
        of the feature, and the target
    namespaces : the namespaces that the root of the file declares, by prefix; unknown content may need them
    migrated_from : the older version of the file, if the document was migrated while it was read; else None
    origins : locations of objects that were not read from this document, such as a line of a description
    """

    def __init__(self, root: Amalthea, version: str | None = None, path: Path | None = None) -> None:
        self.root = root
        self.version = version or newest_version()
        self.path = path
        self.source: SourceText | None = None
        self.prolog: list[str] = []
        self.epilog: list[str] = []
        self.spellings: dict[tuple[Element, str], Spelling] = {}
        self.href_features: dict[tuple[Element, str], bool] = {}
        self.href_content: dict[tuple[Element, str, Element], list[str]] = {}
        self.namespaces: dict[str, str] = {}
        self.changes = Changes()
        self.migrated_from: str | None = None
        self.origins: dict[Element, Location] = {}
        self._model: Model | None = None
        object.__setattr__(root, "_document", self)

    @property
    def file_version(self) -> str:
        """The AMALTHEA version that the file has, also if the document was migrated while it was read."""
        return self.migrated_from or self.version

    @property
    def facts_version(self) -> str:
        """The version whose facts apply: that of the file, or the nearest older one."""
        return nearest_version(self.version)

    def location_of(self, element: Element, attribute: str = "") -> Location | None:
        """The location of an object, or of one of its attributes, in the file, or its origin; failing both, that of its container.

        None if the document has no file either.
        """
        holder: Element | None = element
        while holder is not None:
            if holder in self.origins:
                return self.origins[holder]
            place = self.source.place_of(holder, attribute if holder is element else "") if self.source is not None else None
            if place is not None and self.path is not None:
                return Location(self.path, *place)
            holder = holder.container
        return Location(self.path) if self.path else None

    @property
    def model(self) -> Model:
        """The model that this document is part of."""
        return self._model or Model([self])

    def __repr__(self) -> str:
        return f"<Document {self.path or 'unsaved'} AMALTHEA {self.version}>"


class Model(Editing):
    """Documents that refer to each other by unique names, such as the files of one directory.

    Attributes
    ----------
    documents : the files
    findings : problems found while reading
    """

    def __init__(self, documents: Iterable[Document]) -> None:
        self.documents = tuple(documents)
        self.findings: tuple[Finding, ...] = ()
        self._by_name: dict[str, list[Element]] = {}
        self._revision = -1
        for document in self.documents:
            document._model = self

    @classmethod
    def of(cls, root: Amalthea, version: str | None = None) -> Model:
        """A new model with one document; the newest known version if none is given."""
        return cls([Document(root, version)])

    @classmethod
    def new(cls, version: str | None = None) -> Model:
        """An empty model; `add_core`, `add_task`, `add_label` and `add_chain` fill it.

        >>> model = Model.new()
        >>> core = model.add_core("Core_0", frequency="100 MHz")
        >>> task = model.add_task("Control", period="1 ms", wcet="20 us", priority=2)
        """
        return cls.of(Amalthea(), version)

    @property
    def root(self) -> Amalthea:
        """The content of the only document.

        Raises
        ------
        ValueError : the model has several documents.
        """
        if len(self.documents) != 1:
            raise ValueError(f"the model has {len(self.documents)} documents; use the root of each")
        return self.documents[0].root

    def walk(self) -> Iterator[Element]:
        """Every object, document by document, containers before their parts."""
        for document in self.documents:
            yield from document.root.walk()

    def all(self, cls: type[E]) -> Iterator[E]:
        """Every object of a class or its subclasses."""
        return (element for element in self.walk() if isinstance(element, cls))

    def find(self, cls: type[E], name: str) -> E | None:
        """The first object of a class with a name or qualified name (`Board.eth0`), None if there is none."""
        found = self._hit(cls, name)
        if found is None and self._revision != Revision.number:
            self._index()
            found = self._hit(cls, name)
        return found

    def __getitem__(self, key: tuple[type[E], str]) -> E:
        """`model[Task, "Executor_Task"]`: the object of that class and name.

        Raises
        ------
        KeyError : there is none; the text names near ones.
        """
        if not isinstance(key, tuple) or len(key) != 2:
            raise TypeError(f"a model is indexed by class and name, e.g. model[am.Task, {key!r}]")
        cls, name = key
        found = self.find(cls, name)
        if found is None:
            names = [n for n, elements in self._by_name.items() if any(isinstance(e, cls) for e in elements)]
            raise KeyError(f"no {cls.__name__} named {name!r}; {did_you_mean(name, names) or _known(names)}")
        return found

    def references_to(self, target: Element) -> list[Reference]:
        """Every use of an object, in the order of the model."""
        found = []
        for holder in self.walk():
            for name, value in references_of(holder):
                if value is target or (isinstance(value, list) and any(item is target for item in value)):
                    found.append(Reference(holder, name))
        return found

    def unresolved(self) -> Iterator[tuple[Reference, str]]:
        """Every reference for which no object was found, with its text."""
        for holder in self.walk():
            for name, value in references_of(holder):
                for item in value if isinstance(value, list) else (value,):
                    if item.unresolved is not None:
                        yield Reference(holder, name), item.unresolved

    def _hit(self, cls: type[E], name: str) -> E | None:
        for element in self._by_name.get(name, ()):
            if isinstance(element, cls) and self._still_has(element, name):
                return element
        return None

    def _still_has(self, element: Element, name: str) -> bool:
        """Whether an entry of the look-up table, which may be stale, still holds."""
        if self._revision == Revision.number:
            return True
        document = element.document
        return document in self.documents and name in (element.__dict__.get("name"), qualified_name(element))

    def _index(self) -> None:
        self._by_name = {}
        for element in self.walk():
            name = element.__dict__.get("name")
            if name:
                self._by_name.setdefault(name, []).append(element)
                qualified = qualified_name(element) if element.is_referable else name
                if qualified != name:
                    self._by_name.setdefault(qualified, []).append(element)
        self._revision = Revision.number

    def __repr__(self) -> str:
        paths = ", ".join(str(document.path or "unsaved") for document in self.documents)
        versions = ", ".join(dict.fromkeys(document.version for document in self.documents))
        return f"<Model {paths}, AMALTHEA {versions}, {counted(sum(1 for _ in self.walk()), 'object')}>"


def _known(names: Sequence[str]) -> str:
    """The names that there are, unless they are too many to be read."""
    more = f" and {len(names) - _MOST_NAMES} more" if len(names) > _MOST_NAMES else ""
    return f"known: {', '.join(map(str, names[:_MOST_NAMES]))}{more}" if names else "there is none"


def propagate_renames(documents: Iterable[tuple[Element, Changes]]) -> None:
    """Mark as modified, in all documents (root and changes) of a model, everything in which the name of a renamed object occurs.

    These are its parts, whose own names may be derived from it, and the holders of references to it and to them.
    """
    documents = tuple(documents)
    renamed = {element for _, changes in documents for element in changes.renamed}
    affected: set[Element] = set()
    while renamed - affected:
        affected |= {part for element in renamed for part in element.walk()}
        for root, changes in documents:
            for holder in root.walk():
                if holder in affected and holder.is_referable:
                    changes.modified.update(path_of(holder))
                for name, value in references_of(holder):
                    if not _refers_to_any(value, affected):
                        continue
                    changes.modified.update(path_of(holder))
                    # The names of namespace members and of call arguments are derived from those of their references.
                    if name == "namespace" or isinstance(holder, RunnableCall | CallArgument):
                        renamed.add(holder)


def _refers_to_any(value: Element | list[Element], affected: set[Element]) -> bool:
    return not affected.isdisjoint(value) if isinstance(value, list) else value in affected
