"""Files of any version as one set of nodes in which every reference is a link to its target, so that no change can break one."""
