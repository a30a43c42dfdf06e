"""Stands in for wmrlib._compile in the page's Python: nothing is compiled."""


def compiled(function):
    return function


formula = compiled


def elementary(function):
    return compiled
