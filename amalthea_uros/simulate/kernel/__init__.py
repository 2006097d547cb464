"""The hot loop of the simulation: it executes a program event by event, in whole time units.

Everything here is in the subset of Python that numba compiles and works on one array of whole numbers (`layout`); interpreted, that is
a list. Nothing here is random and nothing is a fraction: random values and the occurrences of external stimuli are numbers that the
driver has put into the array. Records are named by what they are: `process` is the place of the record of a process.

The order within an instant: executions that end now end, and their jobs continue to their next execution; stimuli and alarms occur;
budgets are replenished; the cores are given to the most urgent jobs, which continue to their next execution. This repeats until
nothing changes.

The kernel can stop anywhere for the driver and continues where it was: an operation either has its whole effect or none.
"""
