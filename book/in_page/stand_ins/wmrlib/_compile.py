"""Stands in for wmrlib._compile in the page's Python: nothing is compiled, one number at a time."""


def compiled(function, **options):
    return function


formula = compiled


def elementwise(one, outputs, *arguments, options=()):
    for value in arguments:
        if not isinstance(value, float):
            raise ModuleNotFoundError("Arrays need numpy: open the notebook for them")
    results = one(*arguments, *options)
    return results if outputs > 1 else (results,)
