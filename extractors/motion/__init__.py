"""When and how bodies move and rest."""
