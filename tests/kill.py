"""Kill a process at random moments while it adds observations, and see what is left.

Run by hand: ``python tests/kill.py 200``. After each kill the store is opened and checked: every
acknowledged observation is whole, no other is visible, and the store can be written again.
"""

import random
import signal
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, replace
from pathlib import Path

from observations import drink_from_mug, pick_up_with_both_hands, with_unknown

from capar.model.observation import Observation
from kb.actionary import Actionary
from kb.checks import check
from kb.encode.observation import encode

MADE = (drink_from_mug, pick_up_with_both_hands, with_unknown)
LONGEST_S = 0.6
"""Latest moment of a kill after the child's first word [s]."""

EARLY = 0.2
"""Share of the kills that do not wait for that word, and so may come while the store is opened."""

A_FOLDER = 20
"""How many kills a folder bears before the next one is used."""


def numbered(index: int) -> Observation:
    """One of many observations, by its number."""
    return replace(MADE[index % len(MADE)](), capture=f"o{index}")


def add_for_ever(folder: str, start: int) -> None:
    """Add observations, forget and replace some, and say what is done once it is."""
    say = sys.stdout
    with Actionary.open(folder, wait_s=10) as actionary:
        say.write("ready\n")
        say.flush()
        index = start
        while True:
            actionary.add(numbered(index))
            say.write(f"added {index}\n")
            say.flush()
            if index % 5 == 4 and index > start:
                say.write(f"forgetting {index - 1}\n")
                say.flush()
                actionary.forget(f"o{index - 1}")
                say.write(f"forgot {index - 1}\n")
                say.flush()
            if index % 7 == 6:
                actionary.add(numbered(index))
            index += 1


@dataclass
class Left:
    """What must be there after kills."""

    sure: set[str]
    """Acknowledged, and never asked to be forgotten."""

    perhaps: set[str]
    """In the middle of being added or forgotten when the process was killed."""


@dataclass(frozen=True)
class Outcome:
    """What many kills left."""

    kills: int
    acknowledged: int
    problems: tuple[str, ...]


def kill_once(folder: Path, start: int, moment_s: float, left: Left, *, early: bool) -> int:
    """Let a process add from a number on, and kill it; the next free number."""
    child = subprocess.Popen(
        [sys.executable, __file__, "child", str(folder), str(start)],
        stdout=subprocess.PIPE,
        text=True,
    )
    assert child.stdout is not None
    if not early:
        child.stdout.readline()
    time.sleep(moment_s)
    child.send_signal(signal.SIGKILL)
    lines = child.stdout.read().splitlines()
    child.wait()
    last = start - 1
    for word, number in (each.split() for each in lines if each.count(" ") == 1):
        name = f"o{number}"
        if word == "added":
            left.sure.add(name)
            last = max(last, int(number))
        elif word == "forgetting":
            left.sure.discard(name)
            left.perhaps.add(name)
        elif word == "forgot":
            left.perhaps.discard(name)
    left.perhaps.add(f"o{last + 1}")
    return last + 2


def problems_of(folder: Path, left: Left) -> list[str]:
    """What a store has that it ought not to have, or has not."""
    with Actionary.open(folder) as actionary:
        names = {each.name for each in actionary.observations()}
        found = [f"lost: {each}" for each in sorted(left.sure - names)]
        found += [f"half or unasked: {each}" for each in sorted(names - left.sure - left.perhaps)]
        found += [str(each) for each in check(actionary.store, full=False)]
        for name in sorted(names):
            statements = encode(numbered(int(name[1:])))
            own = {str(each) for each in actionary.store.graph(statements.about)}
            expected = {str(e) for e in statements.quads if e.graph_name == statements.about}
            if own != expected:
                found.append(f"torn: {name}")
    left.sure |= left.perhaps & names
    left.perhaps.clear()
    return found


def run(kills: int, *, seed: int = 0, folder: Path) -> Outcome:
    """Kill so many times, and say what was left."""
    moments = random.Random(seed)
    problems: list[str] = []
    acknowledged, start, left = 0, 0, Left(set(), set())
    for number in range(kills):
        if number % A_FOLDER == 0:
            acknowledged += len(left.sure)
            start, left = 0, Left(set(), set())
        place = folder / f"store{number // A_FOLDER}"
        moment_s, early = moments.uniform(0.0, LONGEST_S), moments.random() < EARLY
        start = kill_once(place, start, moment_s, left, early=early)
        problems += [f"kill {number}: {each}" for each in problems_of(place, left)]
    return Outcome(kills, acknowledged + len(left.sure), tuple(problems))


def main() -> None:
    """Run by hand."""
    with tempfile.TemporaryDirectory() as folder:
        outcome = run(int(sys.argv[1]), folder=Path(folder))
    sys.stdout.write(
        f"{outcome.kills} kills, {outcome.acknowledged} observations acknowledged and present, "
        f"{len(outcome.problems)} problems\n"
    )
    sys.stdout.write("".join(f"{each}\n" for each in outcome.problems))
    sys.exit(bool(outcome.problems))


if __name__ == "__main__":
    if sys.argv[1] == "child":
        add_for_ever(sys.argv[2], int(sys.argv[3]))
    else:
        main()
