"""Synthetic AMALTHEA models of any size, as APP4MC would write them.

The models have the shape of real engine control models: controllers with cores, memories and buses, their operating systems,
and applications that consist of a task or an interrupt with its stimulus, runnables, labels, allocation, events, chains and
requirements. Some names hold blanks, slashes or umlauts, so that ids are percent-encoded.

    python benchmarks/synthetic.py --elements 60000 -o model.amxmi
"""

from __future__ import annotations

import argparse
from pathlib import Path

from synthesis.applications import add_applications, add_constants
from synthesis.objects import Writer
from synthesis.plan import Plan
from synthesis.platform import new_platform

from amalthea_uros.metamodel.versions import known_versions, newest_version, version_key

OLDEST = "2.0.0"


def synthetic_model(elements: int, version: str = "3.3.0", seed: int = 1) -> str:
    """The text of one file with `elements` XML elements (the platform alone has some 80, which is the least).

    Raises
    ------
    ValueError : if `version` is older than 2.0.0 or unknown.
    """
    (text,) = _texts(elements, version, seed, files=1)
    return text


def synthetic_folder(elements: int, files: int = 4, version: str = "3.3.0", seed: int = 1) -> dict[str, str]:
    """The texts of several files by name: the first holds the platform, the others share the applications.

    The objects of all files are `elements`; references to other files are child elements in addition.
    """
    names = ["platform.amxmi", *(f"applications_{number}.amxmi" for number in range(1, files))]
    return dict(zip(names, _texts(elements, version, seed, files), strict=True))


def _texts(elements: int, version: str, seed: int, files: int) -> list[str]:
    if version not in known_versions() or version_key(version) < version_key(OLDEST):
        raise ValueError(f"AMALTHEA {version}: synthetic models are of {OLDEST} to {newest_version()}")
    plan = Plan(version, seed, files)
    platform = new_platform(plan)
    add_applications(plan, platform, elements)
    add_constants(plan, platform, elements)
    writer = Writer(plan.facts)
    return [writer.text(root) for root in plan.roots]


def main() -> None:
    parser = argparse.ArgumentParser(description="Writes a synthetic AMALTHEA model.")
    parser.add_argument("--elements", type=int, default=60000, help="XML elements of the model (60000)")
    parser.add_argument("--version", default="3.3.0", help="AMALTHEA version (3.3.0)")
    parser.add_argument("--seed", type=int, default=1, help="another number gives another model (1)")
    parser.add_argument("-o", "--output", type=Path, required=True, help="file to write")
    options = parser.parse_args()
    options.output.write_bytes(synthetic_model(options.elements, options.version, options.seed).encode())


if __name__ == "__main__":
    main()
