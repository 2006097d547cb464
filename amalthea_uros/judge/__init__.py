"""Met, missed, unknown, observed: the one place that decides, for analysis, simulation and measurement.

Who asks lists the limits of a system (`limits`) and delivers what is known of each quantity (`evidence`); `verdict` decides,
and `summary` says what follows for the whole system.
"""
