"""The commands below ``spavision study``."""
