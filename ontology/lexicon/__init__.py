"""Words as data: verbs of WordNet 3.1, Levin's classes, and what is claimed of both."""
