"""Reduced model: one cell in three dimensions and a planar rod of such cells, for sweeps."""
