"""The systems that the player plays are those that the product analyses."""

from effort import every
from opponent.to_perf import to_perf
from opponent.vectors import CONSTRUCTS, needs_vectors, plain_systems

from amalthea_uros.services.inputs import open_system


@needs_vectors
def test_a_converted_system_is_the_one_extracted_from_its_model():
    systems = every(3, list(plain_systems().items()))
    different = [name for name, plain in systems if to_perf(plain) != open_system([CONSTRUCTS / name]).system]
    assert different == []
