"""How long `capar open` takes until a capture is seen and understood, and how fast it scrubs.

``python benchmarks/window.py [--minutes 5] [--faces 10000] [--seconds 3] [--json]``

The shipped demo and a capture of the benchmark's scene (12 sensors, 100 Hz) are opened, each in a
process of its own, with a client that takes what is sent as a page does. Times are processor times
of that process from its start: until the scene is shown, until segments are, and until every panel
is there. Then the slider is moved 60 times a second; what is counted are moments that were shown,
in wall time. Ten million additions of Python are timed beside it; shown and observed are also
printed as on a machine that takes 0.7 s for them.
"""

import argparse
import json
import subprocess
import sys
import tempfile
import threading
import time
from importlib import resources
from pathlib import Path

import scene

DEMO = str(resources.files("capar") / "demo" / "drink_from_mug")


def opened(place: str, seconds: float) -> dict[str, float]:
    """Open a capture here, and scrub through it for some seconds."""
    from capar.workbench.folders import Folders
    from capar.workbench.see import See
    from capar.workbench.why import Why
    from capar.workbench.window import Settings, Window

    window = Window(Folders([Path(place)]), Settings())
    client = threading.Thread(target=consume, args=(window.address,), daemon=True)
    client.start()
    window.add(See)
    window.add(Why)
    window.open(place, observe=False)
    shown = time.process_time()
    first = window.updates
    begun, spent = time.monotonic(), time.process_time()
    steps = 0
    while time.monotonic() - begun < seconds:
        window.seek(window.duration_s * (steps % 200) / 200.0)
        steps += 1
        time.sleep(1.0 / 60.0)
    rate = (window.updates - first) / (time.monotonic() - begun)
    cost_ms = 1e3 * (time.process_time() - spent) / max(window.updates - first, 1)
    before = time.process_time()
    window.observe()
    window.jobs.wait(600.0)
    understood = shown + time.process_time() - before
    moments = window.updates
    begun = time.monotonic()
    for step in range(int(60 * seconds)):
        window.seek(window.duration_s * (step % 200) / 200.0)
        time.sleep(1.0 / 60.0)
    after = (window.updates - moments) / (time.monotonic() - begun)
    window.close()
    before = time.process_time()
    exec(scene.ADDITIONS)
    return {"shown_s": shown, "observed_s": understood, "updates_per_s": rate,
            "observed_updates_per_s": after, "update_cpu_ms": cost_ms,
            "additions_s": time.process_time() - before}  # fmt: skip


def consume(address: str) -> None:
    """Take everything that is sent, as a page does."""
    import viser
    from websockets.sync.client import connect

    host = address.split("/")[2]
    with connect(
        address.partition("?")[0].rstrip("/").replace("http://", "ws://"),
        origin=f"http://{host}",  # type: ignore[arg-type]
        subprotocols=[f"viser-v{viser.__version__}"],  # type: ignore[list-item]
        max_size=None,
        proxy=None,
    ) as socket:
        for _ in socket:
            pass


def write(folder: str, minutes: float, faces: int) -> None:
    """Write a capture of the benchmark's scene."""
    from capar.body.recording import Truth, write_bundle

    capture = scene.with_trunk(scene.capture(minutes, faces=faces), 12)
    write_bundle(capture, Truth((), (), (), ()), Path(folder))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--minutes", type=float, default=5.0)
    parser.add_argument("--faces", type=int, default=10_000)
    parser.add_argument("--seconds", type=float, default=3.0)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--only", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.only:
        print(json.dumps(opened(given.only, given.seconds)))
        return
    rows = {}
    with tempfile.TemporaryDirectory() as folder:
        long = f"{folder}/long"
        write(long, given.minutes, given.faces)
        for name, place in (("demo", DEMO), (f"{given.minutes:g} minutes", long)):
            command = [sys.executable, __file__, "--only", place, "--seconds", str(given.seconds)]
            done = subprocess.run(command, capture_output=True, text=True, check=True)
            rows[name] = json.loads(done.stdout.splitlines()[-1])
    if given.json:
        print(json.dumps(rows, indent=2))
        return
    for name, row in rows.items():
        scale = scene.REFERENCE_S / row["additions_s"]
        scaled = {f"scaled_{key}": row[key] * scale for key in ("shown_s", "observed_s")}
        figures = {**row, **scaled}.items()
        print(f"{name}: " + ", ".join(f"{key} {value:.2f}" for key, value in figures))


if __name__ == "__main__":
    main()
