"""What all tests share: this folder, whose observations and motions they import, and patience."""

import gc
import signal
import sys
from pathlib import Path

import pytest
from combinations import EVERY
from hypothesis import settings
from motion_files import recordings_folder

# The same examples every time: what a build says depends on the code alone.
settings.register_profile(
    "patient", deadline=None, derandomize=True, max_examples=100 if EVERY else 25
)
settings.load_profile("patient")

# In the background of a shell Ctrl-C is ignored, by all that is started from there too.
signal.signal(signal.SIGINT, signal.default_int_handler)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Run first what takes long, so that no worker is left alone with it at the end.

    A worker takes whole files, in the order of their first tests.
    """
    items.sort(key=lambda item: item.get_closest_marker("long") is None)


def pytest_collection_finish() -> None:
    """Spare the garbage collector the modules and thousands of tests, which stay to the end."""
    gc.collect()
    gc.freeze()


@pytest.fixture(scope="session", autouse=True)
def performances(tmp_path_factory: pytest.TempPathFactory) -> None:
    """What virtual bodies perform is performed once for all workers."""
    if actions := sys.modules.get("capar.body.scripted_actions"):
        from observed import performed

        vars(actions)["perform"] = performed(tmp_path_factory)


@pytest.fixture
def recordings(monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of real recordings, where the examples look for it too."""
    folder = recordings_folder()
    monkeypatch.setenv("CAPAR_DATA", str(folder))
    return folder
