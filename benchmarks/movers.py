"""What moves what in recordings of others, and what nobody moves once a hand is taken away.

Run by hand: ``python benchmarks/movers.py [--takes PATTERN ...] [--whole-only] [--json]``, with the
environment variable CAPAR_DATA set to the folder of the recordings; without it nothing is done.

For each mobile object of each take stands the share of its motion that has no mover, with every
interval of it. The negative control takes one hand at a time away, with its fingers: of the motion
that this hand alone had caused the share is told that has no mover then, and the share that is
told of another body instead.
"""

import argparse
import json
import os
import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from fnmatch import fnmatch
from pathlib import Path

import numpy as np
from jaxtyping import Bool

from capar.model.capture import Capture
from capar.model.facts import Displaced, MovedBy
from capar_rules.borders.deflicker import steady
from capar_rules.movers.movers import movers
from extractors.measure import measure
from extractors.readers.bundle.capture_toml import grouped, read_capture, takes

EXAMPLES = Path(__file__).parents[1] / "examples"
BUNDLES = ("bimacs_optitrack", "manipnet", "omomo_intermimic")
HAND = "hand"
UNKNOWN, SET_GOING = "unknown", "set_going"

Frames = Bool[np.ndarray, "frames"]


@dataclass(frozen=True)
class Unmoved:
    """The motion of one object, and what of it has no mover."""

    take: str
    object: str
    moves_s: float
    share: float
    """Of its frames of motion those without a mover [1]."""

    intervals: tuple[tuple[float, float, str], ...]
    """Begin and end [s] of each, and why."""


@dataclass(frozen=True)
class Control:
    """What becomes of the motion that a hand alone had caused, without the hand."""

    take: str
    hand: str
    object: str
    caused_s: float
    moverless: float
    """Share of it without a mover [1]."""

    elsewhere: float
    """Share of it that is told of another body [1]."""

    others: tuple[str, ...]
    """Those bodies."""


@dataclass(frozen=True)
class Told:
    """What moves what in a capture."""

    capture: Capture
    moved: dict[str, Frames]
    found: tuple[MovedBy, ...]

    def by(self, thing: str, *, hand: str) -> Frames:
        """Frames in which a body alone moves an object."""
        own, others = self._empty(), self._empty()
        for each in self.found:
            if each.object == thing:
                part = own if each.mover == hand else others
                part[each.first : each.last + 1] = True
        return own & ~others

    def unmoved(self, thing: str) -> Frames:
        """Frames in which it moves and nothing moves it."""
        out = self._empty()
        for each in self.found:
            if each.object == thing and each.how == UNKNOWN:
                out[each.first : each.last + 1] = True
        return out

    def _empty(self) -> Frames:
        return np.zeros(len(self.capture.times), dtype=bool)


def told(capture: Capture) -> Told:
    """Measure a capture, and ask what moves what."""
    facts = steady(measure(capture).facts)
    moved: dict[str, Frames] = {}
    for each in facts:
        if isinstance(each, Displaced):
            frames = moved.setdefault(each.object, np.zeros(len(capture.times), dtype=bool))
            frames[each.first : each.last + 1] = True
    return Told(capture, moved, movers(facts))


def unmoved(take: str, whole: Told) -> Iterator[Unmoved]:
    """Each object that moves, and what of its motion has no mover."""
    times = whole.capture.times
    step_s = float(np.median(np.diff(times)))
    for thing, frames in sorted(whole.moved.items()):
        lacking = [each for each in whole.found if (each.object, each.how) == (thing, UNKNOWN)]
        share = float((whole.unmoved(thing) & frames).sum() / frames.sum())
        spans = tuple(
            (round(float(times[each.first]), 2), round(float(times[each.last]), 2), each.mover)
            for each in lacking
        )
        yield Unmoved(take, thing, round(float(frames.sum()) * step_s, 2), share, spans)


def without(capture: Capture, hand: str) -> Capture:
    """The capture without a hand and its fingers."""
    kept = (each for each in capture.sensors if hand not in (each.name, each.part_of))
    return replace(capture, sensors=tuple(kept))


def controls(take: str, whole: Told) -> Iterator[Control]:
    """Each hand that alone moves an object, and what moves it without the hand."""
    for hand in (each.name for each in whole.capture.acting if each.end_effector == HAND):
        caused = {thing: whole.by(thing, hand=hand) for thing in whole.moved}
        if any(frames.any() for frames in caused.values()):
            less = told(without(whole.capture, hand))
            for thing, frames in sorted(caused.items()):
                if frames.any():
                    yield _control(take, hand, thing, frames, less)


def _control(take: str, hand: str, thing: str, caused: Frames, less: Told) -> Control:
    step_s = float(np.median(np.diff(less.capture.times)))
    elsewhere, others = np.zeros_like(caused), set()
    for each in less.found:
        part = slice(each.first, each.last + 1)
        if each.object == thing and each.how != UNKNOWN and caused[part].any():
            elsewhere[part] = True
            others.add(f"{each.mover} ({each.how})")
    count = int(caused.sum())
    # What does not count as moving any more, by a frame at an edge, is not told of another body.
    return Control(
        take,
        hand,
        thing,
        round(count * step_s, 2),
        float((caused & less.unmoved(thing)).sum() / count),
        float((caused & elsewhere).sum() / count),
        tuple(sorted(others)),
    )


def chosen(patterns: Sequence[str]) -> Iterator[str]:
    """Takes of the bundles whose names fit."""
    for bundle in BUNDLES:
        for take in takes(EXAMPLES / bundle):
            if any(fnmatch(take, pattern) for pattern in patterns):
                yield f"{EXAMPLES / bundle}:{take}"


def lines(parts: Iterable[Unmoved], tried: Sequence[Control]) -> Iterator[str]:
    """A table of what has no mover, and one of the negative control."""
    yield f"{'take':22} {'object':12} {'moves':>8} {'no mover':>9}  intervals"
    for part in parts:
        spans = ", ".join(f"{a:.2f}-{z:.2f} s {why}" for a, z, why in part.intervals)
        head = f"{part.take:22} {part.object:12} {part.moves_s:6.2f} s"
        yield f"{head} {100.0 * part.share:7.1f} %  {spans}"
    if tried:
        yield ""
        yield f"{'without':32} {'object':12} {'caused':>8} {'no mover':>9} {'told of others':>15}"
    for each in tried:
        head = f"{each.take + ' ' + each.hand:32} {each.object:12} {each.caused_s:6.2f} s"
        shares = f"{100.0 * each.moverless:7.1f} % {100.0 * each.elsewhere:13.1f} %"
        yield f"{head} {shares}  {', '.join(each.others)}"


def main() -> None:
    """Print what has no mover, and the negative control."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--takes", nargs="+", default=["*"], help="patterns of names of takes")
    parser.add_argument("--whole-only", action="store_true", help="leave out the negative control")
    parser.add_argument("--json", action="store_true")
    options = parser.parse_args()
    if not Path(os.environ.get("CAPAR_DATA") or "no folder").is_dir():
        print("no recordings: set CAPAR_DATA")
        return
    parts: list[Unmoved] = []
    tried: list[Control] = []
    places = tuple(chosen(options.takes))
    for number, place in enumerate(places, start=1):
        take = place.rpartition(":")[2]
        print(f"{number} of {len(places)}: {take}", file=sys.stderr, flush=True)
        whole = told(grouped(read_capture(place)))
        parts += unmoved(take, whole)
        if not options.whole_only:
            tried += controls(take, whole)
    if options.json:
        found = {"unmoved": [*map(asdict, parts)], "controls": [*map(asdict, tried)]}
        print(json.dumps(found, indent=2))
    else:
        print("\n".join(lines(parts, tried)))


if __name__ == "__main__":
    main()
