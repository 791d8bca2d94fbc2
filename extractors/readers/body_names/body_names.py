"""Which place of a body each name in a motion file means, by conventions and by words."""

import re
import tomllib
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatchcase
from functools import cache
from importlib.resources import files
from itertools import pairwise
from typing import Any

from extractors.readers.body_names.conventions import Convention, conventions
from extractors.readers.body_names.spelling import matched, spellings, split_name
from extractors.readers.name_guesses import side_of, words_of

Spelled = Mapping[str, list[tuple[str, str]]]

LEAST_NAMES = 4
"""A convention of which fewer names are there is not taken to be followed."""

LEAST_PARTS = 4
"""Names that tell a part, such as ``middle`` or ``back``, and no side, are of a body only beside
so many other parts of it."""

LEAST_SHARE = 0.2
"""... nor one that knows a smaller share of the names than this [1]: short names are common."""

SIDES = ("right", "left")

BY_WORDS = "its words"
"""What a name is known by that no convention knows."""


@dataclass(frozen=True, slots=True)
class BodyName:
    """What one name of a file tells."""

    name: str
    place: str
    """A segment or landmark of the body: ``right_foot``, ``right_heel``, ``c7``."""

    exact: bool
    """Whether the name is of that very place; else it rides somewhere on the segment."""

    by: str
    """The convention's title, or ``BY_WORDS``."""

    subject: str = ""
    """Whose body it is, where names begin with a subject and a colon."""

    @property
    def side(self) -> str:
        """``right``, ``left`` or ``none``."""
        return next((each for each in SIDES if self.place.startswith(f"{each}_")), "none")

    @property
    def part(self) -> str:
        """The part of the body: ``hand``, ``foot``, ``head``, ``pelvis``, ``shank`` ..."""
        return parts()[without_side(self.place)]

    @property
    def height(self) -> float | None:
        """How high it usually is on somebody who stands [share of stature]; None for arms."""
        table = _table("places")
        usual: float | None = table["middles"].get(self.part)
        if self.exact and usual is not None:
            usual = table["heights"].get(without_side(self.place), usual)
        return usual


def without_side(place: str) -> str:
    """A place's name without its side."""
    return place.removeprefix("right_").removeprefix("left_")


@cache
def _table(name: str) -> Mapping[str, Any]:
    folder = files("extractors.readers.body_names") / "data"
    return tomllib.loads((folder / f"{name}.toml").read_text("utf-8"))


@cache
def parts() -> Mapping[str, str]:
    """The part of the body of each place without its side."""
    rows: Mapping[str, list[str]] = _table("places")["parts"]
    return {place: part for part, places in rows.items() for place in places}


def body_names(names: Iterable[str]) -> dict[str, BodyName]:
    """What each name means that is of a body; others are left out.

    The convention that knows most names has its say first, then the next, as long as they know
    ``LEAST_NAMES``; what none knows is known by its words, if they tell a part of the body.
    """
    left = spellings(names)
    least = max(LEAST_NAMES, LEAST_SHARE * len(left))
    out: dict[str, BodyName] = {}
    while found := max((_known(each, left) for each in conventions().values()), key=len):
        if len(found) < least:
            break
        out |= found
        left = {name: each for name, each in left.items() if name not in found}
        least = LEAST_NAMES
    worded = dict(_by_words(left))
    seen = {each.part for each in [*out.values(), *worded.values()]}
    if len(seen) < LEAST_PARTS:
        worded = {name: each for name, each in worded.items() if not _doubtful(each)}
    return out | worded


def _doubtful(found: BodyName) -> bool:
    return found.side == "none" and found.part not in {"head", "pelvis"}


def _known(convention: Convention, spelled: Spelled) -> dict[str, BodyName]:
    out = {}
    for name, (subject, known) in matched(spelled, convention.keys).items():
        exact = known in convention.points
        place = convention.points[known] if exact else convention.on[known]
        out[name] = BodyName(name, place, exact, convention.title, subject)
    return out


def _by_words(names: Iterable[str]) -> Iterator[tuple[str, BodyName]]:
    for name in names:
        subject, bare = split_name(name)
        place = _place(bare)
        if place:
            exact = not any(each.isdigit() for each in bare)
            yield name, BodyName(name, place, exact, BY_WORDS, subject)


def _place(bare: str) -> str:
    """The place that a name's words tell of; an empty string if none does."""
    bare = re.sub(r"\d+$", "", bare)
    bare = re.sub(r"^([LRlr])(?=[A-Z][A-Za-z])", r"\1_", bare)
    words = words_of(bare)
    pairs = {a + b for a, b in pairwise(words)}
    side = next((each for each in SIDES if each[0] in words), side_of(bare))
    for word, place in _table("words")["words"].items():
        if word in words or word in pairs:
            sided = "{side}" in place
            return str(place.format(side=side)) if sided and side != "none" else _unsided(place)
    return ""


def _unsided(place: str) -> str:
    return place.removeprefix("{side}_")


def computed(names: Iterable[str]) -> list[str]:
    """Names of computed quantities among the points of a file, such as angles and moments."""
    patterns = [pattern for each in conventions().values() for pattern in each.computed]
    return [
        name
        for name in names
        if any(fnmatchcase(split_name(name)[1], pattern) for pattern in patterns)
    ]
