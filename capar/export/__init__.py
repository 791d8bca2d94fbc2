"""Motions of fitted bodies as files that other programs read."""
