"""Named questions, and their answers as text."""
