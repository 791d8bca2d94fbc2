"""Processor and wall time of commands from a cold start.

``python benchmarks/starting.py [--runs 10] [--json]``: each command is a process of its own; a
first round, which writes bytecode, as an installation does, is left out, except with ``--runs 0``.
Once more the capture is observed with an empty folder of caches each time. Commands take turns, so
that a machine whose speed changes treats them alike. Beside them ten million additions in a loop
of Python, and what the median would be on the reference machine, where those take 0.7 s.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
from importlib import resources
from statistics import median

import scene

DEMO = str(resources.files("capar") / "demo" / "drink_from_mug")
MAIN = "from capar.cli import main; main()"
COMMANDS = {
    "capar observe, the shipped capture": [sys.executable, "-c", MAIN, "observe", DEMO],
    "the same, nothing cached": [sys.executable, "-c", MAIN, "observe", DEMO],
    "capar --help": [sys.executable, "-c", MAIN, "--help"],
    "import capar": [sys.executable, "-c", "import capar"],
    "import numpy, scipy.spatial, .ndimage": [
        sys.executable,
        "-c",
        "import numpy, scipy.spatial, scipy.ndimage",
    ],
    "ten million additions": [sys.executable, "-c", scene.ADDITIONS],
}


def spent(command: list[str], bytecode: str, cache: str) -> tuple[float, float]:
    """Processor time and wall time of one run [s], with folders of bytecode and of caches."""
    given = {
        "PYTHONPYCACHEPREFIX": bytecode,
        "PYTHONDONTWRITEBYTECODE": "",
        "XDG_CACHE_HOME": cache,
    }
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    start = time.perf_counter()
    subprocess.run(command, capture_output=True, check=True, env=os.environ | given)
    wall = time.perf_counter() - start
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--runs", type=int, default=10)
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    asked = parser.parse_args()
    found: dict[str, list[tuple[float, float]]] = {name: [] for name in COMMANDS}
    with tempfile.TemporaryDirectory() as folder:
        for number in range(asked.runs + 1):
            for name, command in COMMANDS.items():
                cache = f"cache_{number}" if "nothing cached" in name else "cache"
                found[name].append(spent(command, f"{folder}/bytecode", f"{folder}/{cache}"))
    figures = {
        name: {
            "processor_s": [
                round(f([run[0] for run in runs[-asked.runs :]]), 3) for f in (min, median, max)
            ],
            "wall_s": [
                round(f([run[1] for run in runs[-asked.runs :]]), 3) for f in (min, median, max)
            ],
        }
        for name, runs in found.items()
    }
    if asked.json:
        print(json.dumps(figures, indent=2))
        return
    scale = scene.REFERENCE_S / figures["ten million additions"]["processor_s"][1]
    print(f"{'':38}  processor time [s]     wall time [s]       reference [s]")
    print(f"{'':38}  min   median  max      min   median  max    processor")
    for name, row in figures.items():
        cells = [
            "  ".join(f"{each:5.2f}" for each in row[key]) for key in ("processor_s", "wall_s")
        ]
        print(f"{name:38} {cells[0]}    {cells[1]}    {scale * row['processor_s'][1]:5.2f}")


if __name__ == "__main__":
    main()
