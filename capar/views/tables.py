"""Observations, PARs and calibrations as tables and text: for a terminal, a file, a notebook."""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from functools import singledispatch
from importlib import import_module
from math import degrees, hypot
from typing import TYPE_CHECKING, Any

from capar.model.calibration import Calibration, Found
from capar.model.errors import CaparError, UnknownNameError
from capar.model.facts import MovedBy, Touching
from capar.model.observation import Observation, ObservedLink, Segment, SegmentAddress
from capar.model.par import (
    Call,
    ComplexPar,
    Condition,
    CoreSemantics,
    FeatureSet,
    Ipar,
    Motion,
    Preparation,
    Step,
    Upar,
)

if TYPE_CHECKING:
    from rich.table import Table


SEGMENT_COLUMNS = ("segment", "start [s]", "end [s]", "name", "objects", "features", "purpose")
STEP_COLUMNS = ("link", "step", "objects", "purpose", "begin", "share", "duration [s]")
FEATURE_NOTE = "features: relations at start > at end, changes of location, force"
LEVELS = {
    "count": "number of objects",
    "rel_start": "relations at the start",
    "rel_end": "relations at the end",
    "change_loc": "change of location",
    "end_effector": "end-effector",
    "force": "force",
}
"""What people call the levels of the feature table (thesis 4.5)."""


def segment_rows(observation: Observation) -> tuple[tuple[str, ...], ...]:
    """A heading and a row for each segment, links in order."""
    return (
        SEGMENT_COLUMNS,
        *(_segment_row(link, each) for link in observation.links for each in link.segments),
    )


def step_rows(par: ComplexPar) -> tuple[tuple[str, ...], ...]:
    """A heading and a row for each step, links in order, the common step last."""
    steps = [step for link in par.links for step in link.steps]
    steps += [par.common] if par.common else []
    return (STEP_COLUMNS, *(_step_row(each, par.duration_s) for each in steps))


NARROW = 100
"""In a terminal of fewer columns segments are printed without their features."""


def segments_table(observation: Observation, *, width: int = NARROW) -> "Table":
    """Segments for a terminal of a width [columns], a section for each link."""
    shown = [n for n, name in enumerate(SEGMENT_COLUMNS) if width >= NARROW or name != "features"]
    rows = [[row[n] for n in shown] for row in segment_rows(observation)]
    short = all(each.known for each in observation.segments)  # else a name has remarks beside it
    names = {0, 3, 5} if short and width < NARROW else {0}
    table = terminal_table(
        rows[0], rows[1:], right={1, 2}, names=names, title=observation.capture, empty=True
    )
    table.caption = FEATURE_NOTE if width >= NARROW else None
    for link in observation.links:
        for segment in link.segments:
            style = None if segment.known else "yellow"
            cells = _segment_row(link, segment)
            table.add_row(*(_escaped(cells[n]) for n in shown), style=style)
        table.add_section()
    return table


def steps_table(par: ComplexPar) -> "Table":
    """Steps of a complex PAR for a terminal, with their shares of its duration."""
    title = f"{par.name or 'unnamed'}({', '.join(par.objects)}), {par.duration_s:.2f} s"
    rows = step_rows(par)[1:]
    table = terminal_table(
        STEP_COLUMNS, rows, right={4, 5, 6}, names={0, 1, 3}, title=title, empty=True
    )
    for link in par.links:
        for step in link.steps:
            table.add_row(*map(_escaped, _step_row(step, par.duration_s)))
        table.add_section()
    if par.common:
        table.add_row(*map(_escaped, _step_row(par.common, par.duration_s)))
    return table


def performers(observation: Observation) -> tuple[str, ...]:
    """Names of the agents who act; of the first where nothing does."""
    acting = {observation.performer(each.ee) for each in observation.links}
    agents = (observation.agent, *observation.others)
    return tuple(each.name for each in agents if each.name in acting) or (agents[0].name,)


def joint_lines(observation: Observation) -> tuple[str, ...]:
    """What several end-effectors did as one action: ``both hands: Lift(box) 1.55-2.40 s``."""
    return tuple(
        f"{observation.who(each)}: {each.name}({', '.join(each.objects)}) "
        f"{each.start_s:.2f}-{each.end_s:.2f} s"
        for each in observation.joint
    )


def force_lines(observation: Observation) -> tuple[str, ...]:
    """What set things going that then moved on alone, a line for each (thesis 3.4.3)."""
    lines = []
    for force in observation.forces:
        did = "strikes" if force.struck else "lets go of"
        pace = hypot(*force.velocity_mps)
        line = (
            f"{force.ee} {did} {force.object} at {force.start_s:.2f} s, which goes {pace:.2f} m/s"
        )
        thesis = force.thesis_damping if observation.profile == "thesis" else None
        for words, value in (
            ("restitution {:.2f}", force.restitution),
            ("damping {:.2f} and {:.2f} /s along x and y", force.damping_per_s),
            ("by eq. 3.9 {:.2f} and {:.2f} /s^2", thesis),
            ("bounces with {:.2f}", force.bounce),
            ("impulse ({:.2f}, {:.2f}, {:.2f}) N s", force.impulse_ns),
        ):
            if value is not None:
                line += f", {words.format(*(value if isinstance(value, tuple) else (value,)))}"
        lines.append(line)
    return tuple(lines)


def aligned(
    rows: Sequence[Sequence[str]], *, right: Collection[int] = frozenset()
) -> tuple[str, ...]:
    """Rows as lines of text with their columns under each other.

    Args:
        rows: Cells of equally many columns.
        right: Columns whose cells stand at the right.
    """
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return tuple(
        "  ".join(
            cell.rjust(width) if index in right else cell.ljust(width)
            for index, (cell, width) in enumerate(zip(row, widths, strict=True))
            if width
        ).rstrip()
        for row in rows
    )


def unknown_note(segment: Segment) -> str:
    """Where an unknown segment parted from what is known, and which names fitted that far."""
    level = LEVELS.get(segment.level, segment.level.replace("_", " "))
    note = f"new in {level}" if level else "nothing is known yet"
    return note + (f"; near {', '.join(segment.candidates)}" if segment.candidates else "")


def _segment_row(link: ObservedLink, segment: Segment) -> tuple[str, ...]:
    name = segment.name
    if not segment.known:
        name = f"{name} ({unknown_note(segment)})"
    elif segment.candidates:
        name = f"{name} (or {', '.join(segment.candidates)})"
    place = str(SegmentAddress(link.ee, segment.index))
    return (
        f"{place} ({link.agent})" if link.agent else place,
        f"{segment.start_s:.3f}",
        f"{segment.end_s:.3f}",
        name,
        ", ".join(segment.objects) or "-",
        features(segment.features),
        segment.purpose or "-",
    )


def features(value: FeatureSet) -> str:
    """A feature set in short: ``100 > 101, 10, 00, hand``."""
    strings = (value.rel_start, value.rel_end, value.change_loc, value.force)
    start, end, change, force = (each or "-" for each in strings)
    return f"{start} > {end}, {change}, {force}, {value.end_effector}"


def _step_row(step: Step, duration_s: float) -> tuple[str, ...]:
    return (
        step.ee,
        step.action,
        ", ".join(step.objects) or "-",
        step.purpose or "-",
        f"{step.begin:.4f}",
        f"{step.share:.4f}",
        f"{step.share * duration_s:.3f}",
    )


def terminal_table(
    columns: Sequence[str],
    rows: Sequence[Sequence[str]],
    *,
    right: Collection[int] = frozenset(),
    names: Collection[int] = frozenset(),
    title: str = "",
    empty: bool = False,
) -> "Table":
    """A table that cuts no cell: where the terminal is too narrow, a cell takes further lines.

    Args:
        columns: Its heading.
        rows: Cells of equally many columns.
        right: Columns whose cells stand at the right; numbers, which stay whole.
        names: Columns that stay whole as well.
        title: What stands above it.
        empty: Whether the caller adds the rows, with their styles and sections.
    """
    from rich.table import Table

    table = Table(title=_escaped(title) or None, title_justify="left", caption_justify="left")
    for index, column in enumerate(columns):
        cells = [column.split(" ")[0], *(row[index] for row in rows)] if rows else [column]
        whole = max(map(len, cells)) if index in {*right, *names} else None
        table.add_column(
            _escaped(column),
            justify="right" if index in right else "left",
            min_width=whole,
            no_wrap=index in names,
            overflow="fold",
        )
    for row in () if empty else rows:
        table.add_row(*map(_escaped, row))
    return table


def _escaped(cell: str) -> str:
    from rich.markup import escape

    return escape(cell)


Line = tuple[str, str]
"""What is stated, and what it is."""

END_EFFECTOR = -1
"""The index that stands for the end-effector among colliding objects (thesis Fig 4.16)."""


@singledispatch
def par_text(par: object) -> str:
    """A UPAR, an IPAR or a complex PAR as lines; equal PARs give equal text.

    Numbers are rounded: times to a millisecond, places to a millimetre, shares to 0.0001.
    """
    raise TypeError(f"{type(par).__name__} is no PAR")


@par_text.register
def _upar(par: Upar) -> str:
    head = f"UPAR {call(Call(par.name, (par.agent, *par.objects)))}"
    lines = [
        *_each("specialises", par.general),
        *_each("applicable if", map(condition, par.applicability)),
        *_each("prepare", map(preparation, par.preparation)),
        *_each("step", map(call, par.steps)),
        *_core(par.core, par.objects),
        *_each("afterwards", map(condition, par.post_assertions)),
        *_each("part of", filter(None, [par.parent])),
    ]
    return _block(head, lines)


@par_text.register
def _ipar(par: Ipar) -> str:
    lines = [
        ("end-effector", par.ee),
        ("start", f"{par.start_s:.3f} s"),
        *_each("prepare", map(preparation, par.preparation)),
        *_core(par.core, par.objects),
        *_each("afterwards", map(condition, par.post_assertions)),
        *_each("posture", filter(None, [par.posture])),
        *_each("part of", filter(None, [par.parent])),
    ]
    return _block(f"IPAR {call(Call(par.upar, (par.agent, *par.objects)))}", lines)


@par_text.register
def _complex(par: ComplexPar) -> str:
    head = f"COMPLEX PAR {call(Call(par.name or 'unnamed', par.objects))}, {par.duration_s:.3f} s"
    out = [head]
    steps = [step for link in par.links for step in link.steps]
    rows = [
        (
            call(Call(step.action, step.objects)),
            f"for {step.purpose}" if step.purpose else "",
            f"to posture {step.posture}" if step.posture else "",
            f"from {step.begin:.4f}",
            f"share {step.share:.4f}",
        )
        for step in (*steps, *([par.common] if par.common else []))
    ]
    table = iter(aligned(rows, right={3, 4}))
    for link in par.links:
        out += [f"  {link.ee} in sequence", *(f"    {next(table)}" for _ in link.steps)]
    if par.common:
        out += ["  all together, last", f"    {next(table)}"]
    out += [
        "  {}[{}] {} {}[{}]".format(*each.first, each.relation, *each.second)
        for each in par.relations
    ]
    return "\n".join(out) + "\n"


def call(value: Call) -> str:
    """An action with its arguments: ``Reach(mug) for PickUp``."""
    purpose = f" for {value.purpose}" if value.purpose else ""
    return f"{value.action}({', '.join(value.objects)}){purpose}"


def condition(value: Condition) -> str:
    """A condition: ``contact(EE, obj1)``, or ``not contact(EE, obj1)``."""
    return ("" if value.holds else "not ") + f"{value.kind}({', '.join(value.arguments)})"


def preparation(value: Preparation) -> str:
    """A condition, and what is done where it does not hold."""
    return f"{condition(value.condition)}, else {call(value.action)}"


def _core(core: CoreSemantics, objects: Sequence[str]) -> list[Line]:
    moved = f" of {core.moved}" if core.moved else ""
    caused = ", caused by the agent" if core.causal else ""
    motion = "none" if core.motion is Motion.NONE else f"{core.motion.value}{moved}{caused}"
    pair = core.constraint.colliding_objects
    names = {END_EFFECTOR: "EE", **dict(enumerate(objects))}
    bits = core.constraint.features
    duration = "a parameter" if core.duration_s is None else f"{core.duration_s:.3f} s"
    return [
        ("motion", motion),
        *_each("force on", core.force),
        *_each("path", (f"({x:.3f}, {y:.3f}, {z:.3f}) m" for x, y, z in core.path)),
        *_each("purpose", filter(None, [core.purpose])),
        *_each("enables", core.enables),
        *_each("until", map(condition, core.termination)),
        ("duration", duration),
        *_each("manner of", filter(None, [core.manner])),
        ("collides", " with ".join(names.get(each, f"#{each}") for each in pair)),
        ("relations at start", bits.rel_start or "-"),
        ("relations at end", bits.rel_end or "-"),
        ("changes location", bits.change_loc or "-"),
        ("force", bits.force or "-"),
        ("end-effector type", bits.end_effector),
    ]


def _each(name: str, values: Iterable[str]) -> list[Line]:
    """A line for each value, each with the name, so that a change shows as one line."""
    return [(name, each) for each in values]


def _block(head: str, lines: Sequence[Line]) -> str:
    return "\n".join([head, *(f"  {each}" for each in aligned(lines))]) + "\n"


BODY_COLUMNS = ("body", "noise mm", "noise deg", "floor mm", "floor deg", "highest m/s", "held")
PAIR_COLUMNS = ("pair", "touch mm", "release mm", "of", "found by", "frames", "contradicts")


def calibration_tables(calibration: Calibration) -> tuple["Table", ...]:
    """What was decided for the whole, for each body and for each pair."""
    from rich.table import Table

    whole = Table("calibration", "")
    for name, value in _whole_rows(calibration):
        whole.add_row(name, value)
    bodies = Table(*BODY_COLUMNS)
    for body in (*calibration.sensors, *calibration.objects):
        bodies.add_row(
            body.name,
            _mm(body.noise_m),
            f"{degrees(body.noise_rad):.3f}",
            _mm(body.motion_floor_m),
            f"{degrees(body.motion_floor_rad):.2f}",
            f"{body.highest_speed_mps:.2f}",
            "at its median" if body.fixed else ("recorded still" if body.still else ""),
        )
    pairs = Table(*PAIR_COLUMNS)
    for pair in calibration.pairs:
        cells = ["-", "-", "-", pair.found.value, "", ""]
        if pair.found is not Found.NEVER:
            estimated = pair.found not in (Found.STATED, Found.TOLERANCE)
            cells = [
                _mm(pair.touch_m),
                _mm(pair.release_m),
                ("points" if estimated else "origins") if pair.pivots else "surfaces",
                pair.found.value,
                str(pair.frames) if pair.frames else "",
                "" if pair.shown_m is None else f"{_mm(pair.shown_m)} mm",
            ]
        pairs.add_row(f"{pair.first} {pair.second}", *cells)
    return whole, bodies, pairs


def _whole_rows(calibration: Calibration) -> tuple[tuple[str, str], ...]:
    """Names and values of what holds for the whole recording."""
    horizons = calibration.horizons
    return (
        ("step of the clock", f"{1e3 * calibration.step_s:.3f} ms"),
        ("cutoff of the low-pass", f"{calibration.cutoff_hz:.2f} Hz"),
        ("contact up to", f"{_mm(calibration.contact_tolerance_m)} mm"),
        ("interruption closed below", f"{calibration.contact_dropout_s:.3f} s"),
        ("contact dropped below", f"{calibration.contact_minimum_s:.3f} s"),
        *(
            (f"feet of {level.agent} stand at", f"{level.height_m:.3f} m")
            for level in calibration.foot_levels
        ),
        *(
            (f"{each.ground} under {each.agent} moves at", f"{hypot(*each.velocity_mps):.2f} m/s")
            for each in calibration.moving_grounds
        ),
        ("half length of the low-pass", f"{horizons.filter_s:.3f} s"),
        ("extrema of speed compared within", f"{horizons.extremum_s:.3f} s"),
        ("margin of a window", f"{horizons.margin_s:.3f} s"),
    )


def _mm(length_m: float) -> str:
    return f"{1e3 * length_m:.2f}"


Row = dict[str, Any]


def observation_frame(observation: Observation, of: str) -> Any:
    """A DataFrame of an observation.

    Args:
        observation: What was understood of a capture.
        of: ``segments``, ``contacts``, ``motions`` or ``facts``; each is a row.

    Raises:
        UnknownNameError: There is no frame of that.
        CaparError: pandas is not installed.
    """
    if of not in FRAMES:
        raise UnknownNameError("data frame", of, FRAMES)
    try:
        pandas = import_module("pandas")
    except ModuleNotFoundError as error:
        if error.name != "pandas":
            raise
        raise CaparError(
            "data frames need pandas, which is not installed; it comes with the extra 'frames': "
            "pip install 'capar[frames]'"
        ) from None
    columns, rows = FRAMES[of]
    return pandas.DataFrame(list(rows(observation)), columns=list(columns))


def _segments(observation: Observation) -> Iterator[Row]:
    for segment in observation.segments:
        yield {
            "capture": observation.capture,
            "performer": observation.performer(segment.ee),
            "ee": segment.ee,
            "index": segment.index,
            "name": segment.name,
            "objects": segment.objects,
            "start_s": segment.start_s,
            "end_s": segment.end_s,
            "first": segment.first,
            "last": segment.last,
            "possessed": segment.possessed,
            "purpose": segment.purpose,
            **asdict(segment.features),
        }


def _contacts(observation: Observation) -> Iterator[Row]:
    for fact in observation.facts:
        if isinstance(fact, Touching):
            yield {
                "capture": observation.capture,
                "body": fact.body,
                "other": fact.other,
                **_interval(fact, observation.rate_hz),
            }


def _motions(observation: Observation) -> Iterator[Row]:
    for fact in observation.facts:
        if isinstance(fact, MovedBy):
            yield {
                "capture": observation.capture,
                "object": fact.object,
                "mover": fact.mover,
                "how": fact.how,
                **_interval(fact, observation.rate_hz),
            }


def _facts(observation: Observation) -> Iterator[Row]:
    for fact in observation.facts:
        yield {
            "capture": observation.capture,
            "predicate": fact.predicate,
            "arguments": tuple(asdict(fact).values()),
            "atom": str(fact),
        }


FRAMES: Mapping[str, tuple[tuple[str, ...], Callable[[Observation], Iterator[Row]]]] = {
    "segments": (
        (
            "capture", "performer", "ee", "index", "name", "objects", "start_s", "end_s", "first",
            "last", "possessed", "purpose", "rel_start", "rel_end", "change_loc", "end_effector",
            "force",
        ),
        _segments,
    ),
    "contacts": (
        ("capture", "body", "other", "start_s", "end_s", "first", "last"),
        _contacts,
    ),
    "motions": (
        ("capture", "object", "mover", "how", "start_s", "end_s", "first", "last"),
        _motions,
    ),
    "facts": (("capture", "predicate", "arguments", "atom"), _facts),
}  # fmt: skip
"""Columns and rows of each frame; times [s] take frames as evenly spaced."""


def _interval(fact: Touching | MovedBy, rate_hz: float) -> Row:
    return {
        "start_s": fact.first / rate_hz,
        "end_s": fact.last / rate_hz,
        "first": fact.first,
        "last": fact.last,
    }
