"""Which effort an adverb asks for."""

import tomllib
from collections.abc import Iterable
from functools import cache
from importlib import resources

from capar.regeneration.manner.efforts import Effort


@cache
def adverbs() -> dict[str, Effort]:
    """The effort of each adverb of the table ``adverbs.toml``."""
    text = resources.files(__package__).joinpath("adverbs.toml").read_text("utf-8")
    return {word: Effort(**row) for word, row in tomllib.loads(text).items()}


def effort_of_words(words: Iterable[str]) -> Effort | None:
    """The effort that some words ask for together, no further than to a pole; None if none does.

    Args:
        words: Adverbs; those that are not in the table ask for none.
    """
    found = [adverbs()[word] for word in words if word in adverbs()]
    if not found:
        return None
    sums = {name: sum(effort.values[name] for effort in found) for name in Effort().values}
    return Effort(**{name: max(-1.0, min(1.0, value)) for name, value in sums.items()})


def told_of_words(words: Iterable[str], *, stated: bool) -> list[str]:
    """What is told of the effect of some words.

    Args:
        words: Adverbs and others that name no action, thing or place.
        stated: Whether an effort is stated besides, which is then taken.
    """
    out = []
    for word in words:
        if word not in adverbs():
            out.append(f"{word!r} has no effect")
        elif stated:
            out.append(f"{word!r} has no effect, since an effort is stated")
        else:
            out.append(f"{word!r} asks for the effort {adverbs()[word]}")
    return out
