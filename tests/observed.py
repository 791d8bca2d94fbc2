"""Observations of recordings and virtual performances that several files of tests need, made once.

Workers share them through files in the folder of the run, which are there whole or not at all; of
two workers that begin at once both observe, and each gets the same.
"""

import os
import pickle
from collections.abc import Callable
from dataclasses import fields
from hashlib import sha256
from pathlib import Path
from typing import Any, TypeVar

import pytest

from capar.body import scripted_actions
from capar.body.human import Human
from capar.body.performing import Performance, perform
from capar.body.scripts import Script
from capar.body.virtual_scenes import Scene
from capar.model.observation import Observation
from capar.pipelines.observation import observe


def observed(place: object, run: pytest.TempPathFactory) -> Observation:
    """The observation of an example by the default rules.

    Args:
        place: What `observe` is given.
        run: By which the folder of the run is found.
    """
    return _once(f"observed {place}", lambda: observe(Path(str(place))), run)


def performed(run: pytest.TempPathFactory) -> Callable[..., Performance]:
    """What takes the place of `perform` for scripted actions.

    Args:
        run: By which the folder of the run is found.
    """

    def once(human: Human, scene: Scene, script: Script, *, rate_hz: float) -> Performance:
        def made() -> dict[str, Any]:
            found = perform(human, scene, script, rate_hz=rate_hz)
            return {each: getattr(found, each) for each in parts}

        given = {"human": human, "scene": scene, "script": script}
        parts = [each.name for each in fields(Performance) if each.name not in given]
        action = next(name for name, own in scripted_actions.ACTIONS.items() if own is script)
        by = sorted(human.measures.values.items())
        return Performance(**given, **_once(f"performed {action} {by} {rate_hz}", made, run))

    return once


_Made = TypeVar("_Made")


def _once(name: str, make: Callable[[], _Made], run: pytest.TempPathFactory) -> _Made:
    base = run.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    known = shared / f"{sha256(name.encode()).hexdigest()}.pickle"
    if not known.exists():
        draft = known.with_name(f"{known.name}.{os.getpid()}")
        draft.write_bytes(pickle.dumps(make()))
        draft.replace(known)
    found: _Made = pickle.loads(known.read_bytes())
    return found
