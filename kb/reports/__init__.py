"""Reports over what is known: which verbs the system addresses, as text, pages and drawings."""
