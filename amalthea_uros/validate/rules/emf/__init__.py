"""The checks that EMF derives from the metamodel, the checks of the AMALTHEA classes themselves, and EMF's form of files."""
