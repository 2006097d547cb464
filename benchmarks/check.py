"""How long `amuros check` takes on a model, all profiles, rule by rule: python benchmarks/check.py"""

from __future__ import annotations

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time

from load_save import write_model

from amalthea_uros import check, load
from amalthea_uros.validate import registry


def main() -> None:
    parser = argparse.ArgumentParser(description="Measures the rules.")
    parser.add_argument("--elements", type=int, default=60000, help="size of the synthetic model (60000)")
    parser.add_argument("--repeat", type=int, default=5, help="measurements (5)")
    parser.add_argument("--model", type=Path, help="a file to measure instead")
    options = parser.parse_args()
    with TemporaryDirectory() as folder:
        path = options.model or Path(folder) / "synthetic.amxmi"
        if options.model is None:
            write_model(options.elements, path)
        size = path.stat().st_size
        times, findings = [], 0
        for _ in range(options.repeat):
            # A model of its own for each, as nothing that was found out about it may be kept.
            model = load(path)
            start = process_time()
            findings = len(check(model))
            times.append(process_time() - start)
    rules = sum(1 for _ in registry.ids())
    number = sum(1 for _ in model.walk())
    print(f"{size / 1e6:.1f} MB, {number} objects, {rules} rules, {findings} findings: {min(times):.2f} s after loading")


if __name__ == "__main__":
    main()
