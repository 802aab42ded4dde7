"""Constitutive laws, one file a law, and the published parameters."""
