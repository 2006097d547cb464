"""Every attribute of the objects of an AMALTHEA model as a key whose value can be changed."""
