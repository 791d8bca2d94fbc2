"""Rules that people write: drafted, catalogued, added and removed."""
