"""What `capar observe` takes, stage by stage, against the length of a recording.

``python benchmarks/observing.py [--minutes 1 2 3 5 10] [--sensors 5 12] [--faces 10000] [--json]``

Hands, feet and a head, more sensors on trunk and limbs where more are asked for, and eight objects
with meshes of 10,000 faces, at 100 Hz. Each recording is written as a CSV with its meshes and
observed by the command, in a process of its own: one that observes again knows more than a command
does. A row is the time within a stage alone, without that of stages that it calls, so that rows add
up: ``start`` is the interpreter with its imports, ``end`` how it ends, ``elsewhere`` all that has
no row. Rows are of the first core; what a second one measures meanwhile is in the processor time of
the row that waits for it. Longer ones, ``--minutes 30 60``, take as long again as all before.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import redirect_stdout, suppress
from functools import wraps
from importlib import import_module
from pathlib import Path
from types import GeneratorType
from typing import Any

OTHER_CORE = "waiting for the other core"
STAGES: dict[str, tuple[str, ...]] = {
    "rules read": ("capar.cli.options.rule_base",),
    "reading": ("extractors.readers.bundle.capture_toml.read_capture",),
    "gaps, noise, low-pass": (
        "extractors.bodies.poses.poses_of",
        "extractors.signals.filters.lowpass",
        "extractors.signals.filters.lowpass_orientations",
    ),
    "calibration": ("extractors.calibration.calibrated",),
    "touching distances": ("extractors.contact.contacts.pair_distances",),
    "rest poses": (
        "extractors.motion.object_motion.rest_poses",
        "extractors.motion.motion_edges.standstills",
    ),
    "zero crossings": ("extractors.signals.zero_crossings.zero_crossings",),
    "line of sight": ("extractors.relations.attention.attention",),
    "contact": (
        "extractors.contact.contacts.contacts",
        "extractors.contact.contacts.arrivals",
        "extractors.contact.contacts.blows",
    ),
    OTHER_CORE: (
        "extractors.cores._split_off",
        "extractors.cores.shared",
    ),
    "contact normals": (
        "extractors.contact.normals.contact_normal",
        "extractors.motion.impacts.closing_speed",
    ),
    "motion of objects": (
        "extractors.motion.object_motion.moving",
        "extractors.motion.motion_edges.motion_edges",
    ),
    "guides": ("extractors.relations.guides.parts",),
    "places and distances": (
        "extractors.relations.places.places",
        "extractors.relations.places.distances",
    ),
    "arrangements": (
        "extractors.measure._Trial._arranged",
        "extractors.relations.arrangement.between",
        "extractors.relations.arrangement.company",
    ),
    "handling besides": ("extractors.measure._Trial.handling",),
    "faults": ("extractors.faults.faults.faults",),
    "measuring besides": ("extractors.measure.measured",),
    "flicker": ("capar_rules.borders.deflicker.steady",),
    "numbering borders": ("capar_rules.borders.numbering.number_borders",),
    "facts to text": ("capar_rules.engine.solver._texts", "capar.model.facts.program"),
    "ground and solve": ("capar_rules.engine.solver.solve",),
    "answers back": ("capar_rules.engine.solver._shown", "capar_rules.pars.inference.infer"),
    "movers": ("capar_rules.movers.movers.movers",),
    "motion of segments": ("extractors.segments.moved_path",),
    "locations": ("extractors.segments.constraint_location",),
    "styles": ("extractors.segments.style",),
    "tracks": ("extractors.segments.sampled_tracks",),
    "forces": ("extractors.forces.forces.force_styles",),
    "PARs": (
        "capar_rules.pars.pars.upars",
        "capar_rules.pars.pars.ipars",
        "capar_rules.pars.pars.compose",
        "capar_rules.pars.pars.naming_rules",
    ),
    "observing besides": ("capar.pipelines.observation.observe_measured",),
    "printing": ("capar.cli.observe._print",),
}
"""Every stage that is timed, and the functions whose time it is, where they are defined."""

INSIDE = tuple(each for each in STAGES if each not in ("rules read", "reading", "printing"))
"""What is done from a capture that is read to its observation."""

BOTH_WAYS = ("facts to text", "answers back")
REASONING = ("numbering borders", *BOTH_WAYS, "ground and solve")
PACKAGES = ("capar", "capar_rules", "extractors", "kb", "ontology")
FACTOR = 1.5
"""The best length may be so many times as fast as any other [1]."""


class Clock:
    """Wall and processor time of stages, each without the stages that it calls."""

    def __init__(self) -> None:
        self.spent = {stage: [0.0, 0.0] for stage in ("start", *STAGES, "elsewhere")}
        self.called: set[str] = set()
        self.stack = ["elsewhere"]
        self.place = os.getpid(), threading.get_ident()
        self.at = now()

    def switch(self) -> None:
        """Add the time since the last switch to the stage that runs."""
        at = now()
        row = self.spent[self.stack[-1]]
        row[0] += at[0] - self.at[0]
        row[1] += at[1] - self.at[1]
        self.at = at

    def timed(self, stage: str, place: str, function: Callable[..., Any]) -> Callable[..., Any]:
        """The function, which adds the time that it takes to its stage's."""

        @wraps(function)
        def timed(*arguments: Any, **options: Any) -> Any:
            if self.place != (os.getpid(), threading.get_ident()):
                return function(*arguments, **options)
            self.switch()
            self.stack.append(stage)
            self.called.add(place)
            try:
                found = function(*arguments, **options)
                # What is yielded later would be the time of who asks for it.
                return iter(list(found)) if isinstance(found, GeneratorType) else found
            finally:
                self.switch()
                self.stack.pop()

        return timed


def now() -> tuple[float, float]:
    """Time of the system, and processor time of this process and of those it waited for [s]."""
    ended = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.monotonic(), time.process_time() + ended.ru_utime + ended.ru_stime


def install(clock: Clock) -> None:
    """Time every function of the stages wherever it is known by its name.

    Raises:
        AttributeError: There is no function of that name.
    """
    loaded = {place: owner_of(place) for places in STAGES.values() for place in places}
    for stage, places in STAGES.items():
        for place in places:
            owner, name = loaded[place], place.rpartition(".")[2]
            function = getattr(owner, name)
            timed = clock.timed(stage, place, function)
            setattr(owner, name, timed)
            for module in [each for n, each in sys.modules.items() if n.split(".")[0] in PACKAGES]:
                for key, value in list(vars(module).items()):
                    if value is function:
                        setattr(module, key, timed)


def owner_of(place: str) -> Any:
    """The module or class that holds what a dotted name means."""
    module, *rest = place.split(".")
    owner = import_module(module)
    for name in rest[:-1]:
        if not hasattr(owner, name):
            import_module(f"{owner.__name__}.{name}")
        owner = getattr(owner, name)
    getattr(owner, rest[-1])
    return owner


def command(folder: str, spawned_s: float) -> dict[str, Any]:
    """Be ``capar observe FOLDER`` in a process that began then, and say what took how long."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as `capar` itself sets it, before numpy
    clock = Clock()
    install(clock)
    started = now()
    from capar.cli import main

    clock.spent["start"] = [started[0] - spawned_s, started[1]]
    clock.at = started
    observation = import_module("capar.pipelines.observation")
    function, seen = observation.observe_measured, []

    def kept(*arguments: Any, **options: Any) -> Any:
        seen.append(function(*arguments, **options))
        return seen[-1]

    observation.observe_measured = kept
    sys.argv = ["capar", "observe", folder, "--on-unknown", "keep"]
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere), suppress(SystemExit):
        main()
    clock.switch()
    if not seen:
        sys.exit("benchmarks/observing.py: `capar observe` failed")
    missed = {place for places in STAGES.values() for place in places} - clock.called
    split = "extractors.cores._split_off"
    if missed - {split} and split not in clock.called:  # else the second core may have called it
        sys.exit(f"benchmarks/observing.py: `capar observe` called no {', '.join(sorted(missed))}")
    return {
        "spent": clock.spent,
        "facts": len(seen[0].facts),
        "segments": len(seen[0].segments),
        "memory_gb": peak_memory_gb(),
    }


def peak_memory_gb() -> float:
    """The most memory that this process held; getrusage counts that of who forked it, too."""
    with suppress(OSError, StopIteration):
        lines = Path("/proc/self/status").read_text(encoding="ascii").splitlines()
        return int(next(each for each in lines if each.startswith("VmHWM")).split()[1]) / 2**20
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20


def written(minutes: float, sensors: int, faces: int, folder: Path) -> None:
    """Write the recording of a length, in a process of its own, whose memory ends with it."""
    from capar.body.recording import Truth, write_bundle

    capture = scene.with_trunk(scene.capture(minutes, faces=faces), sensors)
    write_bundle(capture, Truth((), (), (), ()), folder)
    about = folder / "capture.toml"
    with about.open("a", encoding="utf-8") as file:
        file.write(f"\n[contact]\ntolerance_m = {capture.contact_tolerance_m}\n")


def row(minutes: float, sensors: int, faces: int) -> dict[str, Any]:
    """What a recording takes: the stages, and all of it."""
    with tempfile.TemporaryDirectory() as folder:
        asked = f"{minutes} {sensors} {faces}".split()
        subprocess.run([sys.executable, __file__, "--write", folder, *asked], check=True)
        before_s = loop_s()
        begin, before = now()
        done = subprocess.run(
            [sys.executable, __file__, "--command", folder, repr(begin)],
            check=False,
            capture_output=True,
            text=True,
        )
        end, after = now()
        loop = (before_s + loop_s()) / 2.0
    if done.returncode:
        sys.exit(done.stderr)
    found = json.loads(done.stdout)
    stages, whole = found["spent"], [end - begin, after - before]
    stages["end"] = [
        whole[index] - sum(each[index] for each in stages.values()) for index in (0, 1)
    ]
    return {"minutes": minutes, "sensors": sensors, "loop_s": loop, "whole": whole, **found}


def loop_s() -> float:
    """Processor time of ten million additions in a loop of Python [s]."""
    begin = now()[1]
    subprocess.run([sys.executable, "-c", scene.ADDITIONS], check=True)
    return now()[1] - begin


def table(rows: list[dict[str, Any]]) -> Iterator[str]:
    """A column for each length: stages, how much faster than real time, and other figures."""

    def line(title: str, cells: Iterable[str]) -> str:
        return (f"{title:26}" + "".join(f"{each:>21}" for each in cells)).rstrip()

    def times(title: str, spent: Iterable[list[float]]) -> str:
        both = zip(spent, rows, strict=True)
        return line(
            title, (f"{a:9.2f}{b:8.2f}{100.0 * a / r['whole'][0]:4.0f}" for (a, b), r in both)
        )

    yield ""
    yield line(f"{rows[0]['sensors']} sensors", (f"{row['minutes']:g} min    " for row in rows))
    yield line("", ["wall s   cpu s   %"] * len(rows))
    for stage in rows[0]["spent"]:
        yield times(stage, (row["spent"][stage] for row in rows))
    yield times("the command", (row["whole"] for row in rows))
    yield line("ten million additions [s]", (f"{row['loop_s']:.2f}       " for row in rows))
    yield "times real time, by wall and by processor time, and how much faster the best length is"
    for title, stages in (
        ("  the command", ("start", *STAGES, "elsewhere", "end")),
        ("  what is observed", INSIDE),
    ):
        speeds = [
            [60.0 * row["minutes"] / spent(row, *stages)[way] for row in rows] for way in (0, 1)
        ]
        best = [max(speeds[0]) / each for each in speeds[0]]
        cells = zip(*speeds, best, strict=True)
        yield line(
            title,
            (f"{a:.1f}{b:8.1f}{far:6.2f}{'!' if far > FACTOR else ' '}" for a, b, far in cells),
        )
        scaled = (
            f"{speed * row['loop_s'] / scene.REFERENCE_S:.1f}              "
            for speed, row in zip(speeds[0], rows, strict=True)
        )
        yield line("  ... on the reference machine", scaled)
    figures = {
        # What the other core is waited for is contact, and other measuring beside it.
        "contact, x real time": (
            60.0 * row["minutes"] / spent(row, "contact", OTHER_CORE)[0] for row in rows
        ),
        "reasoning [s]": (spent(row, *REASONING)[0] for row in rows),
        "facts there and back [%]": (
            100.0 * spent(row, *BOTH_WAYS)[0] / spent(row, *INSIDE)[0] for row in rows
        ),
        "facts": (row["facts"] for row in rows),
        "segments": (row["segments"] for row in rows),
        "peak memory [GB]": (row["memory_gb"] for row in rows),
    }
    for title, values in figures.items():
        yield line(
            title,
            (f"{value:,.4g}       " if value < 1e4 else f"{value:,.0f}       " for value in values),
        )


def spent(row: dict[str, Any], *stages: str) -> tuple[float, float]:
    """Wall and processor time of some stages together [s]."""
    wall, processor = (sum(row["spent"][stage][way] for stage in stages) for way in (0, 1))
    return wall, processor


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, nargs="+", default=[1.0, 2.0, 3.0, 5.0, 10.0])
    parser.add_argument("--sensors", type=int, nargs="+", default=[5, 12], help="5 or more each")
    parser.add_argument("--faces", type=int, default=10_000, help="of a mesh")
    parser.add_argument("--json", action="store_true", help="print the figures as JSON")
    options = parser.parse_args()
    row(0.1, options.sensors[0], options.faces)  # writes bytecode, as an installation does
    found = [
        [row(minutes, sensors, options.faces) for minutes in options.minutes]
        for sensors in options.sensors
    ]
    if options.json:
        print(json.dumps({"rows": [each for rows in found for each in rows]}, indent=2))
        return
    for rows in found:
        print("\n".join(table(rows)), flush=True)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--command"]:
        print(json.dumps(command(sys.argv[2], float(sys.argv[3]))))
        sys.exit()
    import scene  # what a command imports is for the command to import

    if sys.argv[1:2] == ["--write"]:
        written(float(sys.argv[3]), int(sys.argv[4]), int(sys.argv[5]), Path(sys.argv[2]))
    else:
        main()
