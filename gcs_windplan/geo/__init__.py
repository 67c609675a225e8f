"""The globe as planning sees it: projections that are fitted by polynomials."""
