"""Faults of a recording, found by what cannot be: wrong falls, sizes, sides and rests."""
