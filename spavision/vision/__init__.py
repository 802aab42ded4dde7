"""Measuring the actuator in photographs: board lattice, marker, parallax, uncertainty."""
