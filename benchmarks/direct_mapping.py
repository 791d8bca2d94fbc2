"""How far performed hands and things are from the recorded ones, and what direct mapping costs.

Run as ``PYTHONPATH=.:tests python benchmarks/direct_mapping.py [ACTION ...]``. The first table is
of the recorded body in the recorded scene: what is performed is compared with the capture. The
second is of other bodies in the recorded scene: which gates a direct mapping fails.
"""

import argparse

from capar.body.human import Human
from capar.body.scripted_actions import ACTIONS, action_capture
from capar.pipelines.round_trips import SAME, body, observed_source
from capar.regeneration import Motion, PlanError, Quality, Source, map_directly, regenerate
from capar.regeneration.direct_mapping import departures

AGENTS = ("woman", "child")
RATE_HZ = 30.0


def recorded_body(source: Source) -> str:
    """A row of the first table."""
    cells = [source.capture.name]
    for motion, quality in (_mapped(source, source.human), regenerate(source, source.human)):
        cells += [_largest_mm(motion), ", ".join(quality.failed) or "all"]
    return _row(cells)


def other_body(source: Source, agent: str) -> str:
    """A row of the second table."""
    human = body(agent, source)
    _, mapped = _mapped(source, human)
    try:
        planned = _failed(regenerate(source, human)[1])
    except PlanError as error:
        planned = f"refused: {error}"
    return _row([source.capture.name, agent, _failed(mapped), planned])


def _mapped(source: Source, human: Human) -> tuple[Motion, Quality]:
    """By direct mapping of the paths as they were recorded, without a filter."""
    return map_directly(observed_source(source.capture, cutoff_hz=None), human)


def _largest_mm(motion: Motion) -> str:
    worst = max(departures(motion), key=lambda measure: measure.value)
    return f"{worst.value:.2f} ({worst.bodies})"


def _failed(quality: Quality) -> str:
    failed = [gate for gate in quality.gates if not gate.passed]
    return "; ".join(f"{g.name} {g.value:.1f} {g.unit}" for g in failed) or "all passed"


def _row(cells: list[str]) -> str:
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Do what is asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("actions", nargs="*", metavar="ACTION", help=", ".join(ACTIONS))
    parser.add_argument("--agents", nargs="+", default=[SAME, *AGENTS])
    asked = parser.parse_args()
    sources = {
        action: observed_source(action_capture(action, rate_hz=RATE_HZ))
        for action in asked.actions or ACTIONS
    }
    if SAME in asked.agents:
        print(_row(["action", "mapped [mm]", "gates", "regenerated [mm]", "gates"]))
        print("|---" * 5 + "|")
        for source in sources.values():
            print(recorded_body(source), flush=True)
    others = [agent for agent in asked.agents if agent != SAME]
    if others:
        print(_row(["action", "agent", "mapped directly", "regenerated"]))
        print("|---" * 4 + "|")
        for source in sources.values():
            for agent in others:
                print(other_body(source, agent), flush=True)


if __name__ == "__main__":
    main()
