"""Scripted actions with efforts, by man, woman and child: gates, PARs, and what is measured again.

PYTHONPATH=.:tests python benchmarks/efforts.py [ACTION ...] --values 0.5 1 --results FILE
"""

import argparse
import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from capar.body.scripted_actions import ACTIONS, action_capture
from capar.pipelines.observation import observe
from capar.pipelines.round_trips import body, observed_source
from capar.regeneration import Source, capture_of
from capar.regeneration.efforts import POLES, Effort, regenerate_with_effort
from capar.regeneration.scenes import PlanError

AGENTS = ("man", "woman", "child")


def main() -> None:
    """Perform what is not in the file of results yet, and print a table of all."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("actions", nargs="*", default=list(ACTIONS))
    parser.add_argument("--values", nargs="*", type=float, default=[0.5, 1.0])
    parser.add_argument("--results", type=Path, required=True)
    options = parser.parse_args()
    rows = [json.loads(line) for line in _lines(options.results)]
    done = {(row["action"], row["agent"], row["name"], row["value"]) for row in rows}
    with options.results.open("a") as out:
        for action in options.actions:
            source = observed_source(action_capture(action, "man", rate_hz=30.0))
            for agent, name, value in _cases(options.values):
                if (action, agent, name, value) not in done:
                    row = _row(source, agent, name, value)
                    rows.append({"action": action, **row})
                    out.write(json.dumps(rows[-1]) + "\n")
                    out.flush()
    _print_table(rows)


def _lines(path: Path) -> list[str]:
    return path.read_text().splitlines() if path.exists() else []


def _cases(values: list[float]) -> Iterator[tuple[str, str, float]]:
    for agent in AGENTS:
        for name in POLES:
            for value in values:
                yield agent, name, -value
                yield agent, name, value


def _row(source: Source, agent: str, name: str, value: float) -> dict[str, object]:
    """One performance with one effort, observed again."""
    case = {"agent": agent, "name": name, "value": value}
    effort = Effort(**{name: value})
    try:
        motion, quality, report = regenerate_with_effort(source, body(agent, source), effort=effort)
    except PlanError as error:
        return {**case, "refused": str(error)}
    again = observe(capture_of(motion, name=source.capture.name, agent=agent))
    names = "; ".join(
        f"{link.ee}: {' '.join(segment.name for segment in link.segments)}" for link in again.links
    )
    same = again.complex_par.signature == source.observation.complex_par.signature
    return {
        **case,
        "passed": quality.passed,
        "failed": quality.failed,
        "same_par": same,
        "names": "" if same else names,
        "performed": report.performed.values[name],
        "measured": report.measured.values[name],
        "others": {n: v for n, v in report.measured.values.items() if n != name},
        "why": report.why,
    }


def _print_table(rows: list[dict[str, object]]) -> None:
    """A line for each parameter and value."""
    print(
        "effort            asked  refused  gates  in full  same PAR  measured: mean, worst error, n"
    )
    made = {(str(row["name"]), float(str(row["value"]))) for row in rows}
    for name, value in sorted(made):
        here = [row for row in rows if (row["name"], row["value"]) == (name, value)]
        done = [row for row in here if "refused" not in row]
        pairs = [(r["performed"], r["measured"]) for r in done if r["measured"] is not None]
        told = np.array(pairs, dtype=float).reshape(-1, 2)
        off = np.abs(told[:, 1] - told[:, 0]).max(initial=0.0)
        pole = POLES[name][int(value > 0.0)]
        print(
            f"{pole:10} {value:+.2f}  {len(here):5}  {len(here) - len(done):7}  "
            f"{sum(bool(r['passed']) for r in done):5}  "
            f"{sum(r['performed'] == value for r in done):7}  "
            f"{sum(bool(r['same_par']) for r in done):8}  "
            f"{told[:, 1].mean() if len(told) else np.nan:+.2f}, {off:.2f}, {len(told)}"
        )


if __name__ == "__main__":
    main()
