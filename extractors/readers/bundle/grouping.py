"""Sensors on parts of one hand or foot, by their names, as one end-effector."""

from collections.abc import Sequence
from dataclasses import replace

from capar.model.capture import Capture, Notice, Role, Sensor, notice
from extractors.readers.bundle.links import chain_of
from extractors.readers.name_guesses import WHOLES, part_of, words_of

Parts = list[tuple[int, Sensor]]
"""Sensors of one end-effector, each with its rank in acting for it."""


def grouped(capture: Capture) -> Capture:
    """The capture with one end-effector for each hand and foot that several sensors ride on.

    Sensors are parts of one end-effector if they are of one agent and one side, act, and what they
    are (``end_effector``) names a part of a hand or of a foot: a palm and its fingers, a heel and
    its toes. The one that stands for the whole, as a palm does, acts for all; if it is named after
    a part it is called after the whole, such as ``right_hand``. What a part touches the
    end-effector touches; only its own motion, and that of what acts for it, are told.
    """
    for group in _groups(capture).values():
        if len(group) > 1:
            _, leader = min(group, key=lambda each: each[0])
            capture = _joined(capture, leader, [each for _, each in group if each is not leader])
    return capture


def _groups(capture: Capture) -> dict[tuple[str, str, str], Parts]:
    """The sensors of each agent's hands and feet."""
    out: dict[tuple[str, str, str], Parts] = {}
    for sensor in capture.sensors:
        found = part_of(sensor.end_effector)
        if found and sensor.side != "none" and sensor.role is Role.ACTS and not sensor.part_of:
            limb, rank = found
            _, named = part_of(sensor.name) or (limb, rank)
            key = (capture.agent_of(sensor), sensor.side, limb)
            out.setdefault(key, []).append((max(rank, named), sensor))
    return out


def _joined(capture: Capture, leader: Sensor, parts: Sequence[Sensor]) -> Capture:
    limb, _ = part_of(leader.end_effector) or (leader.end_effector, 0)
    name = _name(capture, leader, limb)
    link = leader.link if leader.end_effector == limb else f"{leader.side}_{chain_of(limb)}"
    whole = replace(leader, name=name, end_effector=limb, link=link)
    changed = {leader.name: whole}
    changed |= {each.name: replace(each, part_of=name, link=link) for each in parts}
    pivots = tuple(
        replace(
            each,
            first=name if each.first == leader.name else each.first,
            second=name if each.second == leader.name else each.second,
        )
        for each in capture.pivot_contacts
    )
    return replace(
        capture,
        sensors=tuple(changed.get(each.name, each) for each in capture.sensors),
        pivot_contacts=pivots,
        notices=(*capture.notices, _told(name, leader, parts)),
    )


def _name(capture: Capture, leader: Sensor, limb: str) -> str:
    """What the end-effector is called: its own name, or that of the whole where that is free."""
    whole = f"{leader.side}_{limb}"
    if leader.agent and capture.others:
        whole = f"{leader.agent}_{whole}"
    taken = leader.name in {each.name for each in capture.objects} or whole in capture.bodies
    called_whole = set(words_of(leader.name)) & set(WHOLES[limb])
    return leader.name if taken or called_whole else whole


def _told(name: str, leader: Sensor, parts: Sequence[Sensor]) -> Notice:
    names = [each.name for each in (leader, *parts)]
    return notice("sensors-grouped", name, sensors=", ".join(names))
