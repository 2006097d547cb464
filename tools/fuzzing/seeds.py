"""The files from which those for a reader are made: path within a folder -> content."""

from __future__ import annotations

import gzip
import importlib
import tempfile
from collections.abc import Callable, Sequence
from functools import cache
from io import BytesIO
from pathlib import Path
from random import Random
from zipfile import ZIP_DEFLATED, ZIP_STORED, ZipFile

from templating import ROOT

from amalthea_uros.services.export import export
from amalthea_uros.services.simulate import simulate
from amalthea_uros.trace.sinks import WRITERS, open_sink

Files = dict[str, bytes]

_SAMPLES = ROOT / "samples"
_CORPUS = ROOT.parent / "shared" / "corpus"
_MAX_SIZE = 30_000
_FRAMES = 40
_LOG = b"".join(b"(1.%06d) can0 %03X#%02X00112233\n" % (100 * i, 1 + i % 2, i // 2) for i in range(_FRAMES))
_DBC = b"""VERSION ""\n\nNS_ :\n\nBS_:\n\nBU_: ECU\n
BO_ 1 Debug: 8 ECU
 SG_ Which M : 0|8@1+ (1,0) [0|0] "" ECU
 SG_ Time m0 : 8|16@1- (0.5,-3) [0|0] "us" ECU
 SG_ Job m1 : 24|8@0+ (1,0) [0|0] "" ECU
BO_ 2 Other: 8 ECU
 SG_ Value : 0|32@1- (1,0) [0|0] "ms" ECU\n
SIG_VALTYPE_ 2 Value : 1;
BA_DEF_ BO_ "GenMsgCycleTime" INT 0 65535;
BA_ "GenMsgCycleTime" BO_ 1 10;
"""
_MARKERS = b"A: {value: Debug.Time, unit: us}\nB: {value: Other.Value, unit: ms}\nC: {start: 0x1, end: 0x2, counter: byte 0}\n"
_TABLE = b"start_us,end_us,valid,name\n" + b"".join(b"%d.5,%d,1,x\n" % (10 * i, 10 * i + 3) for i in range(20))
_REPORTS = (
    "average delay: 0.005\n\tmin: 0.004s max: 0.006s std dev: 0.00041s window: 10\n"
    "average delay: 0.006\n\tmin: 0.003s max: 0.009s std dev: 0.00055s window: 20\n",
    "WARNING: topic [/a] does not appear to be published yet\n"
    "average rate: 10.003\n\tmin: 0.099s max: 0.101s std dev: 0.00041s window: 11\n",
)
_SETTINGS = """[tool.amuros.check]
profile = ["timing", "inchron"]
select = ["TIM-OVERLOAD"]
ignore = ["XMI020"]
fail-on = "warning"
baseline = "baseline.json"
targets = ["inchron"]
"""
_IMPORTERS = b'[General]\nfont="a"\n\n[ModelImporter]\nAmaltheaImporter\\commandline="am2inc"\nOther\\filter=x\n'
_SOURCE = (_SAMPLES / "sources" / "int32_publisher.c").read_bytes()
_OWN_FILES = b"""amuros: 1
name: app
hardware: {platform: ./board.yaml}
os: {rtos: ./rtos.yaml}
middleware:
  profile: ./middleware.yaml
  executor: {name: executor, loop: {spin_some: 10 ms}, priority: 5, execution_time: {base: 100 us, per_handle: 5 us}}
  transport: {serial: {baud_rate: 115200}}
  agent: {profile: ./times.yaml}
application:
  nodes:
    - name: node
      publishers: [{topic: a, message_size: 56 B}]
      timers: [{name: Tick, period: 10 ms, execution_time: 1 ms, publishes: [a]}]
"""
_BUILD_FILES = {
    "platformio.ini": b"[env:robot]\nboard = pico\nframework = arduino\nboard_build.f_cpu = 80000000L\n",
    "prj.conf": b"CONFIG_MICROROS=y\nCONFIG_MAIN_STACK_SIZE=2048\n",
    "sdkconfig": b"CONFIG_FREERTOS_HZ=1000\nCONFIG_ESP_DEFAULT_CPU_FREQ_MHZ=160\n",
    "CMakeLists.txt": b"pico_sdk_init()\npico_enable_stdio_usb(app 1)\n",
    "app.meta": (ROOT / "tests" / "hostile" / "comments-and-commas.meta").read_bytes(),
    "my_msgs/msg/Own.msg": b"float64[<=6] positions\nstring<=20 name\nint32 X=5\nmy_msgs/Part[3] parts\n",
    "my_msgs/srv/Add.srv": b"int64 a\nint64[<=4] b  # comment\n---\nmy_msgs/Own sum\nwstring<=9 why\n",
    "my_msgs/action/Count.action": b"int32 goal\n---\nint32[] result\n---\nstring<=8 feedback\n",
    "my_msgs/msg/Wheels.idl": b"module my_msgs { module msg { typedef double d3[3]; struct W { d3 a; sequence<long, 4> t; }; }; };",
}


@cache
def seeds(reader: str) -> Sequence[Files]:
    """The seeds of a reader of `tools/fuzz_readers.py`."""
    return _SEEDS[reader]()


def _files(folder: Path, pattern: str, count: int = 40) -> Sequence[Files]:
    found = [path for path in sorted(folder.rglob(pattern)) if path.is_file() and path.stat().st_size <= _MAX_SIZE]
    return [{f"case{path.suffix}": path.read_bytes()} for path in Random(1).sample(found, min(count, len(found)))]


def _baselines() -> Sequence[Files]:
    return [{"baseline.json": b'{"amuros-baseline": 1, "accepted": {"ab12": "XMI020 x", "cd": "TIM-OVERLOAD"}}\n'}]


def _descriptions() -> Sequence[Files]:
    found = _files(_SAMPLES, "*.yaml", count=80)
    return [files for files in found if not any(word in files["case.yaml"] for word in (b"TODO", b" dbc:"))]


def _own_files() -> Sequence[Files]:
    """Descriptions with files of their own for all that has a name: board, operating system, middleware and measured times."""
    platforms = ROOT / "amalthea_uros" / "platforms"
    middleware = b"amuros: 1\nprofile: mine\nbase: xrce-dds\nsending: {heartbeat: 150 ms}\n"
    middleware += b"sizes: {message_header: 8 B}\noptions: {MTU: 256}\n"
    found = []
    for board, rtos, times in (("esp32", "freertos", "ra6m5-uart"), ("nucleo-f767zi", "zephyr", "pico2w-usb")):
        found.append(
            {
                "app.yaml": _OWN_FILES,
                "board.yaml": (platforms / f"{board}.yaml").read_bytes(),
                "rtos.yaml": (platforms / "rtos" / f"{rtos}.yaml").read_bytes(),
                "times.yaml": (platforms / "measured" / f"{times}.yaml").read_bytes(),
                "middleware.yaml": middleware,
            }
        )
    return found


def _projects() -> Sequence[Files]:
    with tempfile.TemporaryDirectory() as folder:
        for name in ("bodas-test-simple", "robot-xrce"):
            export([_SAMPLES / f"{name}.yaml"], Path(folder) / f"{name}.iprx")
        return [{"case.iprx": path.read_bytes()} for path in sorted(Path(folder).iterdir())]


def _can_logs() -> Sequence[Files]:
    """Those of the extra `can`; .mf4 needs asammdf, which no extra installs, so that its reader would only refuse each file."""
    import can

    found = [{"run.log": _LOG}, {"run.log.gz": gzip.compress(_LOG, mtime=0)}]
    with tempfile.TemporaryDirectory() as folder:
        for suffix in (".asc", ".blf", ".trc"):
            path = Path(folder) / f"run{suffix}"
            with can.Logger(path) as logger:
                for i in range(_FRAMES):
                    logger(can.Message(1 + i / 10_000, arbitration_id=1 + i % 2, data=[i // 2, 0, 1], is_extended_id=False))
            found.append({path.name: path.read_bytes()})
    return found


def _traces() -> Sequence[Files]:
    logs, traces, ctf = (importlib.import_module(name) for name in ("test_scheduler_logs", "traces", "ctf_traces"))
    found = [{"run.txt": text.encode()} for text in (logs.NUTTX, logs.TRACE32)]
    found += [{"run.csv": text.encode()} for text in (logs.SYSTEMVIEW, logs.TRACEALYZER)]
    thread = (5, "worker")
    events = [
        ctf.zephyr_event(1000 * i, name, thread) for i, name in enumerate(6 * ("thread_switched_in", "isr_enter", "isr_exit"))
    ]
    found += [{"metadata": ctf.zephyr_metadata().encode(), "channel0_0": b"".join(events)}]
    found += [{"run.btf.gz": traces.encoded(".btf.gz", traces.random_trace(Random(0)))}]
    found += [_ros2_trace(order) for order in "<>"]
    with tempfile.TemporaryDirectory() as folder:
        for number, suffix in enumerate(WRITERS):
            if suffix in (".btf", ".csv"):
                path, trace = Path(folder) / f"{number}{suffix}", traces.random_trace(Random(number))
                with open_sink(path, trace.entities) as sink:
                    sink.write(trace)
                found.append({f"run{suffix}": path.read_bytes()})
    return found


def _ros2_trace(order: str) -> Files:
    ctf, recorded = (importlib.import_module(name) for name in ("ctf_traces", "test_ctf_reader"))
    writer = ctf.ros2_writer(order)
    events = recorded.ros2_events(writer)
    packets = [writer.packet(recorded.T, events[:7], spare=64), writer.packet(recorded.T, events[7:], 1)]
    return {"metadata": writer.metadata.encode(), "channel0_0": b"".join(packets)}


def _archives() -> Sequence[Files]:
    found = []
    for number, files in enumerate(_models()):
        archive = BytesIO()
        with ZipFile(archive, "w", ZIP_DEFLATED if number % 2 else ZIP_STORED) as target:
            target.writestr("ResourceContents", files["case.amxmi"])
        found.append({"case.amxmi": archive.getvalue()})
    return found


def _calibrations() -> Sequence[Files]:
    """Descriptions with traces of their simulations."""
    found = []
    with tempfile.TemporaryDirectory() as folder:
        for name in ("bodas-test-simple", "drive-and-lift"):
            description, trace = _SAMPLES / f"{name}.yaml", Path(folder) / f"{name}.csv"
            simulate(description, "60 ms", trace_paths=[trace])
            found.append({"app.yaml": description.read_bytes(), "run.csv": trace.read_bytes()})
    return found


def _models() -> Sequence[Files]:
    return [*_files(_SAMPLES, "*.amxmi"), *_files(ROOT / "tests" / "data", "*.amxmi")]


def _older_models() -> Sequence[Files]:
    return _files(_CORPUS, "*.amxmi")


def _recordings() -> Sequence[Files]:
    folder = _SAMPLES / "robot-recording"
    return [{str(path.relative_to(folder)): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}]


def _sources() -> Sequence[Files]:
    programs = [*(_SAMPLES / "sources").iterdir(), *(ROOT / "tests" / "source" / "programs").iterdir()]
    alone = [{path.name: path.read_bytes()} for path in sorted(programs) if path.suffix in (".c", ".cpp", ".ino")]
    return [*alone, *len(alone) * [{"node.c": _SOURCE, **_BUILD_FILES}]]


_SEEDS: dict[str, Callable[[], Sequence[Files]]] = {
    "amxmi": _models,
    "amxmi-analyzed": _models,
    "amxmi-checked": _models,
    "amxmi-compared": _models,
    "amxmi-written": _models,
    "baseline": _baselines,
    "calibration": _calibrations,
    "can": _can_logs,
    "dbc": lambda: [{"run.log": _LOG, "markers.yml": _MARKERS, "bus.dbc": _DBC}],
    "description": _descriptions,
    "description-analyzed": _descriptions,
    "description-checked": _descriptions,
    "editor": _descriptions,
    "importers": lambda: [{"INCHRON/ModelImporter.conf": _IMPORTERS}],
    "iprx": _projects,
    "meta": lambda: _files(ROOT / "tests" / "hostile", "*.meta"),
    "older-amxmi": _older_models,
    "older-amxmi-migrated": _older_models,
    "own-files": _own_files,
    "recording": _recordings,
    "ros-report": lambda: [{"delay.txt": text.encode()} for text in _REPORTS],
    "settings": lambda: [{"pyproject.toml": _SETTINGS.encode(), "model.amxmi": b""}],
    "sources": _sources,
    "table": lambda: [{"values.csv": _TABLE}],
    "trace": _traces,
    "trace-compared": _traces,
    "zip": _archives,
}
