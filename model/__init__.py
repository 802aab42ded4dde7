"""Finite-element model of the bimodal soft pneumatic actuator."""
