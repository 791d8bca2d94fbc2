"""The solver and the rule files as values: facts in, atoms out."""
