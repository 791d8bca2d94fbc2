"""Primitives of a user that name the segments of others, or leave a more general one none."""

from collections.abc import Iterator, Sequence
from pathlib import Path

from capar_rules.engine.search import Atom
from capar_rules.engine.syntax import Statement, parse_text
from capar_rules.lint.candidates import named_by
from capar_rules.lint.findings import ERROR, NOTE, Finding
from capar_rules.lint.probes import RIVAL, WINS, naming_probes
from capar_rules.lint.text_checks import Known
from capar_rules.lint.trials import Trial

MOST_RIVALS = 5
"""How many rivals an ambiguity lists."""

PIECE = 30
"""How many worlds are searched at a time for one example."""

_ORDERS = ("<", ">")


def rivals(
    name: str, own: Sequence[Statement], base: Known, beside: Sequence[Statement] = ()
) -> tuple[str, ...]:
    """The primitives that name a segment with one of a file's, neither the more specific; sorted.

    Args:
        name: The primitive of the file.
        own: The rules of the file.
        base: The shipped rule base.
        beside: The rules of the user's other files.
    """
    trial = Trial(own, base, beside)
    return _rivals(name, trial, trial.ask(naming_probes([name], []), (RIVAL,), trial.worlds))


def _rivals(name: str, trial: Trial, atoms: frozenset[Atom]) -> tuple[str, ...]:
    """Those of the user first."""
    found = {str(row[1]) for each, row in atoms if each == "_rival" and row[0] == name}
    return tuple(sorted(found, key=lambda each: (each in trial.base.primitives, each)))


def clashes(trial: Trial, atoms: frozenset[Atom]) -> Iterator[Finding]:
    """Primitives of the file that name a segment together with another one."""
    for name, place in trial.names.items():
        others = _rivals(name, trial, atoms)
        if others:
            where = ", ".join(bit or "none" for bit in _shared_features(trial, name, others[0]))
            told = ", ".join(others[:MOST_RIVALS])
            rest = len(others) - MOST_RIVALS
            yield Finding(
                place, "ambiguous",
                f"{name} and {told}{f' and {rest} more' if rest > 0 else ''} name the same "
                f"segments, such as those with features {where}, and neither is the more specific.",
                f"{apart(name, others[0])} To put it before all of them: "
                f"capar rules add {Path(place.file).name} --over all.",
            )  # fmt: skip


def apart(name: str, other: str) -> str:
    """How a primitive is told from another one."""
    return (
        f'If {name} is a kind of {other}, say specialises("{name}", "{other}"); if not, say '
        f'precedes("{name}", "{other}"), or add a condition that keeps them apart, such as '
        f'not fits(Segment, "{other}").'
    )


def _shared_features(trial: Trial, name: str, other: str) -> tuple[str, ...]:
    """The first feature set, in order, of the first worlds in which both name the segment."""
    (probe,) = parse_text(
        f'_shared(A,B,C,D) :- named(S,"{name}"), named(S,"{other}"), features(S,A,B,C,D).'
    )
    limbs = sorted(trial.worlds & trial.extent(other))
    for at in range(0, len(limbs), PIECE):
        found = trial.ask([probe], [("_shared", 4)], frozenset(limbs[at : at + PIECE]))
        if found:
            return min(tuple(map(str, row)) for _, row in found)
    return ()


def shadows(trial: Trial, atoms: frozenset[Atom]) -> Iterator[Finding]:
    """Primitives of the file that never win, and more general ones that win no more."""
    fitted = {str(row[0]) for each, row in atoms if each == "_fitted"}
    wins = {str(row[0]) for each, row in atoms if each == "_wins"}
    for name, place in trial.names.items():
        if name in fitted - wins:
            yield Finding(
                place, "shadowed", f"{name} never names a segment: others are always more "
                "specific.", "Remove what specialises it, or add a case of its own.",
            )  # fmt: skip
        for over in sorted((trial.generals[name] & fitted) - wins - {*trial.names}):
            if name in fitted and not _wins_elsewhere(trial, over):
                yield Finding(
                    place, "shadows", f"with {name}, {over} never names a segment any more: every "
                    "segment that fits it fits something more specific.",
                    f"Add a condition to {name} that some segments of {over} lack, or add {name} "
                    f"in place of {over}.", NOTE if _compares(trial, name) else ERROR,
                )  # fmt: skip


def _wins_elsewhere(trial: Trial, name: str) -> bool:
    """Whether a primitive names a segment in a world in which none of the file's can fit."""
    rest = trial.extent(name) - trial.worlds
    if name in trial.extents.named and rest - trial.reach(trial.candidates):
        return True
    return bool(trial.ask(naming_probes([], [name]), (WINS,), rest))


def _compares(trial: Trial, name: str) -> bool:
    """Whether its rules compare numbers, of which the worlds have few."""
    return any(
        literal.kind == "comparison" and any(sign in literal.text for sign in _ORDERS)
        for rule in trial.own
        if name in named_by(rule)
        for literal in rule.body
    )
