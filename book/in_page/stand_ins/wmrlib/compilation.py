"""Stands in for wmrlib.compilation in the page's Python: nothing is compiled."""


def compiled(function):
    return function


formula = compiled


def elementary(function):
    return compiled
