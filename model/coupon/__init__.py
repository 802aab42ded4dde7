"""Virtual tensile test of the crimped-paper composite: matrix and paper as two constituents."""
