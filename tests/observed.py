"""Observations of recordings of others that several files of tests make claims about, made once.

Workers share them through files in the folder of the run, which are there whole or not at all; of
two workers that begin at once both observe, and each gets the same.
"""

import os
import pickle
from hashlib import sha256
from pathlib import Path

import pytest

from capar.model.observation import Observation
from capar.pipelines.observation import observe


def observed(place: object, run: pytest.TempPathFactory) -> Observation:
    """The observation of an example by the default rules.

    Args:
        place: What `observe` is given.
        run: By which the folder of the run is found.
    """
    base = run.getbasetemp()
    shared = base.parent if "PYTEST_XDIST_WORKER" in os.environ else base
    known = shared / f"observed-{sha256(str(place).encode()).hexdigest()}.pickle"
    if not known.exists():
        made = observe(Path(str(place)))
        draft = known.with_name(f"{known.name}.{os.getpid()}")
        draft.write_bytes(pickle.dumps(made))
        draft.replace(known)
    found = pickle.loads(known.read_bytes())
    assert isinstance(found, Observation)
    return found
