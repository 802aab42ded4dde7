"""Discrepancy between the measured and the modelled tip path."""
