"""Observe every scene of a battery and count the units that come out as written."""

import argparse
import importlib
import json
import sys
from dataclasses import dataclass
from typing import Any

import capar

BORDER_S = 0.1
"""A border counts as right when it is no further from the truth [s]."""


@dataclass(frozen=True)
class Outcome:
    """What was expected of one end-effector in one scene, and what was found."""

    scene: str
    ee: str
    expected: tuple[str, ...]
    found: tuple[str, ...]
    named: bool
    """Names, objects and order are as written."""

    placed: bool
    """Each border is in its place as well."""

    worst_border_s: float | None
    """The largest error of a border [s], where the names are right."""

    error: str = ""


def shown(step: Any) -> str:
    """A step as text, with its times."""
    return f"{step.name}({', '.join(step.objects)}) {step.start_s:.2f}-{step.end_s:.2f}"


def judged(scene: str, unit: Any, segments: tuple[Any, ...], error: str = "") -> Outcome:
    """Compare what was found with the unit, or with its alternative if that fits."""
    found = tuple((each.name, tuple(each.objects)) for each in segments)
    ways = [unit.steps, *([unit.alternative] if unit.alternative else [])]
    fits = next((way for way in ways if tuple(each.action for each in way) == found), None)
    worst = None
    if fits is not None:
        pairs = zip(fits, segments, strict=True)
        worst = max(
            max(abs(mine.start_s - its.start_s), abs(mine.end_s - its.end_s)) for mine, its in pairs
        )
    return Outcome(
        scene,
        unit.ee,
        tuple(map(shown, unit.steps)),
        tuple(map(shown, segments)),
        fits is not None,
        worst is not None and worst <= BORDER_S,
        worst,
        error,
    )


def observed(
    name: str, scene: Any, rate_hz: float, noise_m: float, noise_rad: float, seed: int
) -> list[Outcome]:
    """Observe one scene; a failure of the observer makes all its units wrong."""
    capture, expectation = scene(rate_hz, noise_m, noise_rad, seed)
    error = ""
    segments: dict[str, tuple[Any, ...]] = {}
    try:
        observation = capar.observe(capture, rules="extended")
        segments = {link.ee: tuple(link.segments) for link in observation.links}
    except Exception as failure:
        error = f"{type(failure).__name__}: {failure}"
    return [judged(name, unit, segments.get(unit.ee, ()), error) for unit in expectation.units]


def report(outcomes: list[Outcome]) -> str:
    """A line for each unit, what differs below it, and both rates."""
    lines = []
    for each in outcomes:
        word = "right" if each.placed else "names right" if each.named else "WRONG"
        worst = "" if each.worst_border_s is None else f", worst border {each.worst_border_s:.3f} s"
        lines.append(f"{word}: {each.scene} {each.ee}{worst}")
        if not each.placed:
            lines.append(f"    expected {'; '.join(each.expected)}")
            lines.append(f"    found    {each.error or '; '.join(each.found)}")
    lines.extend(rates(outcomes))
    return "\n".join(lines)


def rates(outcomes: list[Outcome]) -> list[str]:
    """Both rates as sentences."""
    count = len(outcomes)
    named, placed = sum(each.named for each in outcomes), sum(each.placed for each in outcomes)
    return [
        f"names, objects and order: {named} of {count} ({100 * named / count:.1f} %)",
        f"and each border within {BORDER_S} s: {placed} of {count} ({100 * placed / count:.1f} %)",
    ]


def main(arguments: list[str] | None = None) -> int:
    """Score one battery and print the outcome."""
    parser = argparse.ArgumentParser(prog="scenes.score", description=__doc__)
    parser.add_argument(
        "battery",
        help="name of a package in tests/scenes: hands, objects, household, people, parts",
    )
    parser.add_argument("--rate", type=float, default=100.0, help="frames a second")
    parser.add_argument("--noise-mm", type=float, default=0.5, help="noise of positions [mm]")
    parser.add_argument("--noise-deg", type=float, default=0.1, help="noise of rotations [degrees]")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--scene", action="append", help="only this scene; may be repeated")
    parser.add_argument("--json", action="store_true", help="print outcomes for machines")
    options = parser.parse_args(arguments)
    scenes = importlib.import_module(f"scenes.{options.battery}").SCENES
    noise_m, noise_rad = options.noise_mm / 1000.0, options.noise_deg * 3.14159265 / 180.0
    outcomes = [
        outcome
        for name in options.scene or scenes
        for outcome in observed(name, scenes[name], options.rate, noise_m, noise_rad, options.seed)
    ]
    if options.json:
        rows = [
            {field: getattr(each, field) for field in Outcome.__dataclass_fields__}
            for each in outcomes
        ]
        text = json.dumps(rows, indent=1)
    else:
        text = report(outcomes)
    sys.stdout.write(text + "\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
