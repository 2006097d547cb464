"""0.8.3 -> 0.9.0: the hardware model, which was built anew.

Systems, ECUs and microcontrollers are structures; cores, memories and networks are modules in them; their types are definitions;
quartzes are frequency domains; access paths are access elements of the cores. Objects are changed where they are, so that what refers
to them refers to their successors.
"""
