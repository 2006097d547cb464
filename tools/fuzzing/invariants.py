"""What must hold for every file, whatever it contains. An invariant gets a file and a folder for what it writes."""

from __future__ import annotations

import json
import shutil
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from pathlib import Path
from random import Random
from typing import NoReturn

from lxml import etree
from state_charts import check_trace
from templating import ROOT

from amalthea_uros._internal.paths import is_description
from amalthea_uros.analyze.results.analysis import Analysis
from amalthea_uros.diagnostics import Location, Severity
from amalthea_uros.difference.comparison import ChangeKind
from amalthea_uros.errors import AmurosError, WriteError
from amalthea_uros.judge.verdict import Verdict
from amalthea_uros.metamodel.model import Model
from amalthea_uros.services.analyze import analyze_files
from amalthea_uros.services.check import check_files
from amalthea_uros.services.diff import diff
from amalthea_uros.services.fix import fix_files
from amalthea_uros.services.format import format_files
from amalthea_uros.services.simulate import simulate_files
from amalthea_uros.services.subject import open_system
from amalthea_uros.simulate.options import Options, SimulationMode
from amalthea_uros.units import Duration
from amalthea_uros.xmi.load import load
from amalthea_uros.xmi.save import save
from fuzzing.commands import InvariantError, require, require_visible, run
from fuzzing.contradictions import contradictions
from fuzzing.models import require_broken

Invariant = Callable[[Path, Path], None]

#: Of simulations that are compared with an analysis, in picoseconds.
_SHORT = 20 * 10**9
#: What build options are checked with.
_WITH_POOLS = ROOT / "samples" / "drive-and-lift.yaml"
#: An application on a bus of which others' frames are in a database.
_ON_BUS = """
amuros: 1
name: on-bus
hardware: {frequency: 100 MHz, cores: 1}
middleware:
  executor: {loop: {spin_some: 100 ms, sleep: 10 ms}}
  transport: {can_fd: {bitrate: 500 kbit/s, data_bitrate: 2 Mbit/s, dbc: bus.dbc}}
application:
  nodes:
    - name: n
      subscriptions: [{name: On_A, topic: a, message_size: 8 B, rate: 1 Hz, execution_time: 10 us, reliability: best-effort}]
"""
#: What files are compared and combined with.
_OTHER = ROOT / "samples" / "pump-1.2.0.amxmi"


def _no_constant(text: str) -> NoReturn:
    raise InvariantError(f"{text} is not JSON")


def _check_json(path: Path) -> None:
    json.loads(path.read_text(encoding="utf-8"), parse_constant=_no_constant)


def _check_xml(path: Path) -> None:
    etree.parse(path)


def _check_commands(path: Path) -> None:
    """Each line is one command of GitHub Actions."""
    text = path.read_text(encoding="utf-8")
    require_visible(text)
    require(all(line.startswith("::") for line in text.splitlines()), "a line is not a command")


def _check_text(path: Path) -> None:
    require_visible(path.read_text(encoding="utf-8"))


def check(path: Path, folder: Path) -> None:
    """Rules end with a report that parses in each format."""
    parsers = {"json": _check_json, "sarif": _check_json, "junit": _check_xml, "github": _check_commands}
    outputs = [part for name in parsers for part in ("--output", f"{name}={folder / name}")]
    run("check", path, "--output", "text", *outputs)
    for name, parse in parsers.items():
        if (folder / name).exists():
            parse(folder / name)


def analyze(path: Path, folder: Path) -> None:
    """The exit code follows the closing line, and no verdict is better than what is known."""
    report = folder / "analysis.json"
    ended = run("analyze", path, "--output", "text", "--output", f"json={report}")
    closing = [
        line for line in (ended.out + ended.err).splitlines() if line.startswith(("Schedulable: ", "Not proved schedulable: "))
    ]
    if ended.code == 2:
        return
    if not closing:
        require(ended.code == 1 and "error: " in ended.err, "neither a closing line nor an error in the description")
        return
    require(len(closing) == 1, f"{len(closing)} closing lines")
    require((ended.code == 1) == closing[0].startswith("Schedulable: no"), f"exit code {ended.code} after {closing[0]!r}")
    _check_json(report)


def simulate(path: Path, folder: Path) -> None:
    """A short simulation ends, with a result that parses, and traces of which the events are in a possible order."""
    report, traces = folder / "simulation.json", [folder / "run.btf", folder / "run.csv"]
    written = [part for trace in traces for part in ("--trace", trace)]
    run("simulate", path, "--duration", "20ms", *written, "--output", f"json={report}")
    if not report.exists():
        require(not any(trace.exists() for trace in traces), "an error left a trace")
        return
    _check_json(report)
    for trace in traces:
        found = check_trace(trace)
        require(not found, f"{trace.name}: {found[:1]}")


def campaign(path: Path, folder: Path) -> None:
    """Each run has a row, and runs of the same seed are equal."""
    tables = [folder / "first.json", folder / "again.json"]
    for table in tables:
        ended = run("simulate", path, "--duration", "5ms", "--runs", "2", "--jobs", "1", "--table", table)
        if not table.exists():
            require(ended.code != 0, "exit code 0 without a table")
            return
    first, again = (json.loads(table.read_text(encoding="utf-8"), parse_constant=_no_constant) for table in tables)
    require(len(first) == 2, f"{len(first)} rows")
    require(first == again, "equal runs differ")


def agreement(path: Path, _folder: Path) -> None:
    """Nothing is met that depends on something unknown, and no simulation shows what the analysis says cannot be."""
    try:
        analysis = analyze_files(path).analysis
        _require_known(analysis)
        require_broken(path, analysis)
        for mode in (SimulationMode.SAMPLED, SimulationMode.WORST):
            simulation = simulate_files(path, Options(duration=Duration(_SHORT), mode=mode)).simulation
            found = list(contradictions(analysis, simulation))
            require(not found, f"{mode}: {found[:1]}")
    except AmurosError:
        return


def _require_known(analysis: Analysis) -> None:
    for process in analysis.processes:
        known = process.response is not None and process.response.worst is not None
        require(process.verdict is not Verdict.MET or known, f"{process.name} meets its deadline with an unknown response time")
    for requirement in analysis.requirements:
        known = requirement.verdict is not Verdict.MET or requirement.limit is None or requirement.value is not None
        require(known, f"{requirement.name} is met with an unknown value")


def chains(path: Path, folder: Path) -> None:
    """A path between any two ends can be added as a chain, which changes nothing else."""
    try:
        system = open_system([path]).system
    except AmurosError:
        return
    ends = [*system.processes, *system.runnables, *system.labels]
    rng = Random(path.stat().st_size)
    for number in range(min(3, len(ends))):
        target = folder / f"{number}.amxmi"
        start, end = rng.choice(ends), rng.choice(ends)
        ended = run("chains", path, f"--from={start}", f"--to={end}", "--add", "added", "-o", target)
        require(target.exists() == (ended.code == 0), f"exit code {ended.code} with or without a file")
        if target.exists():
            changes = diff(path, target).changes
            others = [change for change in changes if change.kind is not ChangeKind.ADDED and change.class_name != "Amalthea"]
            require(not others, f"something else changed: {others[:1]}")


def build(path: Path, folder: Path) -> None:
    """What is built can be read without findings; what cannot be built leaves no file."""
    target = folder / "built.amxmi"
    ended = run("build", path, "-o", target)
    require(
        target.exists() == (ended.code == 0),
        f"exit code {ended.code}, but the file {'exists' if target.exists() else 'is missing'}",
    )
    if target.exists():
        require(not load(target).findings, "the model that was built has findings")


def same_model(path: Path, folder: Path) -> None:
    """Building twice gives the same bytes, and the model that was built means what the description means."""
    first, again = folder / "first.amxmi", folder / "again.amxmi"
    if run("build", path, "-o", first).code != 0:
        return
    run("build", path, "-o", again)
    require(first.read_bytes() == again.read_bytes(), "two builds differ")
    described, built = open_system([path]).system, open_system([first]).system
    for part in ("executors", "network", "chains", "stimuli"):
        require(
            getattr(described, part) == getattr(built, part), f"{part} of the model that was built differ from those described"
        )
    results = [analyze_files(file).analysis for file in (path, first)]
    for kind in ("processes", "executors", "chains", "requirements"):
        of_description, of_model = ([*map(_figures, getattr(result, kind))] for result in results)
        require(
            of_description == of_model,
            f"{kind} differ between description and model: {_first_difference(of_description, of_model)}",
        )


#: Parts of results that depend on where they are described.
_PLACES_AND_WORDS = ("origin", "finding", "reason")


def _figures(value: object) -> object:
    """A result without places in files."""
    if is_dataclass(value):
        return [
            (part.name, _figures(getattr(value, part.name))) for part in fields(value) if part.name not in _PLACES_AND_WORDS
        ]
    if isinstance(value, Mapping):
        return {str(key): _figures(item) for key, item in value.items()}
    if isinstance(value, Iterable) and not isinstance(value, str):
        return [*map(_figures, value)]
    return None if isinstance(value, Location | Path) else str(value)


def _first_difference(one: object, other: object) -> str:
    """The first values that differ, which are as deep as possible."""
    if isinstance(one, list | tuple) and isinstance(other, list | tuple) and len(one) == len(other):
        return next((_first_difference(*pair) for pair in zip(one, other, strict=True) if pair[0] != pair[1]), "")
    return f"{one!s:.200} and {other!s:.200}"


def generate(path: Path, folder: Path) -> None:
    """Options that were generated are sufficient, and are not generated differently again."""
    texts = []
    for target in (folder / "first", folder / "again"):
        ended = run("generate", path, "-o", target)
        require(target.exists() == (ended.code == 0), f"exit code {ended.code} with or without files")
        texts.append({file.name: file.read_bytes() for file in sorted(target.iterdir())} if target.exists() else {})
    require(texts[0] == texts[1], "two runs differ")
    if "colcon.meta" in texts[0]:
        report = folder / "check.json"
        ended = run(
            "generate", path, "--check", folder / "first" / "colcon.meta", "--output", "text", "--output", f"json={report}"
        )
        require(ended.code == 0, f"what was generated is not accepted: {ended.out[:300]}{ended.err[:300]}")
        _check_json(report)


def message_chains(path: Path, folder: Path) -> None:
    """Times of the hops of a chain add up, in each format."""
    report = folder / "analysis.json"
    run("analyze", path, "--output", f"json={report}")
    try:
        found = analyze_files(path).analysis.message_chains
    except AmurosError:
        return
    for chain in found:
        known = [hop.worst for hop in chain.hops if hop.worst is not None]
        require(
            all(hop.best <= hop.worst for hop in chain.hops if hop.worst is not None),
            f"a hop of {chain.name} has crossed bounds",
        )
        require(chain.worst is None or (bool(chain.hops) and chain.worst == sum(known)), f"hops of {chain.name} do not add up")
        require(chain.worst is None or len(known) == len(chain.hops), f"{chain.name} is bounded, but a hop is not")
        require(chain.worst is not None or bool(chain.reason), f"{chain.name} is unknown without a reason")
        run("analyze", path, "--chain", chain.name)
        run("analyze", path, "--explain", chain.name)


def import_code(path: Path, folder: Path) -> None:
    """What is imported is a description with gaps, and is written again in the same way."""
    first, again = folder / "first.yaml", folder / "again.yaml"
    for target in (first, again):
        ended = run("import", path, "-o", target)
        require(target.exists() == (ended.code != 2), f"exit code {ended.code} with or without a file")
    if first.exists():
        require(first.read_bytes() == again.read_bytes(), "two runs differ")
        for command in ("check", "analyze"):
            require("TODO" not in first.read_text(encoding="utf-8") or run(command, first).code != 0, "a gap is accepted")


def meta(path: Path, folder: Path) -> None:
    """Whatever build options are, there is a sentence about them."""
    report = folder / "check.json"
    ended = run("generate", _WITH_POOLS, "--check", path, "--output", "text", "--output", f"json={report}")
    if ended.code != 2:
        _check_json(report)


def database(path: Path, folder: Path) -> None:
    """Whatever a database of frames is, it is used, or there is a sentence about it."""
    shutil.copyfile(path, folder / "bus.dbc")
    description = folder / "app.yaml"
    description.write_text(_ON_BUS, encoding="utf-8")
    for command in ("check", "analyze"):
        run(command, description)


def info(path: Path, folder: Path) -> None:
    """A summary parses."""
    report = folder / "info.json"
    if run("info", "--schema", path, "--output", f"json={report}").code != 2:
        _check_json(report)


def migrate(path: Path, folder: Path) -> None:
    """What is migrated can be read again."""
    target = folder / "migrated.amxmi"
    if run("migrate", path, "-o", target).code != 2:
        load(target)


def load_and_save(path: Path, folder: Path) -> None:
    """A model that is written as it was read is the same file."""
    model = _loaded(path)
    if model is None or any(document.migrated_from for document in model.documents):
        return
    target = folder / path.name
    try:
        save(model, target)
    except WriteError:
        require(not target.exists(), "an error left a file")
        return
    _require_equal(path, target)
    # A ZIP is compressed again.
    is_same = _is_zip(path) or target.read_bytes() == path.read_bytes()
    require(is_same, "a model that nobody changed is written differently")


def canonical(path: Path, folder: Path) -> None:
    """Canonical form means the same, and is its own canonical form."""
    target = folder / path.name
    shutil.copyfile(path, target)
    if format_files(target).findings:
        require(target.read_bytes() == path.read_bytes(), "an error changed the file")
        return
    _require_equal(path, target)
    require(not format_files(target).changed, "canonical form changes when it is formatted again")


def fix(path: Path, folder: Path) -> None:
    """Repairs are done in one run, and leave no more errors than there were."""
    target = folder / path.name
    shutil.copyfile(path, target)
    before = _errors(target)
    try:
        fix_files(target)
    except AmurosError:
        require(target.read_bytes() == path.read_bytes(), "an error changed the file")
        return
    after = _errors(target)
    if before is not None and after is not None:
        require(after <= before, f"{after} errors after repairs, {before} before")
    require(not any(model.repaired for model in fix_files(target).models), "repairs need a second run")


def _errors(path: Path) -> int | None:
    """The number of errors; None if the rest of them is unknown, because the file is not well-formed."""
    findings = check_files(path).findings
    if any("not well-formed" in finding.message for finding in findings):
        return None
    return sum(finding.severity is Severity.ERROR for finding in findings)


def comparison(path: Path, folder: Path) -> None:
    """A file does not differ from itself, and two files differ in both directions or in none."""
    ended = run("diff", path, path)
    if "error: " in ended.err:
        return
    require(ended.code == 0, "the file differs from itself")
    codes = {run("diff", *pair, "--output", f"json={folder / 'diff.json'}").code for pair in ((path, _OTHER), (_OTHER, path))}
    require(len(codes) == 1, f"exit codes {codes}")


def previews(path: Path, folder: Path) -> None:
    """What only shows a change writes nothing."""
    target = folder / path.name
    shutil.copyfile(path, target)
    for command in (("check", "--fix", "--diff"), ("fmt", "--diff"), ("fmt", "--check")):
        run(*command, target, is_raw="--diff" in command)
        require(target.read_bytes() == path.read_bytes(), f"{' '.join(command)} changed the file")


def several(path: Path, folder: Path) -> None:
    """A model of several files, of which some objects have the same names, does not break a command."""
    shutil.copyfile(path, folder / f"copy{path.suffix}")
    shutil.copyfile(_OTHER, folder / "other.amxmi")
    for command in ("check", "info", "analyze", "simulate", "fmt"):
        run(command, *sorted(folder.iterdir()), *(("--duration", "2ms") if command == "simulate" else ()))
    run("check", folder)


def _loaded(path: Path) -> Model | None:
    try:
        return load(path)
    except AmurosError:
        return None


def _is_zip(path: Path) -> bool:
    return path.read_bytes().startswith(b"PK")


def _require_equal(old: Path, new: Path) -> None:
    changes = diff(old, new).changes
    require(not changes, f"the model changed: {changes[:1]}")


_OF_BOTH: tuple[Invariant, ...] = (check, analyze, simulate, campaign, agreement, comparison)
_OF_DESCRIPTIONS: tuple[Invariant, ...] = (build, same_model, generate, message_chains, *_OF_BOTH)
_OF_MODELS: tuple[Invariant, ...] = (
    info,
    load_and_save,
    canonical,
    fix,
    previews,
    migrate,
    several,
    chains,
    *_OF_BOTH,
)


_OF_OTHERS: dict[str, tuple[Invariant, ...]] = {
    ".meta": (meta,),
    ".dbc": (database,),
    **dict.fromkeys((".c", ".cpp", ".ino"), (import_code,)),
}


def invariants_of(path: Path) -> Iterator[Invariant]:
    """What must hold for a file."""
    yield from _OF_OTHERS.get(path.suffix) or (_OF_DESCRIPTIONS if is_description(path) else _OF_MODELS)
