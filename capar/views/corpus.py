"""Statistics of many observations in one picture: how often, how long, and what follows what."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from capar.views.picture import INK, QUIET, save

if TYPE_CHECKING:
    from matplotlib.figure import Figure

ACTIONS = 25
"""So many actions are drawn, the most frequent ones."""

Rows = Sequence[Mapping[str, Any]]


def draw_corpus(title: str, answers: Mapping[str, Rows], path: Path) -> None:
    """Draw it to a PNG, SVG or PDF file, as the suffix says.

    Args:
        title: What is drawn.
        answers: To the questions ``statistics``, ``sequences`` and ``outliers``, by their names.
        path: The file, which is overwritten.

    Raises:
        FileError: The suffix is another one, or the file cannot be written.
    """
    save(lambda: _figure(title, **answers), path)


def _figure(title: str, statistics: Rows, sequences: Rows, outliers: Rows) -> "Figure":
    """Three panels over the same actions: counts by performer, durations, and what comes next."""
    from matplotlib.figure import Figure

    totals: dict[str, int] = {}
    for row in statistics:
        totals[row["action"]] = totals.get(row["action"], 0) + row["times"]
    actions = sorted(totals, key=lambda name: (-totals[name], name))[:ACTIONS]
    at = {name: number for number, name in enumerate(actions)}
    shown = [row for row in statistics if row["action"] in at]
    height = 1.9 + 0.28 * len(actions)
    figure = Figure(figsize=(13.0, height), facecolor="white", layout="constrained")
    left = f" ({len(totals) - len(actions)} rarer ones left out)" if len(totals) > ACTIONS else ""
    figure.suptitle(title + left, fontsize=13, weight="bold", color=INK)
    counts, durations, follows = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 1.2))
    base = np.zeros(len(actions))
    for who in dict.fromkeys(row["performer"] for row in shown):
        own = np.zeros(len(actions))
        for row in shown:
            own[at[row["action"]]] += row["times"] * (row["performer"] == who)
        counts.barh(range(len(actions)), own, left=base, label=who, height=0.7)
        base += own
    counts.set_xlabel("times")
    counts.legend(fontsize=8, loc="lower right")
    for row in shown:
        y = at[row["action"]]
        durations.plot([row["shortest"], row["longest"]], [y, y], color=QUIET, linewidth=3)
        durations.plot(row["mean"], y, "o", color=INK, markersize=4)
    for row in outliers:
        if row["action"] in at:
            durations.plot(row["seconds"], at[row["action"]], "x", color="#a33")
    durations.set_xlabel("duration [s]: range, mean (dot), outliers (cross)")
    shares = np.zeros((len(actions), len(actions)))
    for row in sequences:
        if row["action"] in at and row["next"] in at:
            shares[at[row["action"]], at[row["next"]]] = row["share"]
    image = follows.imshow(shares, cmap="Blues", vmin=0.0, vmax=1.0, aspect="auto")
    figure.colorbar(image, ax=follows, label="share")
    follows.set_xticks(range(len(actions)), actions, rotation=90, fontsize=8)
    follows.set_xlabel("followed by, with the same end-effector")
    for panel in (counts, durations, follows):
        panel.set_yticks(range(len(actions)), actions, fontsize=8)
        panel.set_ylim(len(actions) - 0.5, -0.5)
    return figure
