"""Models of older AMALTHEA versions, ITEA 1.1.0 to 3.3.0, one version on (or back) per step.

A set of files becomes one `ModelSet` of nodes in which every reference is a link to its target, so that no step can break one. The
steps change the nodes; every node keeps the place in the file from which it comes.
"""
