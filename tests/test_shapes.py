"""Every array has the shape that its signature states, all the way through an observation."""

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
WATCHED = """
import sys
from importlib.util import find_spec
from pkgutil import iter_modules

from jaxtyping import install_import_hook

places = find_spec("extractors").submodule_search_locations
names = [f"extractors.{each.name}" for each in iter_modules(places) if not each.ispkg]
names += ["capar.model.geometry", "capar.model.capture"]
with install_import_hook(names, "beartype.beartype"):
    from capar.pipelines.observation import observe
    sys.path.insert(0, sys.argv[1])
    import motions

for action in (motions.drink_from_mug, motions.pick_up_with_both_hands, motions.hit):
    for rules in ("thesis", "extended"):
        observe(action(motions.WOMAN, noise_m=0.002, noise_rad=0.01).capture, rules=rules)
"""


def test_shapes_are_as_stated() -> None:
    done = subprocess.run(
        [sys.executable, "-c", WATCHED, str(HERE)], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr[-3000:]
