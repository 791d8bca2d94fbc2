"""From an observation to statements, and facts back."""
