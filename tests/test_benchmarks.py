"""Benchmarks are run by hand; here each is started, so that none is forgotten when code changes.

`CAPAR_SCENES=all pytest tests/test_benchmarks.py` runs those to the end that take longer.
"""

import re
import runpy
import sys
from pathlib import Path

import pytest
from combinations import EVERY

BENCHMARKS = Path(__file__).parents[1] / "benchmarks"
SMALLEST = {
    "actionary": "--smallest 1000 --largest 1000 --rdflib 0",
    "attention": "--minutes 0.1 --sample 5 --faces 500",
    "body": "--seeds 1 --seconds 0.5",
    "contact": "--minutes 0.1 --sample 5 --faces 500",
    "demonstrations": "judge nowhere",
    "edges": "--every 128 --rates 100 --noises 0.5",
    "explaining": "--trials 1",
    "live": "--events 10 --minutes 0.02 --faces 500",
    "live_takes": "slide_0.1mm --rounds 1",
    "many": "--captures 2",
    "moved_pivots": "",
    "natural": "touch",
    "observing": "--minutes 0.2 --sensors 5 --faces 500",
    "questions": "--copies 2 --first 1",
    "reasoning": "--minutes 0.2 --runs 1",
    "recorded_bodies": "",
    "regeneration": "touch --scenes 1",
    "serving": "--requests 20 --clients 2 --seconds 1 --triples 1000",
    "spoken_requests": "--first 1",
    "starting": "--runs 0",
    "window": "--minutes 0.2 --faces 500 --seconds 0.3",
    "words": "--verbs 2 --verbnet nowhere",
}
"""The options with which each takes no more than some seconds."""

LONG = (
    "body", "explaining", "live", "live_takes", "many", "natural", "observing", "questions",
    "regeneration", "spoken_requests", "starting", "window",
)  # fmt: skip
"""Those that even so take longer than three seconds are only asked for their options."""

if not EVERY:
    SMALLEST |= dict.fromkeys(LONG, "--help")

STARTED = sorted(path.stem for path in BENCHMARKS.glob("*.py") if path.stem != "scene")


@pytest.mark.parametrize("name", STARTED)
def test_a_benchmark_runs_at_its_smallest_size_and_prints_figures(
    name: str, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    path = BENCHMARKS / f"{name}.py"
    monkeypatch.setenv("CAPAR_DATA", str(tmp_path / "no recordings"))
    monkeypatch.setattr(sys, "argv", [str(path), *SMALLEST[name].split()])
    monkeypatch.setattr(sys, "path", [str(BENCHMARKS), *sys.path])
    try:
        runpy.run_path(str(path), run_name="__main__")
    except SystemExit as ended:
        assert not ended.code, ended
    printed = capfd.readouterr().out
    figures = "usage: " if SMALLEST[name] == "--help" else r"\d"
    assert re.search(figures, printed) or printed.startswith("no recordings of others"), printed
