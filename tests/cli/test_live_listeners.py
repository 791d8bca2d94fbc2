"""Other programs receive the events that ``capar observe --live --json`` prints."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from bundles import DRINKING
from lsl_loopback import LOOPBACK

from capar.pipelines.live.event_socket import EventSocket

OBSERVE = ("-c", "from capar.cli import main; main()", "observe", "--live", DRINKING, "--json")

OF_WEBSOCKET = """
import sys
from websockets.sync.client import connect
with connect(sys.argv[1]) as connection:
    for message in connection:
        print(message, flush=True)
"""

OF_MARKERS = """
import sys
import pylsl
found = pylsl.resolve_byprop("name", sys.argv[1], timeout=60)
inlet = pylsl.StreamInlet(found[0], recover=False)
inlet.open_stream(timeout=10)
print(inlet.info().type(), flush=True)
try:
    while True:
        sample, stamp_s = inlet.pull_sample(timeout=20)
        if sample is None:
            break
        assert abs(pylsl.local_clock() - stamp_s) < 60
        print(sample[0], flush=True)
except pylsl.util.LostError:
    pass
"""


def started(*arguments: str, environment: dict[str, str] | None = None) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        env={**os.environ, **(environment or {})},
    )


def lines_of(process: subprocess.Popen[str]) -> list[str]:
    out, err = process.communicate(timeout=90)
    assert process.returncode == 0, err
    return out.splitlines()


def events(lines: list[str]) -> list[str]:
    """What was printed, without the observation at the end."""
    *told, last = lines
    assert last.startswith('{"event": "observation"')
    assert len(told) > 5
    return told


@pytest.mark.long
def test_a_program_on_the_websocket_receives_every_event_and_then_the_end() -> None:
    pytest.importorskip("websockets")
    observing = started(*OBSERVE, "--speed", "2", "--websocket", "0")
    assert observing.stderr is not None
    said = observing.stderr.readline()
    assert said.startswith("events at ws://127.0.0.1:")
    listening = started("-c", OF_WEBSOCKET, said.split()[-1])
    printed = events(lines_of(observing))
    assert lines_of(listening) == printed


def test_who_connects_late_is_told_what_came_before_and_all_are_told_the_end() -> None:
    client = pytest.importorskip("websockets.sync.client")
    socket = EventSocket(0)
    socket.send("one")
    with client.connect(socket.address) as early:
        assert early.recv(timeout=5) == "one"
        socket.send("two")
        with client.connect(socket.address) as late:
            assert [late.recv(timeout=5), late.recv(timeout=5)] == ["one", "two"]
            socket.close()
            assert list(late) == []
        assert list(early) == ["two"]


@pytest.mark.parametrize(
    "origin",
    [
        "https://example.org",
        "http://localhost.example.org",
    ],
)
def test_a_page_of_another_site_is_refused_before_it_is_told_anything(origin: str) -> None:
    client = pytest.importorskip("websockets.sync.client")
    exceptions = pytest.importorskip("websockets.exceptions")
    socket = EventSocket(0)
    socket.send("one")
    try:
        with pytest.raises(exceptions.InvalidStatus) as refused:
            client.connect(socket.address, origin=origin)
        assert refused.value.response.status_code == 403
    finally:
        socket.close()


@pytest.mark.long
def test_a_program_that_records_markers_receives_every_event(tmp_path: Path) -> None:
    pytest.importorskip("pylsl")
    settings = tmp_path / "lsl_api.cfg"
    settings.write_text(LOOPBACK)
    alone = {"LSLAPICFG": str(settings)}
    listening = started("-c", OF_MARKERS, "capar_test_events", environment=alone)
    observing = started(
        *OBSERVE, "--speed", "1", "--lsl-markers", "capar_test_events", environment=alone
    )
    printed = events(lines_of(observing))
    assert lines_of(listening) == ["Markers", *printed]
