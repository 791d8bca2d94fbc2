"""The unit and the upward axis of a drafted capture.toml, with what shows them."""

from collections.abc import Sequence
from dataclasses import dataclass

from extractors.readers.drafting.contents import Contents
from extractors.readers.recording import UNITS

EDIT = "# EDIT:"
"""What marks a line that a person must look at."""


@dataclass(frozen=True)
class Frame:
    """What files are taken to be in that do not say it."""

    unit_m: float
    unit: str
    """As the capture.toml states it: ``"mm"`` in quotes, or metres per unit."""

    up: str
    unit_why: tuple[str, ...]
    """Comments with the evidence."""

    unit_edit: str
    """What a person must look at; empty where the evidence is clear."""

    up_why: str
    up_edit: str


def frame_of(held: Sequence[Contents]) -> Frame:
    """The unit and axis that make people of the bodies in some files."""
    first = next((each for each in held if each.standing), None)
    unit_m, unit, unit_why, unit_edit = _unit(first)
    beside = next((each.beside for each in held if each.beside), None)
    stands = first.standing if first else None
    if stands is not None and stands.clear:
        up, up_why, up_edit = stands.up, _how_up(first), ""
    elif beside is not None:
        (up, up_why), up_edit = beside, ""
    else:
        up, up_why = (stands.up if stands else "z"), ""
        up_edit = "the axis that points up: x, y or z"
    return Frame(unit_m, unit, up, unit_why, unit_edit, up_why, up_edit)


def _how_up(first: Contents | None) -> str:
    whole = first is not None and first.standing is not None and first.standing.whole
    return "from the body's lower parts to its upper ones" if whole else "from the feet to the head"


def _unit(held: Contents | None) -> tuple[float, str, tuple[str, ...], str]:
    """Metres per unit, as it is written, the evidence, and what to look at."""
    person = held.standing if held else None
    if held is None or person is None:
        return 1.0, '"m"', (), f"{', '.join(UNITS)}, or metres per unit"
    evidence = f"# {person.evidence}"
    if person.unit:
        metres = UNITS[person.unit]
        why = f"{evidence}: {person.height * metres:.2f} m if the unit is {person.unit}"
        return metres, f'"{person.unit}"', (why,), ""
    for metres in held.usual_units_m:
        if person.is_persons(metres):
            why = f"{evidence}: {person.height * metres:.2f} m in the unit that files with"
            return metres, f"{metres:g}", (why, "# such names are usually in"), ""
    low, high = person.range_m
    why = f"{evidence}, which is {low:g} to {high:g} m in no usual unit"
    return person.scale_m, f"{person.scale_m:.4g}", (why,), "metres per unit, for an adult"


def frame_lines(held: Sequence[Contents], frame: Frame) -> list[str]:
    """The lines of unit, axis, handedness and rate."""
    lines = _doubts(held)
    if any(each.recording.unit_m is None for each in held):
        edit = f"{EDIT} {frame.unit_edit}" if frame.unit_edit else ""
        lines += [*frame.unit_why, f"unit = {frame.unit:25}{edit}".rstrip()]
    if any(each.recording.up is None for each in held):
        said = f"{EDIT} {frame.up_edit}" if frame.up_edit else f"# {frame.up_why}"
        lines.append(f'up = "{frame.up}"                        {said}')
    lines.append('handedness = "right"            # "left" if the world is mirrored')
    if len(held) > 1:
        steps = [each.recording.times[:2] for each in held]
        rate = 1.0 / min(float(second - first) for first, second in steps)
        lines.append(f"rate_hz = {rate:.4g}                 # every stream is brought to this")
    return lines


def _doubts(held: Sequence[Contents]) -> list[str]:
    """Files whose own unit makes no person of the body in them."""
    out = []
    for file in held:
        unit_m, person = file.recording.unit_m, file.standing
        if unit_m is not None and person is not None and not person.is_persons(unit_m):
            likely = f"; {person.unit} would make it {person.height * UNITS[person.unit]:.2f} m"
            out.append(
                f"{EDIT} by the unit that {file.recording.source.path.rsplit('/', 1)[-1]} states, "
                f"{person.what} is {person.height * unit_m:.3g} m" + (likely if person.unit else "")
            )
    return out
