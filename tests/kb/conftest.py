"""An Actionary of each kind: in memory, in a folder, and at a real server on loopback."""

import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import motions
import pytest
from actionaries import ACTIONS, STORES, opened, oxigraph_binary
from competency import World

from capar.model.observation import Observation
from capar.pipelines.observation import observe
from kb.actionary import Actionary
from kb.errors import StoreError
from kb.store.stores import RemoteStore


@pytest.fixture(scope="session")
def server() -> Iterator[str]:
    """The address of a server that runs while the tests do."""
    with _served() as address:
        yield address


@pytest.fixture(params=STORES)
def burdened(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Actionary]:
    """An empty Actionary of each kind; a server of its own may go on with what was stopped."""
    if request.param == "server":
        with _served() as address, Actionary.open(address) as fresh:
            yield fresh
    else:
        with opened(request.param, tmp_path, request) as fresh:
            yield fresh


@pytest.fixture
def union_server() -> Iterator[str]:
    """The address of an empty server whose default graph is always the union of the others."""
    with _served("--union-default-graph") as address:
        yield address


@contextmanager
def _served(*options: str) -> Iterator[str]:
    binary = oxigraph_binary()
    if binary is None:
        pytest.skip("no oxigraph program beside this Python or on the path")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    running = subprocess.Popen(
        [binary, "serve", "--bind", f"127.0.0.1:{port}", *options],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    address = f"http://127.0.0.1:{port}"
    for _ in range(200):
        try:
            RemoteStore(address)
            break
        except StoreError:
            time.sleep(0.05)
    try:
        yield address
    finally:
        running.kill()
        running.wait()


@pytest.fixture(params=STORES)
def actionary(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Actionary]:
    """An empty Actionary, of each kind in turn."""
    with opened(request.param, tmp_path, request) as fresh:
        yield fresh


@pytest.fixture(scope="session")
def five_by_three() -> tuple[Observation, ...]:
    """The five test actions by three performers, observed as the thesis does."""
    performers = motions.PERFORMERS
    return tuple(
        observe(trial(performer).capture, rules="thesis", name=name)
        for performer in performers
        for name, trial in ACTIONS.items()
    )


@pytest.fixture(scope="session")
def extended_five_by_three() -> tuple[Observation, ...]:
    """The same by the default rules; only the first performer's actions are given a name."""
    first, *others = motions.PERFORMERS
    named = [observe(trial(first).capture, name=name) for name, trial in ACTIONS.items()]
    unnamed = [observe(trial(each).capture) for each in others for trial in ACTIONS.values()]
    return (*named, *unnamed)


@pytest.fixture(scope="session")
def world() -> World:
    """What is observed of the demo and of recordings, with what it rests on."""
    return World()
