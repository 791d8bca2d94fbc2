"""Verbs: WordNet's senses, Levin's classes, VerbNet's frames, and how primitives link to them."""
