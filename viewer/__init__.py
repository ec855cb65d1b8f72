"""Everything a person touches: the browser viewer and the command line."""
