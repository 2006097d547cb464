"""The generic performance model: hardware, OS, stimuli, software, mapping, events, constraints; independent of any format.

All classes are frozen dataclasses that refer to each other by name; `System` holds them and finds them by name. Times are
picoseconds, frequencies hertz, data sizes bits (see `units`); execution demand is counted in ticks of the executing core's clock.
"""
