"""Which combinations of what may vary are tested: those in which each two meet."""

import os
from collections.abc import Mapping, Sequence
from itertools import product
from typing import Any

import pytest

EVERY = os.environ.get("CAPAR_SCENES") == "all"
"""Whether whole families of tests are run, as with `CAPAR_SCENES=all pytest tests`."""


def meeting(
    acts: Sequence[Any], performers: Sequence[Any], recorded: Mapping[str, Any]
) -> list[Any]:
    """Act, performer and recording such that each two of them meet in one case at least.

    Acts and performers meet in each way once, and recordings take turns, so that each act and
    each performer is recorded in each way if there are as many performers as recordings.
    `CAPAR_SCENES=all` takes all combinations of the three.
    """
    numbered = product(enumerate(acts), enumerate(performers), enumerate(recorded.items()))
    return [
        pytest.param(act, performer, options, id=f"{act.__name__}-{performer.name}-{name}")
        for (i, act), (j, performer), (k, (name, options)) in numbered
        if EVERY or (i + j) % len(recorded) == k
    ]


def one_of(cases: Sequence[Any]) -> Sequence[Any]:
    """The last of some cases, which stands for the others; each, if so asked."""
    return cases if EVERY else cases[-1:]


def in_turn(recorded: Sequence[tuple[Any, ...]], cases: Sequence[tuple[Any, ...]]) -> list[Any]:
    """Each case as it is recorded in one way, which take turns; each in all, if so asked."""
    return [
        (*one, *case)
        for i, case in enumerate(cases)
        for j, one in enumerate(recorded)
        if EVERY or (i + j) % len(recorded) == 0
    ]
