"""What is measured of two bodies as a panel over time: how far apart, above, inside, which way."""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
from jaxtyping import Float, Int

from capar.model.calibration import Found, PairCalibration
from capar.model.facts import ClosingSpeed, Lies, Touching
from capar.pipelines.distances import distances, frames_between
from capar.pipelines.measured.recording import CENTI, MILLI, Recording, held, told_beside
from capar.views.lettering import Span
from capar.views.panels import Curve, Limit, Mark, Panel
from capar_rules.borders.ticks import constants
from capar_rules.explain.arrangements import AFTER_DEG, AHEAD_DEG, steepest_deg
from capar_rules.explain.claimed_measures import ANY, Measure
from capar_rules.explain.claims import Quantity
from capar_rules.explain.quantities import LEAST_M, length, percent, upward
from capar_rules.explain.touch_notes import BORDER
from extractors.calibration import thresholds_of
from extractors.contact.blows import SETTLES
from extractors.motion.impacts import APPROACH_S, closing_speed
from extractors.relations.arrangement import Pair

AROUND = 1.5
"""Up to so many times the least distance is shown where that is told [1]."""

CLOSE = 5.0
"""A distance is shown up to so many times what counts as contact: beyond, it only is far [1]."""


def _distance(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel | None:
    first, second = one, other = told.bodies
    calibration = known.seen.measurements.calibration
    pair = calibration.sought(one, other)
    if pair is None:
        one, other = other, one
        pair = calibration.sought(one, other)
    if pair is None:
        return None
    touching = known.bars(Touching, body=one, other=other)
    every = known.frames
    spans = (every[0], told.first), (told.first, told.last), (told.last, every[-1])
    some = [frames_between(int(begin), int(end)) for begin, end in spans if begin <= end]
    frames = np.unique(np.clip(np.concatenate(some), every[0], every[-1]))
    apart = MILLI * distances(known.seen.measurements, pair, frames)
    limits = {MILLI * pair.touch_m: "contact begins within {:g} mm"}
    limits[MILLI * pair.release_m] = "contact ends beyond {:g} mm"
    if pair.touch_m >= pair.release_m:
        limits = {MILLI * pair.touch_m: "counts as contact within {:g} mm"}
    if pair.found is Found.NEVER:
        limits = {}
    highest = CLOSE * max([*limits, 20.0])
    named = [Limit(value, label.format(upward(value, 1))) for value, label in limits.items()]
    at_borders = dict(zip(frames.tolist(), apart.tolist(), strict=True))
    marks = [
        Mark(
            known.at(frame),
            min(at_borders[frame], highest),
            _gap(at_borders[frame], named, highest),
        )
        for frame in (told.first, told.last)
        if math.isfinite(at_borders.get(frame, math.nan))
    ]
    if "nearest" in forms:
        inside = {at: gap for at, gap in at_borders.items() if told.first <= at <= told.last}
        at = min(inside, key=lambda frame: np.nan_to_num(inside[frame], nan=np.inf))
        highest = max(highest, AROUND * inside[at])
        label = f"{_gap(inside[at], named, highest)} at the nearest"
        marks = [Mark(known.at(at), inside[at], label)]
    between = _between(pair, shaped=all(known.body(name).shape for name in (one, other)))
    rough = [name for name in (one, other) if name in known.seen.explainer.measured.stand_ins]
    about = f" (shape of the {known.called(rough[0])}: a stand-in)" if rough else ""
    return Panel(
        f"{known.called(first)} to {known.called(second)}: distance of {between}{about}",
        "mm",
        (Curve(frames / known.rate, apart),),
        tuple(named),
        tuple(marks),
        bars=touching,
        bars_label="counts as contact" + _uncounted(known, touching, frames, apart, pair),
        held=held(Touching, one, other),
        unheld="no contact in the time shown" + _uncounted(known, (), frames, apart, pair),
        highest=highest,
        lost=known.lost(one, other),
    )


def _uncounted(
    known: Recording,
    touching: Sequence[Span],
    frames: Int[np.ndarray, "some"],
    apart: Float[np.ndarray, "some"],
    pair: PairCalibration,
) -> str:
    """How long gaps in a contact may last, and what is none, where the time shown has such.

    What lies beside a contact is left out: its border may be a frame off.
    """
    if pair.found is Found.NEVER:
        return ""
    times, measured = frames / known.rate, known.seen.explainer.measured
    aside = BORDER / known.rate
    inside, beside = np.zeros(len(times), dtype=bool), np.zeros(len(times), dtype=bool)
    for bar in touching:
        inside |= (times > bar.start_s) & (times < bar.end_s)
        beside |= (times > bar.start_s - aside) & (times < bar.end_s + aside)
    far = apart > MILLI * max(pair.touch_m, pair.release_m)
    near = (apart <= MILLI * pair.touch_m) & ~beside & ~(pair.pivots & (pair.found in SETTLES))
    gaps = f"; gaps of {measured.gap_frames} end none"
    brief = f"; what passes by, or lasts {measured.brief_frames}, is none"
    return gaps * bool((inside & far).any()) + brief * bool(near.any())


def _gap(millimetres: float, limits: Sequence[Limit], highest: float) -> str:
    """A distance of two bodies, as a mark has it; that it is cut off beyond the highest shown."""
    told = told_beside(millimetres, limits, _apart, " mm")
    return told + " (cut off)" * (millimetres > highest)


def _apart(millimetres: float) -> str:
    return f"{millimetres:.0f} mm" if millimetres < 100.0 else length(millimetres / MILLI)


def _between(pair: PairCalibration, *, shaped: bool) -> str:
    if not pair.pivots:
        return "their surfaces" if shaped else "the surface of one and the origin of the other"
    return "their origins" if pair.found is Found.STATED else "a point of each"


def _closing(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    one, other = told.bodies
    own, thing = known.body(one), known.body(other)
    speeds = MILLI * np.array([closing_speed(own, thing, int(frame)) for frame in known.frames])
    met = [
        fact
        for fact in known.seen.observation.facts
        if isinstance(fact, ClosingSpeed)
        and (fact.body, fact.other) == (one, other)
        and known.span[0] <= fact.first <= known.span[1]
    ]
    near = min(met, key=lambda fact: abs(fact.first - told.last), default=None)
    blow = constants()["blow_mm_s"]
    return Panel(
        f"{known.called(one)} and {known.called(other)}: relative speed of their middles in any "
        f"direction, the greatest in the last {APPROACH_S:.2f} s",
        "mm/s",
        (Curve(known.times, speeds),),
        (Limit(float(blow), f"a blow: {blow} mm/s or more"),),
        (Mark(known.at(near.first), float(near.speed), f"{near.speed} mm/s"),) if near else (),
        known.bars(Touching, body=one, other=other),
        "counts as contact",
        held(Touching, one, other),
    )


def _bearing(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    """The level angle of the way so far to the line from the end-effector at the start."""
    hand, name = told.bodies
    middles, first = np.rint(MILLI * known.body(name).middles), told.first
    line = (middles[first] - np.rint(MILLI * known.body(hand).middles[first]))[:2]
    way = (middles - middles[first])[:, :2]
    far = np.linalg.norm(way, axis=1) >= MILLI * LEAST_M
    shown = far & (np.arange(len(way)) >= first)
    shown[told.last] = True
    directions = [(line, "to the line from the end-effector to it")]
    contacts = known.seen.explainer.measured
    met = contacts.contact(hand, name, first, known.merged)
    press = contacts.presses.get((hand, name), {}).get(met[0]) if met else None
    across = line[0] * way[told.last, 1] - line[1] * way[told.last, 0]
    forward = abs(math.atan2(across, float(way[told.last] @ line))) < math.pi / 2.0
    if press is not None and forward and np.hypot(*press) >= constants()["steep_permille"]:
        directions.append((np.array(press, dtype=float), "to where it is pressed"))
    curves, ends = [], []
    for direction, label in directions:
        across = direction[0] * way[:, 1] - direction[1] * way[:, 0]
        angle = np.degrees(np.abs(np.arctan2(across, way @ direction)))
        angle[~shown] = np.nan
        curves.append(known.curve(angle, label))
        ends.append(float(angle[told.last]))
    return Panel(
        f"{known.called(name)}: level angle of its way since {known.at(first):.2f} s to the line "
        f"from the {known.called(hand)} to its middle, as it was then",
        "°",
        tuple(curves),
        (
            Limit(AHEAD_DEG, f"ahead: {AHEAD_DEG:.0f}° or less"),
            Limit(AFTER_DEG, f"after: {AFTER_DEG:.0f}° or more"),
        ),
        tuple(Mark(known.at(told.last), end, f"{end:.0f}°") for end in ends if math.isfinite(end)),
    )


def _pair(known: Recording, told: Quantity) -> Pair:
    name, other = told.bodies
    limits = thresholds_of(known.seen.measurements.calibration)
    return Pair(known.body(name), known.body(other), limits)


def _above(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    name, other = told.bodies
    pair = _pair(known, told)
    rise = pair.body.middles[:, 2] - pair.other.boxes[1][:, 2]
    frames = [frame for frame in (told.first, told.last) if np.isfinite(rise[frame])]
    top = "top" if pair.other.shape is not None else "origin"
    marks = [
        Mark(known.at(frame), CENTI * float(value[frame]), length(abs(float(value[frame]))))
        for value in (rise, pair.aside)
        for frame in frames
    ]
    return Panel(
        f"{known.called(name)}: its middle over the {top} of the {known.called(other)}; above it "
        "is no further aside than over it",
        "cm",
        (known.curve(CENTI * rise), known.curve(CENTI * pair.aside, "aside of it")),
        (),
        tuple(marks),
        known.bars(Lies, body=name, how="above", other=other),
        "counts as above",
        held(Lies, name, "above", other),
    )


def _inside(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel:
    name, other = told.bodies
    pair = _pair(known, told)
    share, deep = (CENTI * value for value in pair.shares)
    limits = pair.thresholds
    merge = known.merged
    spans = known.seen.explainer.measured.lies.get(("inside", name, other), ())
    starts = [
        max(first, border)
        for border in (told.first, told.last)
        for first, last in spans
        if first <= border + merge and last >= border
    ]
    dips = "dips" in forms
    at = dict.fromkeys([told.first, told.last, *starts])
    known_at = [frame for frame in at if frame < len(share)]
    return Panel(
        f"{known.called(name)}: share of it inside the {known.called(other)}",
        "%",
        (known.curve(share), known.curve(deep, "share of its ends well inside")),
        ()
        if dips
        else (
            Limit(
                CENTI * limits.inside_share,
                f"inside from {percent(limits.inside_share)} on, while no less than "
                f"{percent(limits.inside_stays_share)}",
            ),
        ),
        tuple(Mark(known.at(one), float(share[one]), f"{share[one]:.0f} %") for one in known_at),
        known.bars(Lies, body=name, how="dips" if dips else "inside", other=other),
        "dips in, as some of an end is well inside" if dips else "counts as inside",
        held(Lies, name, "dips" if dips else "inside", other),
    )


def _borne(known: Recording, told: Quantity, forms: frozenset[str]) -> Panel | None:
    """From how far off straight up each contact of a body pushes it, while it lasts."""
    name, wanted = told.bodies
    found = known.seen.explainer.measured
    times, values, marks = [], [], []
    for (one, two), contacts in sorted(found.contacts.items()):
        other = two if one == name else one
        if name not in (one, two) or wanted not in (ANY, other):
            continue
        for first, last in contacts:
            permille = found.upward(name, other, first)
            if permille is None or last < known.span[0] or first > known.span[1]:
                continue
            angle = math.degrees(math.acos(max(-1.0, min(1.0, permille / MILLI))))
            ends = known.at(max(first, known.span[0])), known.at(min(last, known.span[1]))
            times += [*ends, ends[1]]
            values += [angle, angle, math.nan]
            label = f"{angle:.0f}°" + f" ({known.called(other)})" * (wanted == ANY)
            inside = first <= told.last and last >= told.first
            at = max(ends[0], known.at(told.first)) if inside else ends[0]
            marks.append(Mark(at, angle, label))
    if not values:
        return None
    most = steepest_deg()
    of = "what touches it pushes it" if wanted == ANY else f"the {known.called(wanted)} pushes it"
    return Panel(
        f"{known.called(name)}: how far off straight up {of}, as their contact began",
        "°",
        (Curve(np.array(times), np.array(values)),),
        (Limit(most, f"bears it from below up to {most:.0f}°"),),
        tuple(marks),
    )


Series = Callable[[Recording, Quantity, frozenset[str]], Panel | None]

RELATIONS: Mapping[Measure, Series] = {
    Measure.DISTANCE: _distance,
    Measure.CLOSING: _closing,
    Measure.BEARING: _bearing,
    Measure.ABOVE: _above,
    Measure.INSIDE: _inside,
    Measure.BORNE: _borne,
}
"""The panel of each quantity of two bodies."""
