"""Segments and steps as tables: for a terminal, and as plain rows."""

from collections.abc import Collection, Sequence
from typing import TYPE_CHECKING

from capar.model.observation import ForceStyle, Observation, ObservedLink, Segment, SegmentAddress
from capar.model.par import ComplexPar, FeatureSet, Step

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


def segments_table(observation: Observation) -> "Table":
    """Segments for a terminal, a section for each link."""
    rows = segment_rows(observation)[1:]
    table = terminal_table(
        SEGMENT_COLUMNS, rows, right={1, 2}, names={0}, title=observation.capture, empty=True
    )
    table.caption = FEATURE_NOTE
    for link in observation.links:
        for segment in link.segments:
            style = None if segment.known else "yellow"
            table.add_row(*map(_escaped, _segment_row(link, segment)), style=style)
        table.add_section()
    addresses = table.columns[0]
    addresses.no_wrap = True
    addresses.min_width = max(map(len, map(str, addresses.cells)))
    return table


def steps_table(par: ComplexPar) -> "Table":
    """Steps of a complex PAR for a terminal, with their shares of its duration."""
    title = f"{par.name or 'unnamed'}({', '.join(par.objects)}), {par.duration_s:.2f} s"
    rows = step_rows(par)[1:]
    table = terminal_table(STEP_COLUMNS, rows, right={4, 5, 6}, names={0}, title=title, empty=True)
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
    return tuple(_force_line(force, observation.profile) for force in observation.forces)


def _force_line(force: ForceStyle, profile: str) -> str:
    pace = sum(part**2 for part in force.velocity_mps) ** 0.5
    did = "strikes" if force.struck else "lets go of"
    words = [f"{force.ee} {did} {force.object} at {force.start_s:.2f} s, which goes {pace:.2f} m/s"]
    if force.restitution is not None:
        words.append(f"restitution {force.restitution:.2f}")
    if force.damping_per_s is not None:
        words.append("damping {:.2f} and {:.2f} /s along x and y".format(*force.damping_per_s))
    if profile == "thesis" and force.thesis_damping is not None:
        words.append("by eq. 3.9 {:.2f} and {:.2f} /s^2".format(*force.thesis_damping))
    if force.bounce is not None:
        words.append(f"bounces with {force.bounce:.2f}")
    if force.impulse_ns is not None:
        words.append("impulse ({:.2f}, {:.2f}, {:.2f}) N s".format(*force.impulse_ns))
    return ", ".join(words)


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
            overflow="fold",
        )
    for row in () if empty else rows:
        table.add_row(*map(_escaped, row))
    return table


def _escaped(cell: str) -> str:
    from rich.markup import escape

    return escape(cell)
