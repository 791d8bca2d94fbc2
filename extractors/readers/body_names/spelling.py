"""Names of joints and markers without what files add to them: subjects, rigs, common endings."""

import re
from collections import Counter
from collections.abc import Iterable, Mapping
from itertools import takewhile

SHARED_BY = 8
"""A beginning or an ending up to a separator that so many names share is none of their own [1]."""

COMMON_LETTERS = 3
"""... and one of so many letters, without a separator, is not if all names share it [1]."""

SIDES = {"r", "l", "right", "left", "rt", "lt"}
"""What names of one side share, and what belongs to them."""


def key_of(name: str) -> str:
    """A name without its separators and capitals: ``R.Knee_Lat`` and ``rKneeLat`` are one."""
    return re.sub(r"[\W_]+", "", name).lower()


def split_name(name: str) -> tuple[str, str]:
    """The subject before the last colon, and the rest of a name."""
    subject, _, bare = name.rpartition(":")
    return subject, bare


def spellings(names: Iterable[str]) -> dict[str, list[tuple[str, str]]]:
    """For each name, the subjects and bare names that it may consist of, least taken off first.

    ``Anna:LASI`` is Anna's; ``Anna_LASI`` may be, if other names begin so too; ``r_knee_study`` may
    be an ``r_knee`` if others end so.
    """
    split = {name: split_name(name) for name in names}
    bares = list(dict.fromkeys(bare for _, bare in split.values()))
    beginnings, endings = _beginnings(bares), _endings(bares)
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


def _beginnings(names: list[str]) -> list[str]:
    """What many names begin with up to a separator, and what all begin with; shortest first."""
    counts = Counter(name[: at.end()] for name in names for at in re.finditer(r"[_ .\-]+", name))
    shared = {each for each, count in counts.items() if count >= SHARED_BY and not _is_side(each)}
    letters = takewhile(lambda column: len(set(column)) == 1, zip(*names, strict=False))
    whole = "".join(column[0] for column in letters)
    if len(names) >= SHARED_BY and len(whole) >= COMMON_LETTERS:
        shared.add(whole)
    return sorted(shared, key=len)


def _endings(names: list[str]) -> list[str]:
    """What many names end with from a separator on; shortest first."""
    counts = Counter(name[at.start() :] for name in names for at in re.finditer(r"[_ .\-]+", name))
    shared = (each for each, count in counts.items() if count >= SHARED_BY and not _is_side(each))
    return sorted(shared, key=len)


def _is_side(affix: str) -> bool:
    return key_of(affix) in SIDES


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
