"""Traits that are read from a panel's state, so that each value is kept in one place."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from typing import Any

import traitlets


class RefusedError(traitlets.TraitError, ValueError):
    """A bad value, for whoever catches ValueError, and for traitlets, which puts back the old."""


@contextmanager
def refusing() -> Iterator[None]:
    """Raise what a check in this block raises as a RefusedError."""
    try:
        yield
    except ValueError as error:
        raise RefusedError(str(error)) from None


class Derived(traitlets.TraitType):
    """A trait whose value is read from the state; setting it changes the state.

    Parameters
    ----------
    read : function of the state
    written : function of name, new value and state, returns the entries of the state that change;
        without one the trait is read-only
    says : str, the docstring
    """

    def __init__(
        self,
        read: Callable[[Mapping[str, Any]], Any],
        written: Callable[[str, Any, Mapping[str, Any]], dict[str, Any]] | None = None,
        says: str = "",
    ):
        super().__init__(read_only=written is None, help=says)
        self.read, self.written = read, written

    def get(self, obj: Any, cls: type | None = None) -> Any:
        return self.read(obj.state)

    def set(self, obj: Any, value: Any) -> None:
        with refusing():
            changed = self.written(self.name, value, obj.state)
        with obj.hold_sync():  # one message, or a page would mix old values with new ones
            obj.set_trait("state", {**obj.state, **changed})


class Frozen(dict):
    """A dict that refuses changes; `|` gives a dict, and so does a copy."""

    def _refuse(self, *_, **__) -> None:
        raise TypeError("state is read-only: set the panel's attributes, such as k_rho, instead")

    __setitem__ = __delitem__ = __ior__ = _refuse  # type: ignore[assignment]
    update = pop = popitem = clear = setdefault = _refuse  # type: ignore[assignment]

    def __reduce__(self):
        return dict, ({**self},)


class State(traitlets.TraitType):
    """What the page and Python share, which only the page and a `Derived` change."""

    info_text = "a dict"
    default_value = Frozen()

    def validate(self, obj: Any, value: Any) -> Frozen:
        if not isinstance(value, Mapping):
            self.error(obj, value)
        rows = value.items()
        return Frozen({name: tuple(it) if isinstance(it, list) else it for name, it in rows})

    def __set__(self, obj: Any, value: Any) -> None:
        if obj.state:
            raise traitlets.TraitError(f"state is read-only: set {obj.settable()} instead")
        super().__set__(obj, value)
