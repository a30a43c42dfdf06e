"""Arrays that are made, joined and taken apart."""

import itertools
import math

from numpy._array import asarray, missing, ndarray


def array(value, dtype=None):
    found = asarray(value, dtype)
    return ndarray(list(found.flat), found.shape)


def full(shape, value):
    shape = shape if isinstance(shape, tuple) else (shape,)
    return ndarray([value] * math.prod(shape), shape)


def zeros(shape):
    return full(shape, 0.0)


def ones(shape):
    return full(shape, 1.0)


def arange(start, stop=None, step=1):
    start, stop = (0, start) if stop is None else (start, stop)
    count = max(math.ceil((stop - start) / step), 0)
    start = float(start) if float in map(type, (start, stop, step)) else start
    return ndarray([start + step * k for k in range(count)], (count,))


def linspace(start, stop, num=50):
    step = (stop - start) / max(num - 1, 1)
    flat = [float(start + step * k) for k in range(num)]
    return ndarray([*flat[:-1], float(stop)] if num > 1 else flat, (num,))


def shape(value):
    return asarray(value).shape


def ndim(value):
    return asarray(value).ndim


def ravel(value):
    value = asarray(value)
    return (value if value.in_one_piece() else value.copy()).reshape(-1)


def transpose(value):
    return asarray(value).T


def concatenate(arrays, axis=0):
    parts = [asarray(each) for each in arrays]
    if axis and parts[0].ndim > 2:
        raise missing(f"concatenate of {parts[0].ndim} dimensions")
    if axis:
        return transpose(concatenate([transpose(each) for each in parts]))
    if len({each.shape[1:] for each in parts}) > 1:
        raise ValueError("the arrays differ in more than their first axis")
    flat = [entry for each in parts for entry in each.flat]
    return ndarray(flat, (sum(map(len, parts)), *parts[0].shape[1:]))


def append(value, more):
    return concatenate([ravel(value), ravel(more)])


def insert(value, at, more):
    return concatenate([asarray(value)[:at], ravel(more), asarray(value)[at:]])


def column_stack(arrays):
    columns = [each if each.ndim > 1 else each[:, None] for each in map(asarray, arrays)]
    return concatenate(columns, axis=1)


def repeat(value, counts):
    value = ravel(value)
    pairs = zip(value.flat, (full(value.size, 1) * counts).flat, strict=True)
    return asarray([entry for entry, count in pairs for _ in range(count)])


def diff(value):
    value = asarray(value)
    key = (slice(None),) * (value.ndim - 1)
    return value[(*key, slice(1, None))] - value[(*key, slice(None, -1))]


def cumsum(value):
    return asarray(list(itertools.accumulate(ravel(value).flat)))


def sort(value):
    """Sort along the last axis, what is not a number at the end."""
    value = asarray(value)
    if value.ndim > 1:
        return asarray([sort(row) for row in value])
    return asarray(sorted(value.flat, key=lambda it: (it != it, it)))
