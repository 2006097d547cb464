"""AMALTHEA models by means of pyecore, the general EMF implementation for Python: the measure to compare with.

The metamodel is built from our facts; loading and saving is that of pyecore's `XMIResource`, with what follows as the only
additions. None of them costs time worth mentioning, and the second one saves a lot.

- Restricted numbers and addresses (`PositiveDouble`, `Address`) become data types with readers of their own, because pyecore
  leaves values of types that it does not know as text and then refuses the text as a number. Map entries become ordinary
  classes.
- References are written as the ids of their targets. pyecore resolves `name?type=Class` when reading, since the ids are in the
  file as `xmi:id`, but it would write positions such as `//@swModel/@labels.17`, each found by a search through the list.
- The ids are written again for the objects that had them. pyecore's own way gives all objects of a resource an id or none.
- References to other files (`amlt:/#...`) are looked up in all resources of the resource set; pyecore takes `amlt:/` for the
  name of a file.

Files must hold `xmi:id`, hence be of AMALTHEA 0.9.7 or later.
"""

from __future__ import annotations

from functools import cache, partial
from typing import TYPE_CHECKING, Any

from files import file_version
from pyecore import ecore
from pyecore.resources import ResourceSet
from pyecore.resources.xmi import XMI_URL, XMIOptions, XMIResource

from amalthea_uros.metamodel.factfile import FeatureFact, FeatureKind, NumberFact
from amalthea_uros.metamodel.versions import OLDEST_SUPPORTED, VersionFacts, facts, newest_version, supported_versions

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from lxml import etree

_FOLDER = "amlt:/#"
_XMI_ID = f"{{{XMI_URL}}}id"


def load(path: Path) -> AmaltheaResource:
    """The resource of one file, its references resolved; the model is `contents[0]`."""
    return next(iter(load_all([path])))


def load_all(paths: Iterable[Path]) -> list[AmaltheaResource]:
    """The resources of the files of a folder, which may refer to each other."""
    resources = ResourceSet()
    resources.resource_factory["amxmi"] = AmaltheaResource
    for path in paths:
        package = metamodel(file_version(path))
        resources.metamodel_registry[package.nsURI] = package
        resources.get_resource(str(path))
    return list(resources.resources.values())


def save(resource: AmaltheaResource, path: Path) -> None:
    """Writes the model of a resource to another file, values equal to the default included as APP4MC does."""
    resource.save(output=str(path), options={XMIOptions.SERIALIZE_DEFAULT_VALUES: True})


class AmaltheaResource(XMIResource):
    """An XMI resource whose references are ids."""

    def __init__(self, uri: Any = None, use_uuid: bool = False) -> None:
        super().__init__(uri, use_uuid)
        self.decoders.insert(0, _FolderDecoder)

    def _build_path_from(self, obj: Any) -> tuple[str, bool]:
        if not getattr(obj, "resolved", True):
            return obj._proxy_path, True
        if obj.eResource is self:
            return obj._internal_id, False
        return _FOLDER + obj._internal_id, True

    def _go_across(self, obj: Any, serialize_default: bool = False) -> etree._Element:
        node = super()._go_across(obj, serialize_default)
        if obj._internal_id:
            node.set(_XMI_ID, obj._internal_id)
        return node


class _FolderDecoder:
    """Finds the targets of references to other files."""

    @staticmethod
    def can_resolve(path: str, _: AmaltheaResource) -> bool:
        return path.startswith(_FOLDER)

    @staticmethod
    def resolve(path: str, from_resource: AmaltheaResource) -> Any:
        target = path.removeprefix(_FOLDER)
        for resource in from_resource.resource_set.resources.values():
            if target in resource.uuid_dict:
                return resource.uuid_dict[target]
        raise KeyError(target)


@cache
def metamodel(version: str) -> ecore.EPackage:
    """The Ecore package of a version, without its derived features.

    Raises
    ------
    ValueError : the files of that version hold no ids, or there are no facts of it.
    """
    if version not in supported_versions():
        raise ValueError(f"pyecore reads AMALTHEA {OLDEST_SUPPORTED} to {newest_version()}, not {version}")
    known = facts(version)
    package = ecore.EPackage("amalthea", nsURI=known.namespace, nsPrefix="am")
    for enum in known.enums.values():
        package.eClassifiers.append(ecore.EEnum(enum.name, literals=enum.literals))
    for number in known.numbers.values():
        package.eClassifiers.append(_number_type(number))
    for name in known.classes:
        _add_class(package, known, name)
    for fact in known.classes.values():
        features = [_feature(package, feature) for feature in fact.features if not feature.derived]
        package.getEClassifier(fact.name).eStructuralFeatures.extend(features)
    _add_opposites(package, known)
    return package


def _number_type(number: NumberFact) -> ecore.EDataType:
    if number.name == "Address":
        return ecore.EDataType(number.name, int, from_string=partial(int, base=0), to_string=hex)
    kind = float if number.java_type == "double" else int
    return ecore.EDataType(number.name, kind, from_string=kind)


def _add_class(package: ecore.EPackage, known: VersionFacts, name: str) -> ecore.EClass:
    """The class of that name, added after its supertypes if it is not there yet."""
    found = package.getEClassifier(name)
    if found is None:
        fact = known.classes[name]
        supertypes = tuple(_add_class(package, known, supertype) for supertype in fact.supertypes)
        found = ecore.EClass(name, superclass=supertypes, abstract=fact.abstract)
        package.eClassifiers.append(found)
    return found


def _feature(package: ecore.EPackage, fact: FeatureFact) -> ecore.EStructuralFeature:
    declared = package.getEClassifier(fact.type) or getattr(ecore, fact.type, None)
    if fact.kind is FeatureKind.ATTRIBUTE:
        return ecore.EAttribute(fact.name, declared, defaultValueLiteral=fact.default)
    upper = -1 if fact.many else 1
    return ecore.EReference(fact.name, declared, upper=upper, containment=fact.kind is FeatureKind.CONTAINMENT)


def _add_opposites(package: ecore.EPackage, known: VersionFacts) -> None:
    for fact in known.classes.values():
        for feature in fact.features:
            if feature.kind is FeatureKind.CONTAINMENT and feature.opposite is not None:
                opposite = package.getEClassifier(feature.type).findEStructuralFeature(feature.opposite)
                package.getEClassifier(fact.name).findEStructuralFeature(feature.name).eOpposite = opposite
