"""Resolution of references between objects, also across files: text -> object.

Objects are found by their unique names in all documents. A reference without target refers to an unresolved proxy that keeps the
text, so that nothing is lost and everything else can continue.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from itertools import chain, compress
from operator import is_, not_
from pathlib import Path
from typing import NamedTuple
from urllib.parse import unquote

from amalthea_uros._internal.limits import ADVICE, MODEL_REFERENCES
from amalthea_uros._internal.plural import counted
from amalthea_uros._internal.similar import Suggestions
from amalthea_uros.diagnostics import Finding, Severity
from amalthea_uros.errors import ReadError
from amalthea_uros.metamodel.containment import ReferenceList
from amalthea_uros.metamodel.element import Element
from amalthea_uros.metamodel.model import Document, Spelling
from amalthea_uros.metamodel.naming import TYPE_MARK, decode, encode, has_prefix, unique_name
from amalthea_uros.xmi.emf.plan import NAMESPACES, WAVES, ClassPlan, FeaturePlan, plans, reference_texts
from amalthea_uros.xmi.emf.reader import ReadResult

#: Of objects with the same name, so many are listed.
MAX_PLACES = 12

_set = object.__setattr__


def resolve(results: Sequence[ReadResult], linked: Mapping[str, Element]) -> list[Finding]:
    """Resolve the references of all documents in place; the findings name those with no target, several, or one of a wrong class.

    Parameters
    ----------
    linked : objects by texts whose meaning is known already, because the references of migrated models are links before they are texts

    Raises
    ------
    ReadError : a file has so many references in lists that they could exhaust the memory.
    """
    resolver = _Resolver(results, linked)
    for wave in range(WAVES):
        resolver.index(wave)
        resolver.link_all(wave)
    for result in results:
        resolver.check_xmi_ids(result)
    return resolver.findings()


class Use(NamedTuple):
    """A reference that a finding is about."""

    document: Document
    holder: Element
    feature: FeaturePlan
    is_href: bool


class _Match(NamedTuple):
    """The object that a text means, its unique name, and the id of the problem with the text, "" if there is none."""

    target: Element | None
    canonical: str
    problem: str


class _Resolver:
    def __init__(self, results: Sequence[ReadResult], linked: Mapping[str, Element]) -> None:
        self.results = results
        self.numbers = {result.document: number for number, result in enumerate(results)}
        self.by_id: dict[str, Element] = dict(linked)
        #: Ids that several objects share; a reference means the first one in its own document.
        self.shared: dict[str, list[Element]] = {}
        self.in_namespace = {holder for _, _, holders in self.pending(NAMESPACES) for holder in holders}
        self.proxies: dict[tuple[str, type[Element]], Element] = {}
        self.problems: dict[tuple[str, str], list[Use]] = {}
        #: What the texts that are no unique names mean, each looked up once, because thousands of objects may have the same name.
        self.matches: dict[tuple[Document, str, type[Element]], _Match] = {}
        #: The number of references in lists of each file.
        self.listed: Counter[Document] = Counter()
        self.suggestions = Suggestions()

    def index(self, wave: int) -> None:
        """Enter the objects whose names are known in a wave under these."""
        self.matches.clear()
        by_id = self.by_id
        for plan, elements in chain.from_iterable(result.referables.items() for result in self.results):
            if plan.wave != wave:
                continue
            names = self.names(plan, elements)
            named = dict(zip(names, elements, strict=True))
            if len(named) == len(elements) and by_id.keys().isdisjoint(named):
                by_id.update(named)
                continue
            for name, element in zip(names, elements, strict=True):
                first = by_id.setdefault(name, element)
                if first is not element:
                    self.shared.setdefault(name, [first]).append(element)

    def names(self, plan: ClassPlan, elements: list[Element]) -> list[str]:
        """The unique names of objects of a class."""
        if has_prefix(plan.cls):
            return list(map(unique_name, elements))
        # The usual case; the general function takes three times as long.
        in_namespace, suffix = self.in_namespace, TYPE_MARK + plan.cls.__name__
        return [
            unique_name(element) if element in in_namespace else encode(element.__dict__.get("name")) + suffix
            for element in elements
        ]

    def pending(self, wave: int) -> Iterator[tuple[ReadResult, FeaturePlan, list[Element]]]:
        """The references of a wave: the objects that refer by a feature in a file."""
        for result in self.results:
            for feature, holders in chain(result.references.items(), result.hrefs.items()):
                if feature.wave == wave:
                    yield result, feature, holders

    def link_all(self, wave: int) -> None:
        """Assign the targets of references."""
        by_id, shared, is_single = self.by_id, self.shared, len(self.results) == 1
        for result, feature, holders in self.pending(wave):
            name, expected, document = feature.name, feature.target, result.document
            is_usual = not feature.many and holders is result.references.get(feature)
            for holder in holders:
                held = holder.__dict__
                text = held[name]
                # The usual case, one id in an attribute that names an object of the file.
                target = by_id.get(text) if is_usual else None
                if (
                    target is not None
                    and isinstance(target, expected)
                    and (is_single or target.document is document)
                    and not (shared and text in shared)
                ):
                    held[name] = target
                else:
                    self.link(result, holder, feature, text)

    def link(self, result: ReadResult, holder: Element, feature: FeaturePlan, given: str | list[str]) -> None:
        """Assign the targets of one object; note if the form (attribute or `href`) is not the one that EMF would write.

        Parameters
        ----------
        given : the text of an attribute, or the ids of `href` elements
        """
        document, is_single, is_href = result.document, len(self.results) == 1, isinstance(given, list)
        targets = []
        local = True
        for text in given if isinstance(given, list) else self.texts_of(document, holder, feature, given):
            target = self.by_id.get(text)
            if target is None or text in self.shared or not isinstance(target, feature.target):
                target = self.find(Use(document, holder, feature, is_href), text)
                local = local and target.unresolved is None
            targets.append(target)
            local = local and (is_single or target.document is document)
            content = result.href_content.get((holder, feature.name, len(targets) - 1)) if is_href else None
            if content:
                document.href_content.setdefault((holder, feature.xml_name, target), []).extend(content)
        holder.__dict__[feature.name] = ReferenceList(holder, targets) if feature.many else targets[0]
        if is_href is local:
            document.href_features[holder, feature.xml_name] = is_href

    def texts_of(self, document: Document, holder: Element, feature: FeaturePlan, value: str) -> list[str]:
        """The ids in an attribute; of a whole file not so many that they exhaust the memory."""
        texts = reference_texts(feature, value, MODEL_REFERENCES)
        if len(texts) > 1:
            self.listed[document] += len(texts)
            if self.listed[document] > MODEL_REFERENCES:
                message = f"the file has more than {MODEL_REFERENCES:,} references in lists"
                raise ReadError([Finding("XMI004", Severity.ERROR, message, document.location_of(holder), ADVICE)])
        return texts

    def find(self, use: Use, text: str) -> Element:
        """The target of a reference that is not exactly the unique name of one fitting object."""
        document, holder, feature, _ = use
        key = (document, text, feature.target)
        match = self.matches.get(key)
        if match is None:
            match = self.matches[key] = self.match(*key)
        if match.problem:
            self.problem(match.problem, text, use)
        target = match.target
        if target is None:
            return self.proxy(text, feature)
        if match.canonical != text:
            self.problem("XMI024", text, use)
            document.spellings[holder, f"{feature.xml_name} {text}"] = Spelling(text, match.canonical)
        return target

    def match(self, document: Document, text: str, target: type[Element]) -> _Match:
        """The object of a class that a text in a document means."""
        candidates = self.candidates(document, text)
        fitting = [element for element in candidates if isinstance(element, target)]
        if not fitting:
            return _Match(None, "", "XMI023" if candidates else "XMI020")
        found = next((element for element in fitting if element.document is document), fitting[0])
        return _Match(found, unique_name(found), "XMI021" if len(fitting) > 1 else "")

    def problem(self, rule: str, text: str, use: Use) -> None:
        self.problems.setdefault((rule, text), []).append(use)

    def candidates(self, document: Document, text: str) -> list[Element]:
        if text in self.shared:
            return self.shared[text]
        if text in self.by_id:
            return [self.by_id[text]]
        found = self.by_xmi_id[document].get(text)
        if found is not None:
            return [found]
        # APP4MC before 0.9.7 encoded the whole id of some hrefs a second time; people type names without encoding.
        for canonical_references in (unquote(text), _reencoded(text)):
            if canonical_references in self.by_id:
                return self.shared.get(canonical_references, [self.by_id[canonical_references]])
        return []

    @cached_property
    def by_xmi_id(self) -> dict[Document, dict[str, Element]]:
        """Objects by the `xmi:id` in their file, the first of several; for files whose ids are not unique names."""
        return {
            result.document: {xmi_id: element for element, xmi_id in reversed(result.xmi_ids.items()) if element.is_referable}
            for result in self.results
        }

    def proxy(self, text: str, feature: FeaturePlan) -> Element:
        """The unresolved proxy for a text, of the class that the text or its `href` names, or else of the one of the feature."""
        name, mark, class_name = text.rpartition(TYPE_MARK)
        if not mark:
            class_name = next((result.href_types[text] for result in self.results if text in result.href_types), "")
        plan = plans(self.results[0].document.facts_version).of(class_name)
        cls = plan.cls if plan and issubclass(plan.cls, feature.target) else feature.target
        found = self.proxies.get((text, cls))
        if found is None:
            found = self.proxies[text, cls] = object.__new__(cls)
            _set(found, "_container", None)
            _set(found, "_reference", text)
            _set(found, "name", decode((name if mark else text).rpartition("/")[2]))
        return found

    def check_xmi_ids(self, result: ReadResult) -> None:
        """Keep and report every `xmi:id` that is not the unique name, as after renaming an object with a text editor."""
        ids = result.xmi_ids
        # The usual case is that all of them are right.
        are_right = list(map(is_, map(self.by_id.get, ids.values()), ids))
        if all(are_right):
            return
        for element, xmi_id in compress(ids.items(), map(not_, are_right)):
            canonical = unique_name(element) if element.is_referable else ""
            if canonical == xmi_id:
                continue
            result.document.spellings[element, "xmi:id"] = Spelling(xmi_id, canonical)
            if canonical:
                message = f"xmi:id {xmi_id!r} is not the unique name of the object, {canonical!r}"
                help_text = "Correct the id or rename the object; references are resolved by name."
            else:
                message = f"{type(element).__name__} has the xmi:id {xmi_id!r}, but objects of this class cannot be referenced"
                help_text = "Remove the id; it has no effect."
            result.findings.append(
                self.finding("XMI022", Severity.INFO, message, help_text, result.document, element, "xmi:id")
            )

    # Findings

    def findings(self) -> list[Finding]:
        found = [finding for result in self.results for finding in result.findings]
        elsewhere: dict[Document, list[tuple[str, Use]]] = {}
        for (rule, text), uses in self.problems.items():
            document, holder, feature, is_href = min(uses, key=self.position)
            hint = self.near(text) if rule == "XMI020" else ""
            if rule == "XMI020" and is_href and not hint:
                for use in uses:
                    elsewhere.setdefault(use.document, []).append((text, use))
                continue
            severity, message, help_text = self.describe(rule, text, feature)
            times = f" ({len(uses)} references, this is the first)" if len(uses) > 1 else ""
            found.append(self.finding(rule, severity, message + times, hint + help_text, document, holder, feature.xml_name))
        found += [self.missing_files(document, uses) for document, uses in elsewhere.items()]
        paths = [result.document.path for result in self.results]
        return sorted(found, key=lambda f: _file_order(f, paths))

    def position(self, use: Use) -> tuple[int, int]:
        """The order of uses: the number of the file, and the offset of the object."""
        source = use.document.source
        assert source
        return self.numbers[use.document], source.starts[source.index[use.holder]]

    def missing_files(self, document: Document, uses: list[tuple[str, Use]]) -> Finding:
        """One finding for all references from a document to files that were not loaded."""
        uses = sorted(uses, key=lambda use: self.position(use[1]))
        texts = list(dict.fromkeys(text for text, _ in uses))
        shown = ", ".join(map(repr, texts[:3])) + (f" and {len(texts) - 3} more" if len(texts) > 3 else "")
        message = f"{counted(len(uses), 'reference')} to {counted(len(texts), 'object')} in files that were not loaded: {shown}"
        help_text = "Load these files too, or the whole directory. The references are preserved when the file is saved."
        _, first = uses[0]
        return self.finding("XMI025", Severity.WARNING, message, help_text, document, first.holder, first.feature.xml_name)

    def describe(self, rule: str, text: str, feature: FeaturePlan) -> tuple[Severity, str, str]:
        where = f"{feature.xml_name!r} refers to {text!r}"
        if rule == "XMI020":
            return (
                Severity.WARNING,
                f"unresolved reference: {where}, which does not exist",
                "Correct the reference, or add the object.",
            )
        if rule == "XMI021":
            candidates = self.candidates(self.results[0].document, text)
            places = [self.place(element) for element in candidates[:MAX_PLACES]]
            more = f" and {len(candidates) - MAX_PLACES:,} more" if len(candidates) > MAX_PLACES else ""
            return (
                Severity.WARNING,
                f"ambiguous reference: {where}, and {len(candidates)} objects match",
                f"The first one is used. Rename all but one of them: {', '.join(places)}{more}.",
            )
        if rule == "XMI023":
            return (
                Severity.ERROR,
                f"{where}, which is not a {feature.target.__name__}",
                "Refer to an object of the right class. The reference counts as unresolved.",
            )
        target = self.candidates(self.results[0].document, text)[0]
        return (
            Severity.INFO,
            f"{where} instead of {unique_name(target)!r}",
            "Write the unique name of the object. The reference is resolved nevertheless.",
        )

    def near(self, text: str) -> str:
        """A suggestion of the object that may be meant, "" if there is none."""
        return self.suggestions.advice(text, self.by_id, cutoff=0.8)

    def place(self, element: Element) -> str:
        document = element.document
        assert document
        assert document.source
        assert document.path
        line, _ = document.source.position_of(element)
        return f"{document.path.name}:{line}"

    def finding(
        self, rule: str, severity: Severity, message: str, help_text: str, document: Document, element: Element, attribute: str
    ) -> Finding:
        where = document.location_of(element, attribute)
        return Finding(rule, severity, message, where, help_text, element.qualified_name)


def _reencoded(text: str) -> str:
    """The unique name for a reference whose segments are not encoded, or in another way."""
    path, mark, class_name = text.rpartition(TYPE_MARK)
    return "/".join(encode(decode(segment)) for segment in path.split("/")) + mark + class_name


def _file_order(finding: Finding, paths: list[Path | None]) -> tuple[int, int, int]:
    place = finding.location
    if place is None:
        return (len(paths), 0, 0)
    return (paths.index(place.path), place.line or 0, place.column or 0)
