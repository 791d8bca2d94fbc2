"""How well segments agree with labels that people gave."""
