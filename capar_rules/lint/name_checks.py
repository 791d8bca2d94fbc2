"""Primitives of a user that name the segments of others, or leave a more general one none."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from capar_rules.engine.syntax import Statement, parse_text
from capar_rules.lint.candidates import named_by
from capar_rules.lint.findings import ERROR, NOTE, Finding
from capar_rules.lint.firing import Firing
from capar_rules.lint.probes import WINS, naming_probes
from capar_rules.lint.relaxation import COULD, OVERLAP
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

    Those that may do so, by conditions that the worlds of the audit do not contain, are among them.

    Args:
        name: The primitive of the file.
        own: The rules of the file.
        base: The shipped rule base.
        beside: The rules of the user's other files.
    """
    sharing = _sharing(Firing(Trial(own, base, beside)))
    found = {*sharing.surely.get(name, ()), *sharing.possibly.get(name, ())}
    return tuple(sorted(found, key=lambda each: (each in base.primitives, each)))


@dataclass(frozen=True)
class _Sharing:
    """Who names a segment with each primitive of a file, the primitives of the user first."""

    surely: Mapping[str, tuple[str, ...]]
    possibly: Mapping[str, tuple[str, ...]]
    """By conditions that the worlds of the audit do not contain."""

    unchecked: frozenset[str]
    """Primitives that fit no segment even with such conditions left open."""


def _sharing(firing: Firing) -> _Sharing:
    trial, relaxation = firing.trial, firing.relaxation
    sure = {(str(row[0]), str(row[1])) for each, row in firing.atoms if each == "_rival"}
    soft = relaxation.soft_names
    sure = {pair for pair in sure if not soft & {*pair}}
    if not soft:
        return _Sharing(_by_first(sure, trial), {}, frozenset())
    probes = parse_text(relaxation.text(trial.names))
    atoms = trial.ask(probes, (OVERLAP, COULD), trial.worlds)
    found = {(str(row[0]), str(row[1])) for each, row in atoms if each == OVERLAP[0]}
    could = {str(row[0]) for each, row in atoms if each == COULD[0]}
    unchecked = frozenset(trial.names) & soft - could
    return _Sharing(_by_first(sure, trial), _by_first(found - sure, trial), unchecked)


def _by_first(pairs: Iterable[tuple[str, str]], trial: Trial) -> Mapping[str, tuple[str, ...]]:
    found: dict[str, list[str]] = {}
    for name, other in sorted(pairs, key=lambda each: (each[1] in trial.base.primitives, each)):
        found.setdefault(name, []).append(other)
    return {name: tuple(others) for name, others in found.items()}


def clashes(firing: Firing) -> Iterator[Finding]:
    """Primitives of the file that name a segment together with another one, or may do so."""
    sharing = _sharing(firing)
    for name, place in firing.trial.names.items():
        remedy = (
            f"To put it before all of them: capar rules add {Path(place.file).name} --over all."
        )
        if others := sharing.surely.get(name):
            features = _shared_features(firing.trial, name, others[0])
            where = ", ".join(bit or "none" for bit in features)
            yield Finding(
                place, "ambiguous",
                f"{name} and {_told(others)} name the same segments, such as those with features "
                f"{where}, and neither is the more specific.",
                f"{apart(name, others[0])} {remedy}",
            )  # fmt: skip
        if others := sharing.possibly.get(name):
            words = firing.relaxation.words([name, *others])
            yield Finding(
                place, "ambiguous",
                f"{name} and {_told(others)} may name the same segments: what keeps them apart, if "
                f"anything does, are conditions that the worlds of the audit do not contain "
                f"({words}).",
                f"{apart(name, others[0])} {remedy}",
            )  # fmt: skip
        if name in sharing.unchecked:
            yield Finding(
                place, "clashes-unchecked",
                f"with which primitives {name} may share segments was not checked: no segment of "
                "the worlds of the audit fits it.",
                "Compare on captures: capar rules diff FILE --on CAPTURE.", NOTE,
            )  # fmt: skip


def _told(others: Sequence[str]) -> str:
    rest = len(others) - MOST_RIVALS
    return ", ".join(others[:MOST_RIVALS]) + (f" and {rest} more" if rest > 0 else "")


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


def shadows(firing: Firing) -> Iterator[Finding]:
    """Primitives of the file that never win, and more general ones that win no more.

    Of those that rest on conditions outside the worlds nothing is said.
    """
    trial, atoms = firing.trial, firing.atoms
    fitted = {str(row[0]) for each, row in atoms if each == "_fitted"}
    wins = {str(row[0]) for each, row in atoms if each == "_wins"}
    for name, place in trial.names.items():
        if name in firing.relaxation.soft_names:
            continue
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
