"""From test data to hyperelastic laws: reading, fitting, transition point, report."""
