"""The values of hundreds of callbacks are found in steps that grow with their number only."""

from growth import SIZES, growth

from amalthea_uros.design.description.built_objects import BuiltObjects
from amalthea_uros.uros.described import describe_text


def _asked(count):
    timers = "\n".join(f"        - {{name: T{n}, period: 100 ms, execution_time: 4 us}}" for n in range(count))
    found = describe_text(
        "amuros: 1\nname: many\nhardware: single-core\nmiddleware: {transport: {can: {bitrate: 250 kbit/s}}}\n"
        f"application:\n  nodes:\n    - name: node\n      timers:\n{timers}\n"
    )
    # New ones each time: what is found is kept with them.
    return found, [f"T{n}" for n in range(count)]


def _stated(asked):
    found, names = asked
    built = BuiltObjects(found, "")
    return [built.execution_time(name)[0].path for name in names]


def test_each_execution_time_is_found_without_looking_at_all_others():
    assert _stated(_asked(2))[1] == ("application", "nodes", 0, "timers", 1, "execution_time")
    assert growth(_stated, [_asked(size) for size in SIZES]) < 2.2
