"""What an explanation says, computed again from streams, shapes and measured facts alone."""

import re
from collections.abc import Callable

from recomputed import arrangement, contacts, doors, doubts, looks_and_feet, motion, naming, others
from recomputed.known import Known as Known
from recomputed.stories import STORIES as STORIES
from recomputed.stories import told as told

FORMS: tuple[tuple[str, Callable[..., bool]], ...] = (
    *doubts.FORMS,
    *doors.FORMS,
    *contacts.FORMS,
    *motion.FORMS,
    *arrangement.FORMS,
    *looks_and_feet.FORMS,
    *others.FORMS,
    *naming.FORMS,
)
"""Each form of sentence, and how it is recomputed; of several that match, the first."""


def form(sentence: str) -> tuple[str, Callable[..., bool], tuple[str, ...]]:
    """The form of a sentence, its recomputation, and what it is about.

    Raises:
        AssertionError: Nothing recomputes it.
    """
    for pattern, check in FORMS:
        found = re.fullmatch(pattern, sentence)
        if found:
            return pattern, check, found.groups(default="")
    raise AssertionError(f"no recomputation of the sentence {sentence!r}")
