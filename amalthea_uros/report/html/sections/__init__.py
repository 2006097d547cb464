"""The sections of a page: each module has a function `section` that gives the section, or None if there is nothing to show."""
