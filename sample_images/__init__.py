"""Sample photographs (renders with known truth), one folder a crimp ratio."""
