"""What bodies are called in prose, where that is not their name."""

from collections import Counter
from collections.abc import Mapping

from capar.model.observation import Observation, ObservedLink

FINGERS: Mapping[str, str] = {
    "thumb": "thumb",
    "index": "index finger",
    "middle": "middle finger",
    "ring": "ring finger",
    "pinky": "little finger",
    "little": "little finger",
}
"""What parts of a hand are called, by their kind without the number of a joint."""

ORDINALS = ("first", "second", "third", "fourth")


def body_names(observation: Observation) -> dict[str, str]:
    """What bodies are called where that is not their name, by name.

    An object is called by its kind if that has several words and no other object is of it; a finger
    by the hand that it is of, and by the joint where several joints of it are told apart.
    """
    kinds = Counter(thing.kind for thing in observation.objects)
    names = {}
    for thing in observation.objects:
        alone = "_" in thing.kind and kinds[thing.kind] == 1
        words = (thing.kind if alone else thing.name).replace("_", " ")
        if alone or thing.assumed:
            names[thing.name] = f"assumed {words}" if thing.assumed else words
    fingers = {link.ee: told for link in observation.links if (told := _finger(link))}
    count = Counter(fingers.values())
    for link in observation.links:
        finger = fingers.get(link.ee)
        if finger:
            alone = count[finger] == 1
            names[link.ee] = finger if alone else f"{_joint(link.kind)} joint of the {finger}"
    return {name: told for name, told in names.items() if told}


def _finger(link: ObservedLink) -> str:
    """Which finger of which hand an end-effector is; empty if it is none, or of no known side."""
    finger = FINGERS.get(link.kind.rstrip("0123456789"), "")
    known = finger and link.side in ("left", "right")
    whose = f"{link.agent} ".replace("_", " ") if link.agent else ""
    return f"{whose}{link.side} {finger}" if known else ""


def _joint(kind: str) -> str:
    number = kind[len(kind.rstrip("0123456789")) :]
    return ORDINALS[int(number) - 1] if number in ("1", "2", "3", "4") else number or "first"
