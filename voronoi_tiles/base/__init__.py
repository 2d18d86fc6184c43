"""What everything else rests on: errors, tolerances, files, units, arrays, maps of the plane."""
