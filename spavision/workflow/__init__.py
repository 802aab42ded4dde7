"""From photographs and experiment files to results, for the command line and for Python alike."""
