"""Content that the published conversions lose, and that comes back beyond them."""

from __future__ import annotations

#: The first version after those of which the content of ITEA versions was published as converted.
BEYOND_ITEA = "0.7.1"

#: The first version after those that the converters of APP4MC are published for.
BEYOND_CONVERTERS = "0.9.6"
