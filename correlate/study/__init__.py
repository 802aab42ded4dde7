"""Studies: many model runs under uncertain inputs, and what they say about the discrepancy."""
