"""Random choices that are the same on every machine."""

import random


class Draws:
    """Choices that follow from the given words alone.

    Python promises the same sequence of random() for the same text, for all
    versions; its other functions of random may change, so none is used.
    """

    def __init__(self, *words):
        self.random = random.Random(" ".join(map(str, words))).random

    def below(self, count):
        return int(self.random() * count)

    def between(self, least, most):
        """An integer, both bounds included."""
        return least + self.below(most - least + 1)

    def choose(self, choices):
        return choices[self.below(len(choices))]

    def chance(self, probability):
        return self.random() < probability

    def weighted(self, weights):
        """A key of the dictionary, as often as its value says."""
        left = self.random() * sum(weights.values())
        for key, weight in weights.items():
            left -= weight
            if left < 0:
                return key
        return key
