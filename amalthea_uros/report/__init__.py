"""Results for people and programs: each format is one file in `formats`, found by its presence.

`text` and `json` have a module for each result in the folders of these names, which is found by the name of the result's class.
"""
