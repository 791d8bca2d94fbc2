"""Whether what is stored is whole and right."""
