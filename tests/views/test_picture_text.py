"""Whatever people write is drawn as it is written."""

from dataclasses import replace
from pathlib import Path

import pytest
from observations import MUG, drink_from_mug

from capar.views.picture import draw


@pytest.mark.parametrize("text", ["$x_1^", r"\frac{a}", "50 % & <b>", "Tür – ø", ""])
def test_odd_text_is_drawn_as_it_is(text: str, tmp_path: Path) -> None:
    seen = drink_from_mug()
    odd = replace(seen, capture=text, objects=(replace(MUG, assumed=text), *seen.objects[1:]))
    draw(odd, {}, path=tmp_path / "out.svg")
    assert (tmp_path / "out.svg").stat().st_size > 1000
