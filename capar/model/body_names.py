"""What bodies are called in prose, where that is not their name."""

from collections import Counter
from collections.abc import Mapping

from capar.model.observation import Observation, ObservedLink

#: What parts of a hand are called, by their kind without the number of a joint
FINGERS: Mapping[str, str] = {
    "thumb": "thumb",
    "index": "index finger",
    "middle": "middle finger",
    "ring": "ring finger",
    "pinky": "little finger",
    "little": "little finger",
}
#: What letters in the names of sensors stand for
SIDES: Mapping[str, str] = {"l": "left", "r": "right"}
ORDINALS = ("first", "second", "third", "fourth")


def body_names(observation: Observation) -> dict[str, str]:
    """What bodies are called where that is not their name, by name.

    An object by its kind if no other is of it; a finger by its hand, and by its joint where several
    are recorded; other end-effectors with the letter of their side spelt out.
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
        elif sided := _sided(link):
            names[link.ee] = sided
    return {name: told for name, told in names.items() if told}


def _finger(link: ObservedLink) -> str:
    """Which finger of which hand an end-effector is; empty if it is none, or of no known side."""
    finger = FINGERS.get(link.kind.rstrip("0123456789"), "")
    known = finger and link.side in ("left", "right")
    whose = f"{link.agent} ".replace("_", " ") if link.agent else ""
    return f"{whose}{link.side} {finger}" if known else ""


def limb_names(observation: Observation) -> dict[str, str]:
    """What bodies are called in prose, and of a hand of several end-effectors each by the hand."""
    names = body_names(observation)
    hands = {link.ee: hand for link in observation.links if (hand := _hand(link))}
    count = Counter(hands.values())
    return names | {ee: hand for ee, hand in hands.items() if count[hand] > 1}


def _hand(link: ObservedLink) -> str:
    """Which hand an end-effector is or is a finger of; empty if of none, or of no known side."""
    is_hand = link.kind == "hand" or link.kind.rstrip("0123456789") in FINGERS
    whose = f"{link.agent} ".replace("_", " ") if link.agent else ""
    return f"{whose}{link.side} hand" if is_hand and link.side in SIDES.values() else ""


def _sided(link: ObservedLink) -> str:
    """An end-effector's name with its side spelt out; empty if no letter stands for the side."""
    letter, _, rest = link.ee.partition("_")
    if not rest or SIDES.get(letter) != link.side:
        return ""
    rest, kind = rest.replace("_", " "), link.kind.replace("_", " ")
    return f"{link.side} {rest}" if kind in rest else f"{rest} of the {link.side} {kind}"


def is_plural(words: str) -> bool:
    """Whether a name is of several, by its ending: crackers and scissors are, a glass is not."""
    return words.endswith("s") and not words.endswith(("ss", "us", "is"))


def _joint(kind: str) -> str:
    number = kind[len(kind.rstrip("0123456789")) :]
    return ORDINALS[int(number) - 1] if number in ("1", "2", "3", "4") else number or "first"
