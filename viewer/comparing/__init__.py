"""Compare: the picture beside another one, and the selected path beside its twin."""
