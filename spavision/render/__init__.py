"""Synthetic photographs with known truth, by a camera model of their own."""
