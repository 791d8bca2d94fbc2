"""How sentences are read: words by class, noun phrases, times, verbs with what belongs to them."""
