"""Many captures by one process, by several and by a cluster, and a run that is killed halfway.

``python benchmarks/many.py [--captures 200] [--jobs 2] [--rounds 3]`` writes that many captures
(the shipped one with other draws of noise), observes them into a new Actionary each
time, and prints wall times of whole commands and their ratio. Then one run is killed when half of
them are kept, and started again, and, where the package distributed is, two dask workers observe
them. All Actionaries must say the same, statement for statement, but for when that was.
"""

import argparse
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from importlib import resources
from importlib.util import find_spec
from pathlib import Path

import numpy as np

from kb.actionary import Actionary
from kb.exchange import export

NOISE_M = 0.0001
OBSERVE = [sys.executable, "-c", "from capar.cli import main; main()", "observe"]


def write_captures(folder: Path, count: int) -> None:
    """The shipped capture, each time with a name and a draw of noise of its own."""
    demo = Path(str(resources.files("capar"))) / "demo" / "drink_from_mug"
    text = (demo / "capture.toml").read_text()
    header, *_ = (demo / "motion.csv").read_text().splitlines()
    motion = np.loadtxt(demo / "motion.csv", delimiter=",", skiprows=1)
    places = [n for n, name in enumerate(header.split(",")) if name[-2:] in {"_x", "_y", "_z"}]
    random = np.random.default_rng(0)
    for number in range(count):
        own = folder / f"c{number:04}"
        shutil.copytree(demo, own, ignore=shutil.ignore_patterns("motion.csv", "truth.toml"))
        (own / "capture.toml").write_text(text.replace('"drink_from_mug"', f'"{own.name}"', 1))
        noisy = motion.copy()
        noisy[:, places] += random.normal(0.0, NOISE_M, (len(motion), len(places)))
        path = own / "motion.csv"
        np.savetxt(path, noisy, "%.7f", ",", header=header, comments="")


def observe(folder: Path, place: Path, *options: str) -> float:
    """Observe them into an Actionary; the wall time of the command [s]."""
    began = time.perf_counter()
    command = [*OBSERVE, str(folder), "--new", "--quiet", "--actionary", str(place), *options]
    subprocess.run(command, check=True)
    return time.perf_counter() - began


def kill_halfway(folder: Path, place: Path, count: int, jobs: int) -> int:
    """Kill a run when half of the captures are kept; how many are there then."""
    command = [*OBSERVE, str(folder), "--new", "--jobs", str(jobs), "--actionary", str(place)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for line in process.stdout:
            if int(line.partition("/")[0]) >= count // 2:
                break
        process.send_signal(signal.SIGKILL)
    with Actionary.open(place, read_only=True) as book:
        return len(book.observations())


def statements(place: Path) -> set[str]:
    """Every statement of the observations, without when they were made."""
    with Actionary.open(place, read_only=True) as book:
        texts = (export(book.store, "nquads", observation=o.name) for o in book.observations())
        return {line for text in texts for line in text.splitlines()}


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--captures", type=int, default=24)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=1)
    asked = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as folder:
        return compare(Path(folder), asked.captures, asked.jobs, asked.rounds)


def compare(folder: Path, count: int, jobs: int, rounds: int) -> int:
    captures = folder / "captures"
    write_captures(captures, count)
    ratios = []
    for number in range(rounds):
        one = observe(captures, folder / f"one{number}")
        several = observe(captures, folder / f"several{number}", "--jobs", str(jobs))
        ratios.append(one / several)
        print(
            f"{count} captures: one process {one:.1f} s, {jobs} jobs {several:.1f} s: "
            f"{one / several:.2f} times"
        )
    print(f"median {sorted(ratios)[rounds // 2]:.2f} times")
    found = {"one process": "one0", f"{jobs} jobs": "several0", "killed and resumed": "killed"}
    kept = kill_halfway(captures, folder / "killed", count, jobs)
    observe(captures, folder / "killed", "--jobs", str(jobs), "--wait", "60")
    print(f"killed with {kept} of {count} kept, then resumed")
    if find_spec("distributed"):
        from distributed import LocalCluster

        with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
            address = cluster.scheduler_address
            took = observe(captures, folder / "cluster", "--scheduler", address)
        found["two dask workers"] = "cluster"
        print(f"two dask workers {took:.1f} s")
    said = {name: statements(folder / place) for name, place in found.items()}
    first = said["one process"]
    for name, own in said.items():
        print(f"{name}: {len(own)} statements, {len(own ^ first)} differ")
    return int(any(own != first for own in said.values()))


if __name__ == "__main__":
    sys.exit(main())
