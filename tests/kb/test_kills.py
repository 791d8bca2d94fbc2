"""A process that is killed loses nothing acknowledged and leaves nothing half-visible."""

from pathlib import Path

import kill


def test_ten_kills_lose_nothing_and_tear_nothing(tmp_path: Path) -> None:
    outcome = kill.run(10, seed=1, folder=tmp_path)
    assert outcome.problems == ()
    assert outcome.kills == 10
    assert outcome.acknowledged > 0
