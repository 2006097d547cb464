"""Between the generic performance model and AMALTHEA: `build` makes one of the other, `extract` goes the way back.

Where both have objects of the same shape, a table says which class stands for which and which feature for which field. It drives
both directions, so that they are inverse to each other by construction. What is shaped differently is written by hand, both ways in
one file.
"""
