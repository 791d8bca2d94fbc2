"""The nodes of a derivation tree that say why a segment has its name, in order."""

from collections.abc import Iterable, Iterator

from capar_rules.engine.syntax import split_arguments
from capar_rules.explain.clock import Clock
from capar_rules.explain.reason import Reason

BESIDE = ("joins_in(", "looks(", "kept_from(")
"""Prefixes of atoms that accompany a name and are no reason for it."""

FEATURES = "features("
"""Prefix of atoms that primitives share; a primitive's own conditions precede them."""

BORDERS = ("segment(", "border(", "member(")
"""Prefixes of atoms that say where a segment begins and ends, not what it is."""

APART = ("no_contact", "uncounted")
"""Predicates of no contact that counts at a border; where that border lies is no reason."""

BESIDE_BORDERS = (
    "met_gently(",
    "met_unseen(",
    "met_hard(",
    "newly_met(",
    "moved_before(",
    "lets_go(",
    "takes(",
)
"""Prefixes of atoms that say themselves when a contact began or ended."""

DOUBTED = "doubted("
"""Prefix of atoms of what was not taken as it was measured."""

OWN = 3
"""Rank of what is no feature, but a name's own condition."""


def leading(reason: Reason) -> list[Reason]:
    """The nodes from which the name follows: first its own conditions, then its features."""
    passed = set[int]()
    own = list(nodes_below([reason], passed))
    shared = [each for each in own if each.atom.startswith(FEATURES)]
    features = [each for top in shared for each in nodes_below(top.because, passed)]
    features += [each for each in own if rank(each) == 0]
    every = [*(each for each in own if rank(each)), *sorted(features, key=rank)]
    return [each for each in every if each.leading]


def bit(top: Reason, feature: str, clock: Clock) -> list[Reason]:
    """The leading nodes that one place of a feature string is about, by ``feature(_,Side,Place)``.

    First come the end-effector with each object, then the first object with each other one.
    """
    segment, side, text = split_arguments(feature)
    hand, place = segment[4:].split(",")[0], int(text)
    atoms = [each.atom for each in top.walk()]
    objects = {int(row[1]): row[2] for row in _rows(atoms, "object_at(") if row[0] == segment}
    dominant = [row[1] for row in _rows(atoms, "dominant(") if row[0] == segment]
    others = [row[1] for row in _rows(atoms, "subordinate(") if row[0] == segment]
    if len(others) < 2:  # of several, object_at says which is which
        objects |= dict(enumerate([*dominant[:1], *others]))
    if side == "change":
        wanted = [
            f"moved({objects.get(place)},{segment})",
            f"stays({objects.get(place)},{segment})",
        ]
        return [each for each in top.walk() if each.atom in wanted]
    if side == "force":
        met = f"met_gently({segment},", f"met_unseen({segment},"
        return [reason for reason in top.walk() if reason.atom.startswith(met)]
    pair = hand, objects.get(place, "")
    if place >= len(objects):
        pair = objects.get(0, ""), objects.get(place - len(objects) + 1, "")
    return [each for each in top.walk() if _is_about(each.atom, pair, side, clock)]


def _rows(atoms: Iterable[str], prefix: str) -> list[list[str]]:
    return [split_arguments(each) for each in atoms if each.startswith(prefix)]


def _is_about(atom: str, pair: tuple[str, str], side: str, clock: Clock) -> bool:
    """Whether an atom says that two bodies touch, or do not, at a side of the segment."""
    arguments = split_arguments(atom) if "(" in atom else []
    if atom.startswith(("no_contact(", "uncounted(")):
        return arguments[1] == side and tuple(arguments[2:4]) == pair
    if atom.startswith("contact_at("):
        at = clock.side(arguments[0], int(arguments[4]))
        return at == side and tuple(arguments[1:3]) == pair
    return False


def nodes_below(tops: Iterable[Reason], passed: set[int]) -> Iterator[Reason]:
    """Nodes from the top, each once, as far down as the features."""
    waiting = list(reversed(list(tops)))
    while waiting:
        each = waiting.pop()
        if each.atom.startswith(BESIDE) or id(each) in passed:
            continue
        passed.add(id(each))
        yield each
        if not each.atom.startswith(FEATURES):
            waiting += [below for below in reversed(each.because) if _bears(each, below)]


def _bears(reason: Reason, below: Reason) -> bool:
    """Whether a child of a node is relevant to the name, not only to where a border is.

    Doubts are relevant to derived atoms, not to the measurements themselves.
    """
    if below.atom.startswith(DOUBTED):
        return bool(reason.rule)
    return not reason.atom.startswith((*BORDERS, *APART, *BESIDE_BORDERS))


def rank(reason: Reason) -> int:
    """Sort key of features: contacts of the end-effector come first."""
    predicate = reason.atom.partition("(")[0]
    if predicate == "contact_at":
        hand, body = split_arguments(reason.atom)[:2]
        return 0 if hand == body else 2
    if predicate in APART:
        segment, _, body = split_arguments(reason.atom)[:3]
        return 0 if segment.startswith(f"seg({body},") else 2
    return {"moved": 1, "stays": 1}.get(predicate, OWN)


def parsed(atom: str) -> tuple[str, list[str]]:
    """The predicate of an atom, and its arguments without quotation marks."""
    arguments = split_arguments(atom) if "(" in atom else []
    return atom.partition("(")[0], [each.strip('"') for each in arguments]
