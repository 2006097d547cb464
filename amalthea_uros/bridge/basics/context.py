"""The state of one run of building or extracting."""

from __future__ import annotations

from collections.abc import Iterator

from amalthea_uros.bridge.basics.kinds import ObjectKind, kind_of
from amalthea_uros.diagnostics import Finding, Location, Severity
from amalthea_uros.errors import WriteError
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Model
from amalthea_uros.metamodel.versions import facts, version_key
from amalthea_uros.perf.named import Named

#: Kinds of objects that contain others with names; the rest, such as activity graphs, need not be searched.
_HOLDERS = {ObjectKind.STRUCTURE, ObjectKind.MODULE, ObjectKind.OPERATING_SYSTEM}


class Building:
    """perf -> AMALTHEA objects of one version.

    Attributes
    ----------
    origins : locations from which objects come, where known
    types : data types by their size in bits, as far as they are needed
    findings : errors that prevent building
    """

    def __init__(self, version: str) -> None:
        self.version = version
        self.facts = facts(version)
        self.origins: dict[Element, Location] = {}
        self.types: dict[int, Element] = {}
        self.findings: list[Finding] = []
        self._known: dict[type[Element], frozenset[str]] = {}
        self._elements: dict[tuple[ObjectKind, str], Element] = {}
        self._holder: Named | None = None

    def known_features(self, cls: type[Element]) -> frozenset[str]:
        """The features of a class in the version, by their names in files; none if the version has no such class."""
        if cls not in self._known:
            is_known = cls.__name__ in self.facts.classes
            self._known[cls] = frozenset(f.name for f in self.facts.features(cls.__name__)) if is_known else frozenset()
        return self._known[cls]

    def is_at_least(self, *version: int) -> bool:
        """Whether the version is that one or a later one."""
        return version_key(self.version) >= version

    def register(self, item: Named, element: Element) -> None:
        """Register an object as a target of references, with its origin."""
        kind = kind_of(type(element))
        assert kind
        if (kind, item.name) in self._elements:
            self.refuse(item, f"duplicate name {item.name!r}: two objects of kind {_text(kind)} have it")
        self._elements[kind, item.name] = element
        if item.origin is not None:
            self.origins[element] = item.origin

    def find(self, kind: ObjectKind, name: str) -> Element | None:
        """The object of that name; None, with a finding, if there is none."""
        found = self._elements.get((kind, name))
        if found is None:
            self.refuse(self._holder, f"undefined {_text(kind)} {name!r}")
        return found

    def at(self, item: Named) -> None:
        """Set the object whose references are resolved from now on."""
        self._holder = item

    def refuse(self, item: Named | None, message: str) -> None:
        """Add an error that prevents building."""
        name = item.name if item else ""
        text = f"{name}: {message}" if name else message
        self.findings.append(Finding("BLD001", Severity.ERROR, text, item.origin if item else None, object=name))

    def refuse_literal(self, literal: object) -> None:
        """Add an error about a value of the current object for which AMALTHEA has no literal."""
        self.refuse(self._holder, f"AMALTHEA {self.version} has no literal for {str(literal)!r}")

    def finish(self) -> None:
        """Check that there were no errors.

        Raises
        ------
        WriteError : there were errors; carries a finding for each.
        """
        if self.findings:
            raise WriteError(dict.fromkeys(self.findings))


class Extracting:
    """AMALTHEA objects -> perf.

    Attributes
    ----------
    names : unique within each kind
    dropped : named objects that have no counterpart in perf
    findings : what could not be extracted
    unresolved_stimuli : names of stimuli that are not part of the model, but activate processes
    without_property : objects that mean more than is known, as a property of them cannot be read
    """

    def __init__(self, model: Model, dropped: frozenset[Element] = frozenset()) -> None:
        self.model = model
        self.names: dict[Element, str] = {}
        self.dropped = set(dropped)
        self.findings: list[Finding] = []
        self.unresolved_stimuli: dict[str, None] = {}
        self.without_property: set[Element] = set()
        self._left_out: dict[str, tuple[int, Element]] = {}

    def name(self) -> None:
        """Give every referable object a name that is unique within its kind."""
        taken: set[tuple[ObjectKind, str]] = set()
        #: The next number to try for a name, so that thousands of equal names are numbered in linear time.
        numbers: dict[tuple[ObjectKind, str], int] = {}
        for kind, element in self._named():
            own = element.__dict__.get("name") or f"unnamed_{type(element).__name__}"
            found = own
            if (kind, found) in taken:
                found = element.qualified_name if "/" in element.qualified_name else own
                while (kind, found) in taken:
                    number = numbers.get((kind, own), 2)
                    found = f"{own}_{number}"
                    numbers[kind, own] = number + 1
                message = f"duplicate name {own!r}: this {type(element).__name__} is called {found!r} in the results"
                self.note("EXT002", message, element)
            taken.add((kind, found))
            self.names[element] = found

    def _named(self) -> Iterator[tuple[ObjectKind, Element]]:
        """All objects that are referenced by name, in the order of the files."""
        stack: list[Element] = [document.root for document in reversed(self.model.documents)]
        while stack:
            element = stack.pop()
            kind = kind_of(type(element))
            if kind is not None:
                yield kind, element
            if kind is None or kind in _HOLDERS:
                stack.extend(reversed(tuple(element.contents())))

    def drop(self, element: Element) -> None:
        """Mark an object as one without counterpart in perf, so that references to it are ignored."""
        if element in self.names:
            self.dropped.add(element)

    @staticmethod
    def is_older(element: Element, *version: int) -> bool:
        """Whether an object is part of a file of an older version than that."""
        document = element.document
        return document is not None and version_key(document.facts_version) < version

    @staticmethod
    def location(element: Element) -> Location | None:
        """The location of an object."""
        document = element.document
        return document.location_of(element) if document else None

    def note(self, rule: str, message: str, element: Element, severity: Severity = Severity.WARNING) -> None:
        """Add a finding about an object."""
        self.findings.append(Finding(rule, severity, message, self.location(element), object=self.called(element)))

    def called(self, element: Element) -> str:
        """The name of an object, or of the nearest named container."""
        holder: Element | None = element
        while holder is not None and holder not in self.names:
            holder = holder.container
        return self.names[holder] if holder is not None else ""

    def unresolved_stimulus(self, element: Element) -> str:
        """The name in the results of a stimulus that is not part of the model."""
        name = f"{getattr(element, 'name', None) or element.unresolved} (unresolved)"
        self.unresolved_stimuli[name] = None
        return name

    def leave_out(self, element: Element, name: str = "") -> None:
        """Count an object that the generic performance model cannot represent, by its class or another name."""
        name = name or type(element).__name__
        count, first = self._left_out.get(name, (0, element))
        self._left_out[name] = (count + 1, first)

    def finish(self) -> tuple[Finding, ...]:
        """All findings; objects that were left out are reported once per class."""
        for name, (count, first) in self._left_out.items():
            what = f"1 object of class {name} is" if count == 1 else f"{count} objects of class {name} are"
            self.note("EXT001", f"{what} not used by the analysis", first, Severity.INFO)
        return tuple(dict.fromkeys(self.findings))


def _text(kind: ObjectKind) -> str:
    return kind.name.lower().replace("_", " ")
