"""Answers from another process: a check here asks for what stands there, and gets data.

The class's hand-ins run in one process and are judged in another, which trusts nothing that comes:
JSON, of which only what is listed here is rebuilt. Functions stay where they are and are called
over the line, in both directions, for a check may give an answer a function to call.
"""

from __future__ import annotations

import json
import math
import pickle
from base64 import b64decode, b64encode
from collections.abc import Callable, Iterator, Mapping, Set
from contextlib import suppress
from decimal import Decimal
from fractions import Fraction
from functools import partial
from itertools import islice
from multiprocessing.connection import Client, Connection
from typing import Any

import numpy as np

import wmrlib
from wmrbook.grading._asking import Failed, called
from wmrbook.grading._hints import Hint, name_of, named, own_work, shown

_MOST = 5_000_000  # bytes of a message
_LARGEST = 2**1000
_FIELDS = {"Gains": 4, "GeoPoint": 2, "PolarError": 3, "Pose": 3}  # wmrlib's, imported when needed
_TEXTS = {"Fraction": Fraction, "Decimal": Decimal}
_ORDERS: dict[str, Callable] = {"tuple": tuple, "list": list}


class Foreign:
    """A value of a kind that no check knows: its type's name, its text, and perhaps a number."""

    def __init__(self, text: str, number: float | None) -> None:
        self.text, self.number = text, number

    def __repr__(self) -> str:
        return self.text

    def __float__(self) -> float:
        if self.number is None:
            raise TypeError("no number")
        return self.number


class Line:
    """One end of a line; `names` is what the other end may ask for by name.

    Of the two, that of the hand-in trusts the other, and gets whatever a check gives an answer.
    """

    def __init__(self, link: Connection, names: Mapping[str, Any], trusts: bool = False) -> None:
        self.link, self.names, self.trusts = link, names, trusts
        self.lent: list[Callable] = []

    def value(self, name: str) -> Any:
        """Return what has this name there; raises NameError if nothing has, and Hint."""
        try:
            return self._ask(name=name)
        except Failed as failed:
            raise Hint(f"`{name}` can't be judged: it comes{failed.told}.") from None

    def serve(self) -> None:
        """Answer until the other end has heard enough."""
        with suppress(EOFError, OSError):
            while True:
                self._reply(self._receive())

    def _ask(self, **request: Any) -> Any:
        self._send({"asks": True, **request})
        while "asks" in (reply := self._receive()):
            self._reply(reply)
        if "failed" in reply:
            told, refused, unwritten = reply["failed"]
            raise Failed(str(told), bool(refused), bool(unwritten))
        if "hint" in reply:
            raise Hint(str(reply["hint"]))
        if "value" not in reply:
            raise NameError(f"name '{request.get('name')}' is not defined")
        try:
            return self._rebuilt(reply["value"])
        except Exception as error:  # whatever is sent, it is no fault of the check's
            raise Failed(f" with what can't be read: {type(error).__name__}") from None

    def _reply(self, request: dict) -> None:
        try:
            if "name" in request:
                known = request["name"] in self.names
                reply = {"value": self._plain(self.names[request["name"]])} if known else {}
            elif "allowed" in request:
                own_work(self.lent[request["function"]], *request["allowed"])
                reply = {"value": None}
            else:
                function = self.lent[request["function"]]
                keys = {str(key): self._rebuilt(each) for key, each in request["named"].items()}
                arguments = map(self._rebuilt, request["arguments"])
                answer = called(partial(function, **keys) if keys else function, *arguments)
                reply = {"value": self._plain(answer)}
        except Failed as failed:
            reply = {"failed": [failed.told, failed.refused, failed.unwritten]}
        except Hint as hint:
            reply = {"hint": str(hint)}
        except Exception as error:  # of a value that holds itself, say
            reply = {"failed": [f" with what can't be sent: {named(error)}", False, False]}
        self._send(reply)

    def _send(self, message: dict) -> None:
        self.link.send_bytes(json.dumps(message).encode())

    def _receive(self) -> dict:
        message = json.loads(self.link.recv_bytes(_MOST))
        if not isinstance(message, dict):
            raise ValueError("no message")
        return message

    def _plain(self, value: Any) -> Any:
        """Return it as JSON can say it; what has another kind is named."""
        if isinstance(value, np.generic):
            value = value.item()
        if isinstance(value, np.floating):  # numpy's long double is its own item
            value = float(value)
        if type(value) is int and abs(value) > _LARGEST:
            return {"foreign": ["int", shown(value), math.inf]}
        if value is None or type(value) in (bool, int, float, str):
            return value
        kind = type(value).__name__
        if isinstance(value, complex):
            return {"complex": [value.real, value.imag]}
        if type(value) in _TEXTS.values():
            return {kind: str(value)}
        if kind in _FIELDS and type(value).__module__.startswith("wmrlib."):
            fields = getattr(value, "_fields", ("lat", "lon"))
            return {"named": [kind, *(self._plain(getattr(value, each)) for each in fields)]}
        if isinstance(value, (Set, Mapping)):
            return {"unordered": shown(value)}
        if isinstance(value, Iterator):  # `zip(*poses)`
            value = tuple(islice(value, 100_000))
        if isinstance(value, (tuple, list)) and (self.trusts or type(value) in (tuple, list)):
            order = "list" if isinstance(value, list) else "tuple"
            return {order: [self._plain(each) for each in value]}
        if self.trusts and not hasattr(value, "tolist") and _is_row(value):
            return {"list": [self._plain(each) for each in value]}
        if callable(getattr(value, "tolist", None)):  # an array, a matrix of sympy or mpmath
            ours = isinstance(value, np.ndarray)
            array = np.asarray(value) if ours else np.array(value.tolist(), object)
            if not ours and 1 in array.shape:
                array = array.ravel()  # a column, as `floats` takes it
            kept = array.dtype.str if array.dtype.kind in "biufc" else "O"
            return {"array": [kept, [*array.shape], [self._plain(it) for it in array.ravel()]]}
        if hasattr(value, "free_symbols"):
            from wmrbook.grading._trees import tree

            return {"sympy": tree(value)}
        if callable(value):
            self.lent.append(value)
            return {"function": len(self.lent) - 1, "called": name_of(value)}
        if not self.trusts:
            return {"pickled": b64encode(pickle.dumps(value)).decode()}
        number = None
        with suppress(Exception):
            number = float(value)
        return {"foreign": [kind, shown(value), number]}

    def _rebuilt(self, data: Any) -> Any:
        if not isinstance(data, dict):
            if isinstance(data, list):
                raise ValueError("a list without its kind")
            return data
        if "function" in data:
            return self._function(data["function"], str(data["called"]))
        ((kind, content),) = data.items()
        if kind in _ORDERS:
            return _ORDERS[kind](map(self._rebuilt, content))
        if kind in _TEXTS:
            return _TEXTS[kind](content[:1000])
        if kind == "complex":
            return complex(*content)
        if kind == "pickled" and self.trusts:
            return pickle.loads(b64decode(content))
        if kind == "named":
            name, *fields = content
            fields = [self._rebuilt(each) for each in fields]
            if name == "GeoPoint":
                return wmrlib.GeoPoint(lat=fields[0], lon=fields[1])
            if len(fields) != _FIELDS[name]:
                raise ValueError(name)
            return tuple.__new__(getattr(wmrlib, name), fields)  # unchecked, as it may be there
        if kind == "array":
            dtype, shape, flat = content
            array = np.empty(len(flat), dtype if dtype[-2:-1] in "biufc" else object)
            array[:] = [self._rebuilt(each) for each in flat]
            return array.reshape(shape)
        if kind == "sympy":
            from wmrbook.grading._trees import grown

            return grown(content)
        if kind == "unordered":
            return type("dict", (dict,), {"__repr__": lambda _: str(content)})()
        name, text, number = content
        known = str(name) if str(name).isidentifier() else "object"
        return type(known, (Foreign,), {})(str(text), number)

    def _function(self, place: int, name: str) -> Callable:
        def function(*arguments: Any, **named: Any) -> Any:
            sent = [self._plain(each) for each in arguments]
            names = {key: self._plain(each) for key, each in named.items()}
            return self._ask(function=place, arguments=sent, named=names)

        def expect_own(*allowed: str) -> None:
            self._ask(function=place, allowed=allowed)

        function.__name__ = function.__qualname__ = name
        function.expect_own = expect_own
        return function


def _is_row(value: Any) -> bool:
    """Whether it has a length and an order, as `ordered` of _asking.py wants it."""
    with suppress(Exception):
        return not isinstance(value, (str, bytes, type)) and len(value) == len([*value])
    return False


def serve(path: str, names: Mapping[str, Any]) -> None:
    """Answer what is asked over the line with this path, by what stands in `names`."""
    with Client(path) as link:
        Line(link, names, trusts=True).serve()
