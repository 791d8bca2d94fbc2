"""A capture to look at in three dimensions: bodies as they moved, with what was found in time."""
