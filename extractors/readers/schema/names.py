"""Names that sensors and objects may bear, made of the names that files give."""

import re


def constant_name(text: str) -> str:
    """Lower-case words joined by underscores: ``HandRight`` is ``hand_right``."""
    words = re.sub(r"[^A-Za-z0-9]+", "_", text).strip("_")
    snake = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", words).lower()
    return snake if snake[:1].isalpha() else f"body_{snake}".rstrip("_")
