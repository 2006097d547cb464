"""What all of this room uses: settings, limits of times, names of quantities, findings and assumptions."""
