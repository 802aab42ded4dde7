"""Track a soft pneumatic actuator, simulate it with finite elements, and compare the two."""

__version__ = "0.1.0"
