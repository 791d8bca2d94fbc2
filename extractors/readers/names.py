"""Which place of a body each name in a motion file means, by conventions and by words."""

import re
import tomllib
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from functools import cache, cached_property
from importlib.resources import files
from itertools import pairwise, takewhile
from typing import Any

from capar.model.errors import CaparError, UnknownNameError
from extractors.readers.recording import Recording

SHARED_BY = 8
"""A beginning or an ending up to a separator that so many names share is none of their own [1]."""

COMMON_LETTERS = 3
"""... and one of so many letters, without a separator, is not if all names share it [1]."""

SIDE_AFFIXES = {"r", "l", "right", "left", "rt", "lt"}
"""What names of one side share, and what belongs to them."""


def key_of(name: str) -> str:
    """A name without its separators and capitals: ``R.Knee_Lat`` and ``rKneeLat`` are one."""
    return re.sub(r"[\W_]+", "", name).lower()


def spellings(names: Iterable[str]) -> dict[str, list[tuple[str, str]]]:
    """For each name, the subjects and bare names that it may consist of, least taken off first.

    ``Anna:LASI`` is Anna's; ``Anna_LASI`` may be, if other names begin so too; ``r_knee_study`` may
    be an ``r_knee`` if others end so.
    """
    split = {name: name.rpartition(":")[::2] for name in names}
    bares = list(dict.fromkeys(bare for _, bare in split.values()))
    beginnings = _beginnings(bares)
    endings = _shared(bare[at.start() :] for bare in bares for at in re.finditer(r"[_ .\-]+", bare))
    out = {}
    for name, (subject, bare) in split.items():
        found = [(subject, bare)]
        for ending in ("", *(each for each in endings if bare.endswith(each))):
            whole = bare.removesuffix(ending)
            found.append((subject, whole))
            found += [
                (subject or own.strip("_ .-"), whole.removeprefix(own))
                for own in beginnings
                if whole.startswith(own)
            ]
        out[name] = [each for each in dict.fromkeys(found) if each[1]]
    return out


def _shared(affixes: Iterable[str]) -> list[str]:
    """The affixes of many names that mean no side; shortest first."""
    many = (each for each, count in Counter(affixes).items() if count >= SHARED_BY)
    return sorted((each for each in many if key_of(each) not in SIDE_AFFIXES), key=len)


def _beginnings(names: list[str]) -> list[str]:
    """What many names begin with up to a separator, and what all begin with; shortest first."""
    cuts = ((name, at.end()) for name in names for at in re.finditer(r"[_ .\-]+", name))
    shared = {*_shared(name[:end] for name, end in cuts)}
    letters = takewhile(lambda column: len(set(column)) == 1, zip(*names, strict=False))
    whole = "".join(column[0] for column in letters)
    if len(names) >= SHARED_BY and len(whole) >= COMMON_LETTERS:
        shared.add(whole)
    return sorted(shared, key=len)


def matched(
    spelled: Mapping[str, list[tuple[str, str]]], keys: Mapping[str, str]
) -> dict[str, tuple[str, str]]:
    """The subject and the known name of each name of which a spelling is known.

    Args:
        spelled: As ``spellings`` gives them.
        keys: Known names by their keys.
    """
    out = {}
    for name, options in spelled.items():
        for subject, bare in options:
            if key_of(bare) in keys:
                out[name] = (subject, keys[key_of(bare)])
                break
    return out


LEAST_SHARE = 0.7
"""Share of a convention's names that a recording has to have to be taken for it [1]."""


class ConventionError(CaparError):
    """Names that are of no known convention."""


@dataclass(frozen=True)
class Convention:
    """Names of joints or key points, and the places on the body that they mean."""

    name: str
    title: str
    source: str
    markers: bool
    """Whether its names are those of markers on the skin, not of joints or key points."""

    points: Mapping[str, str]
    """Segment (its joint with the parent) or site of the body, by foreign name."""

    weights: Mapping[str, float]
    """How much a place counts, where it is not 1 [1]."""

    on: Mapping[str, str] = field(default_factory=dict)
    """Segment by the name of a marker that rides somewhere on it."""

    computed: tuple[str, ...] = ()
    """Patterns of names that its files give to computed quantities, which are no markers."""

    units_m: tuple[float, ...] = ()
    """Units that its files are in without stating them [m]."""

    def named(self, names: Iterable[str]) -> dict[str, str]:
        """The place of each name that it knows, however it is spelled, whoever's it is."""
        found = matched(spellings(names), self.keys)
        return {n: self.points[known] for n, (_, known) in found.items() if known in self.points}

    @cached_property
    def keys(self) -> Mapping[str, str]:
        """Its names by their keys; names of different places that have one key are left out."""
        places: dict[str, set[str]] = {}
        for name, place in (*self.points.items(), *self.on.items()):
            places.setdefault(key_of(name), set()).add(place)
        return {
            key_of(name): name
            for name in (*self.points, *self.on)
            if len(places[key_of(name)]) == 1
        }

    def weight(self, place: str) -> float:
        """How much a place counts [1]."""
        return self.weights.get(place, 1.0)


@cache
def conventions() -> Mapping[str, Convention]:
    """Every convention by name."""
    out = {}
    folder = files("extractors.readers") / "data" / "conventions"
    for file in sorted(folder.iterdir(), key=lambda each: each.name):
        if file.name.endswith(".toml"):
            name, row = file.name.removesuffix(".toml"), tomllib.loads(file.read_text("utf-8"))
            out[name] = Convention(
                name,
                row["title"],
                row["source"],
                markers=row["orientations"] == "markers",
                points=dict(_both_sides(row["points"])),
                weights=row.get("weights", {}),
                on=dict(_both_sides(row.get("on", {}))),
                computed=tuple(row.get("computed", ())),
                units_m=tuple(row.get("units_m", ())),
            )
    return out


def _both_sides(names: Mapping[str, str]) -> Iterator[tuple[str, str]]:
    """Names with their places; those with a placeholder of a side once for each side."""
    for name, place in names.items():
        for side in ("right", "left") if "{" in name else ("none",):
            letter = side[0]
            own = name.format(S=letter.upper(), s=letter, Side=side.title())
            yield own, place.format(side=side)


def convention(name: str) -> Convention:
    """The convention of that name.

    Raises:
        UnknownNameError: There is none.
    """
    if name not in conventions():
        raise UnknownNameError("convention", name, conventions())
    return conventions()[name]


def coverage(names: Iterable[str]) -> dict[str, float]:
    """By convention, the share of its places that some names are of [1]."""
    known = list(names)
    return {
        each.name: len(set(each.named(known).values())) / len(set(each.points.values()))
        for each in conventions().values()
    }


def recognise(names: Iterable[str]) -> Convention:
    """The convention that a recording's names are of: the one of which it has most places.

    Raises:
        ConventionError: It has too few of any.
    """
    known = list(names)
    shares = coverage(known)
    size = {name: len(convention(name).named(known)) for name in shares}
    fits = [name for name, share in shares.items() if share >= LEAST_SHARE]
    if not fits:
        best = max(shares, key=lambda name: shares[name])
        missing = sorted(set(convention(best).points) - {n.rpartition(":")[2] for n in known})
        raise ConventionError(
            f"names of no known convention; nearest is {best!r}, of which there are "
            f"{shares[best]:.0%}, without {', '.join(missing[:6])}; known: {', '.join(shares)}"
        )
    return convention(max(fits, key=lambda name: (size[name], shares[name])))


LIMBS = {
    "hand": ("hand", "wrist", "palm", "main"),
    "head": ("head", "skull", "camera", "hmd"),
    "foot": ("foot", "ankle", "toe"),
}
"""Words in names by which end-effectors are known."""

PARTS = {
    "hand": ("hand", "wrist", "palm", "carpal", "metacarpal", "thumb", "index", "middle", "ring",
             "pinky", "little", "finger", "fingers", "fingertip", "fingertips"),
    "foot": ("foot", "ankle", "heel", "calcaneus", "instep", "midfoot", "sole", "forefoot",
             "toe", "toes"),
}  # fmt: skip
"""What hands and feet consist of, in the words of names; those that act for the whole first."""

AMBIGUOUS = {"index", "middle", "ring", "little"}  # Words for fingers that name other things too.
WHOLES = {"hand": ("hand", "wrist"), "foot": ("foot", "ankle")}
"""Words that name a hand or foot as a whole, and not a part of it."""

_LIMB = r"(?=[A-Z]|hand|wrist|thumb|finger|elbow|arm|foot|ankle|toe|knee|leg|hip)"
"""What may follow a first letter that tells a side: ``lFoot``, ``lfoot``."""

_SIDES = {
    "right": re.compile(
        rf"right|(^|[_.\W])[rR]([_.\W]|$)|^r{_LIMB}|[a-z]Rt?$|^R(?=[A-Z_])|(?<=[a-z])R$|_r$"
    ),
    "left": re.compile(
        rf"left|(^|[_.\W])[lL]([_.\W]|$)|^l{_LIMB}|[a-z]Lf?t?$|^L(?=[A-Z_])|(?<=[a-z])L$|_l$"
    ),
}


def limb_of(name: str) -> str:
    """The end-effector that a name mentions, or an empty string."""
    low = name.lower()
    return next((limb for limb, words in LIMBS.items() if any(w in low for w in words)), "")


def words_of(name: str) -> list[str]:
    """The words of a name, in lower case and without numbers: ``L_Index1`` has ``l``, ``index``."""
    parts = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name)
    return [word for word in re.split(r"[^a-z]+", parts.lower()) if word]


def part_of(name: str) -> tuple[str, int] | None:
    """Which hand or foot a name is a part of, and how far from acting for it; None for no part.

    The palm stands before the fingers and the heel before the toes.
    """
    for limb, words in PARTS.items():
        ranks = [words.index(word) for word in words_of(name) if word in words]
        if ranks:
            return limb, min(ranks)
    return None


def limbs(names: Iterable[str]) -> dict[str, str]:
    """The bodies that are likely end-effectors or parts of one, each with its hand, foot or head.

    Words that mean other things too, such as ``ring``, count where the same side has another part
    of a hand.
    """
    out: dict[str, str] = {}
    doubtful = []
    for name in names:
        part = part_of(name) if side_of(name) != "none" else None
        if part and set(words_of(name)) & AMBIGUOUS and not limb_of(name):
            doubtful.append(name)
        elif limb := limb_of(name) or (part[0] if part else ""):
            out[name] = limb
    hands = {side_of(name) for name, limb in out.items() if limb == "hand"}
    return out | {name: "hand" for name in doubtful if side_of(name) in hands}


def side_of(name: str) -> str:
    """The side that a name mentions: ``right``, ``left`` or ``none``."""
    for side, pattern in _SIDES.items():
        if pattern.search(name) or side in name.lower():
            return side
    return "none"


def end_effectors(recording: Recording) -> dict[str, str]:
    """The bodies of a file that are likely end-effectors, and of which kind.

    In a skeleton these are the first joint of each hand, foot or head, not the fingers below it.
    """
    kinds = {name: limb_of(name) for name in recording.bodies}
    out = {}
    for name, kind in kinds.items():
        above, seen = recording.parents.get(name, ""), {name}
        while above and above not in seen and kinds.get(above) != kind:
            seen.add(above)
            above = recording.parents.get(above, "")
        if kind and (not above or above in seen):
            out[name] = kind
    return out


Spelled = Mapping[str, list[tuple[str, str]]]

LEAST_NAMES = 4  # A convention of which fewer names are there is not taken to be followed.
LEAST_PARTS = 4
"""Names that tell a part, such as ``middle`` or ``back``, and no side, are of a body only beside
so many other parts of it."""

FOLLOWED_SHARE = 0.2
"""... nor one that knows a smaller share of the names than this [1]: short names are common."""

SIDES = ("right", "left")

BY_WORDS = "its words"  # What a name is known by that no convention knows.


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
    folder = files("extractors.readers") / "data"
    return tomllib.loads((folder / f"{name}.toml").read_text("utf-8"))


@cache
def parts() -> Mapping[str, str]:
    """The part of the body of each place without its side."""
    rows: Mapping[str, list[str]] = _table("places")["parts"]
    return {place: part for part, places in rows.items() for place in places}


def body_names(names: Iterable[str]) -> dict[str, BodyName]:
    """What each name means that is of a body; others are left out.

    The convention that knows most names has its say first, then the next, as long as they know
    ``LEAST_NAMES`` or the markers of a hand; what none knows is known by its words, if they tell a
    part of the body.
    """
    left = spellings(names)
    least = max(LEAST_NAMES, FOLLOWED_SHARE * len(left))
    out: dict[str, BodyName] = {}
    while found := max((_known(each, left) for each in conventions().values()), key=len):
        if len(found) < least and not _has_hand(found):
            break
        out |= found
        left = {name: each for name, each in left.items() if name not in found}
        least = LEAST_NAMES
    worded = {}
    for name in left:
        subject, _, bare = name.rpartition(":")
        if place := _place(bare):
            exact = not any(each.isdigit() for each in bare)
            worded[name] = BodyName(name, place, exact, BY_WORDS, subject)
    seen = {each.part for each in [*out.values(), *worded.values()]}
    if len(seen) < LEAST_PARTS:
        worded = {
            name: each
            for name, each in worded.items()
            if each.side != "none" or each.part in {"head", "pelvis"}
        }
    return out | worded


def _has_hand(found: Mapping[str, BodyName]) -> bool:
    """Whether three of the names are places of one hand and its wrist."""
    places = Counter(
        each.side
        for each in found.values()
        if each.part == "hand" or without_side(each.place).startswith("wrist")
    )
    return any(places[side] >= 3 for side in SIDES)


ABOVE = {
    "fingers": "hand", "hand": "forearm", "forearm": "upper_arm", "upper_arm": "trunk",
    "toes": "foot", "foot": "shank", "shank": "thigh", "thigh": "pelvis",
    "head": "trunk", "trunk": "pelvis",
}  # fmt: skip
"""The part that each place or part of the body hangs on."""


def parents_by_names(names: Iterable[str]) -> dict[str, str]:
    """Parents in skeletons of which a file states none, by what the names tell.

    Names of a subject, ``SUBJECT:BONE``, are one skeleton if there are several. What hangs on no
    other bone by its name hangs on the first such one.
    """
    subjects: dict[str, list[str]] = {}
    for name in names:
        if ":" in name:
            subjects.setdefault(name.partition(":")[0], []).append(name)
    out: dict[str, str] = {}
    for bones in subjects.values():
        known = body_names(bones)
        above = {name: parent for name in known if (parent := _above(known, known[name]))}
        root, *others = [name for name in bones if name not in above]
        out |= above | dict.fromkeys(others, root)
    return out


def _above(bones: Mapping[str, BodyName], own: BodyName) -> str:
    """The bone of its side, or of no side, that a bone hangs on by its name; empty if none."""
    wanted = ABOVE.get(without_side(own.place), ABOVE.get(own.part))
    for name, each in bones.items():
        place = without_side(each.place)
        beside = ABOVE.get(place) == wanted  # toes, which are of the foot, hang on the rest of it
        if each.side in {own.side, "none"} and wanted in {place, each.part} and not beside:
            return name
    return ""


def _known(convention: Convention, spelled: Spelled) -> dict[str, BodyName]:
    out = {}
    for name, (subject, known) in matched(spelled, convention.keys).items():
        exact = known in convention.points
        place = convention.points[known] if exact else convention.on[known]
        out[name] = BodyName(name, place, exact, convention.title, subject)
    return out


def _place(bare: str) -> str:
    """The place that a name's words tell of; an empty string if none does."""
    bare = re.sub(r"\d+$", "", bare)
    bare = re.sub(rf"^([LRlr])(?=[A-Z][A-Za-z]|(?![A-Z]){_LIMB})", r"\1_", bare)
    words = words_of(bare)
    pairs = {a + b for a, b in pairwise(words)}
    side = next((each for each in SIDES if each[0] in words), side_of(bare))
    for word, place in _table("words")["words"].items():
        if word in words or word in pairs:
            plain = place.removeprefix("{side}_")
            return plain if side == "none" else str(place.format(side=side))
    return ""


def computed(names: Iterable[str]) -> list[str]:
    """Names of computed quantities among the points of a file, such as angles and moments."""
    patterns = [pattern for each in conventions().values() for pattern in each.computed]
    return [
        name
        for name in names
        if any(fnmatchcase(name.rpartition(":")[2], pattern) for pattern in patterns)
    ]


def constant_name(text: str) -> str:
    """Lower-case words joined by underscores: ``HandRight`` is ``hand_right``."""
    words = re.sub(r"[^A-Za-z0-9]+", "_", text).strip("_")
    snake = re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", words).lower()
    return snake if snake[:1].isalpha() else f"body_{snake}".rstrip("_")
