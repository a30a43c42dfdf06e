"""Random numbers for the page's Python."""

import random

import numpy


class Generator:
    """Not numpy's random numbers, but the same ones each time."""

    def __init__(self, seed=None):
        self._random = random.Random(seed)

    def _drawn(self, draw, size, *bounds):
        if size is None:
            return numpy.elementwise(draw)(*bounds) if bounds else draw()
        empty = numpy.full(size, 0)
        return numpy.elementwise(lambda _, *each: draw(*each))(empty, *bounds)

    def uniform(self, low=0.0, high=1.0, size=None):
        return self._drawn(self._random.uniform, size, low, high)

    def random(self, size=None):
        return self.uniform(size=size)

    def normal(self, loc=0.0, scale=1.0, size=None):
        return self._drawn(self._random.gauss, size, loc, scale)

    def standard_normal(self, size=None):
        return self.normal(size=size)

    def integers(self, low, high=None, size=None):
        low, high = (0, low) if high is None else (low, high)
        return self._drawn(self._random.randrange, size, low, high)

    def choice(self, options, size=None):
        options = numpy.arange(options) if isinstance(options, int) else numpy.asarray(options)
        return options[self.integers(len(options), size=size)]

    def permutation(self, options):
        options = numpy.arange(options) if isinstance(options, int) else numpy.asarray(options)
        return options[self._random.sample(range(len(options)), len(options))]
