"""What the tools of Timing Architects ask of a model beyond APP4MC, under their own ids."""
