"""Captures as bundles that tests read."""

from pathlib import Path

#: The tall man drinks: a closed form, which ``write_demo.py`` wrote; no wrist reaches as his does
DRINKING = Path(__file__).parent / "drink_from_mug"
