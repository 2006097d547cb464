"""The checks of APP4MC's own validation, under their original ids (AM), and requirements of its documentation (DOC)."""
