"""The tree of reasons of an explanation as people read it, beside what else was observed."""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace

from capar.model.body_names import body_names
from capar.model.observation import JointAction, Observation
from capar.views.movers import joined
from capar.views.picture import MOST_NAMED, spoken
from capar_rules.explain.explanation import Explanation, Reason

JOINT, LOOKS, LOOK = "joins_in(", "looks(", "looking_at("
"""How the atoms of joint actions, of when an object was looked at, and of measured looks begin."""

FIRST_NAMED = 2
"""So many are named of more than ``MOST_NAMED`` who act together [1]."""

MOST_JOINT = 2
"""So many joint actions of one name are told one by one [1]."""

ABOVE, ALSO_ABOVE = "see above", "see also above"
"""What a line has in place of all, or of some, of the lines below it, which stand above."""


def reason_tree(told: Explanation, seen: Observation) -> Reason:
    """The sentences of an explanation, each where it is met first.

    A segment is told to be part of the joint actions that were observed, and not once for each
    other end-effector that takes part. When it was looked at is told by measured looks alone.
    """
    top = told.reason
    below = [
        cause
        for cause in map(_by_looks, top.because)
        if cause is not None and not cause.atom.startswith(JOINT)
    ]
    below += _joint(told, seen)
    return replace(top, because=tuple(below)).with_sentences().without_repeats()


def note(reason: Reason) -> str:
    """The rule that a line rests on, and that others of its reasons stand above it."""
    above = (ALSO_ABOVE if reason.because else ABOVE) if reason.repeated else ""
    return "; ".join(filter(None, (reason.rule, above)))


def _by_looks(reason: Reason) -> Reason | None:
    """The same with nothing but looks below it, if it is about looks; None without any."""
    if not reason.atom.startswith(LOOKS):
        return reason
    looks = tuple(cause for cause in reason.because if cause.atom.startswith(LOOK))
    return replace(reason, because=looks) if looks else None


def spoken_texts(tree: Reason) -> Iterator[str]:
    """The sentences of a tree on which a name rests: not who looked, nor who else acts as well."""
    for node in tree.walk():
        if node.atom and not node.atom.startswith(LOOK):
            yield node.sentence


def _joint(told: Explanation, seen: Observation) -> Iterator[Reason]:
    """The joint actions that a segment is part of; of many of one name the longest."""
    named: dict[str, list[JointAction]] = defaultdict(list)
    for joint in seen.joint:
        if (told.ee, told.index) in zip(joint.ees, joint.segments, strict=True):
            named[joint.name].append(joint)
    for group in named.values():
        if len(group) <= MOST_JOINT:
            for joint in group:
                yield _told(f"it is part of one action of {_who(joint, seen)}: {joint.name}", joint)
            continue
        longest = max(group, key=lambda joint: joint.last - joint.first)
        counts = sorted({len(joint.who) for joint in group})
        of = f"{counts[0]} to {counts[-1]}" if len(counts) > 1 else f"{counts[0]}"
        many = f"it is part of {len(group)} actions of {of} end-effectors each"
        yield _told(f"{many}; the longest, of {_who(longest, seen)}: {longest.name}", longest)


def _told(sentence: str, joint: JointAction) -> Reason:
    """What is said of a joint action, and from when to when all who take part do it."""
    span = f"from {joint.start_s:.2f} s to {joint.end_s:.2f} s"
    return Reason(f"{sentence}, {span}", "", "", (joint.first, joint.last), False, ())


def _who(joint: JointAction, seen: Observation) -> str:
    """Who takes part, as the other sentences call them; of many the first two are named."""
    both, called = seen.who(joint), body_names(seen)
    if both.startswith("both "):
        return both
    names = [f"the {called.get(ee, spoken(ee))}" for ee in joint.who]
    left = len(names) - FIRST_NAMED
    return joined([*names[:FIRST_NAMED], f"{left} more"] if len(names) > MOST_NAMED else names)
