"""Checks of rule files: text, words, safety, and what they do in every possible segment."""
