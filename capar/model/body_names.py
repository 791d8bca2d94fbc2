"""What bodies are called in prose, where that is not their name."""

from collections import Counter

from capar.model.observation import Observation


def body_names(observation: Observation) -> dict[str, str]:
    """What bodies are called where that is not their name, by name.

    An object is called by its kind if that has several words and no other object is of it.
    """
    kinds = Counter(each.kind for each in observation.objects)
    names = {}
    for thing in observation.objects:
        alone = "_" in thing.kind and kinds[thing.kind] == 1
        words = (thing.kind if alone else thing.name).replace("_", " ")
        if alone or thing.assumed:
            names[thing.name] = f"assumed {words}" if thing.assumed else words
    return names
