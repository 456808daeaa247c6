"""Replaces pybind11's list of signatures by one sentence about the argument that has a wrong type."""

import ast
import functools
import inspect
import numbers
import os

from . import _prostm

# types in signatures: their names in messages, and the Python types that they accept
_PLAIN = {
    "float": ("a number", numbers.Real),
    "int": ("a whole number", numbers.Integral),
    "bool": ("True or False", bool),
    "str": ("a string", str),
    "os.PathLike": ("the name of a file", (str, os.PathLike)),
    "object": ("anything", object),
}


def _parts(kind):
    """Returns the name of a type in a signature, and the types in its brackets."""
    if not isinstance(kind, ast.Subscript):
        return ast.unparse(kind), []
    inner = kind.slice.elts if isinstance(kind.slice, ast.Tuple) else [kind.slice]
    return ast.unparse(kind.value), inner


def _takes(kind, value):
    """Returns whether a parameter of this type accepts the value."""
    name, inner = _parts(kind)
    if name == "Optional":
        return value is None or _takes(inner[0], value)
    if name == "Union":
        return any(_takes(one, value) for one in inner)
    if name == "List":
        return isinstance(value, (list, tuple)) and all(_takes(inner[0], item) for item in value)
    if name in _PLAIN:
        return isinstance(value, _PLAIN[name][1])
    return isinstance(value, getattr(_prostm, name.removeprefix("prostm.")))


def _words(kind):
    """Returns the name of a signature's type in messages."""
    name, inner = _parts(kind)
    if name == "Optional":
        return _words(inner[0]) + " or None"
    if name == "Union":
        return " or ".join(map(_words, inner))
    if name == "List":
        return "a list of " + _words(inner[0]).split(" ", 1)[1]
    if name in _PLAIN:
        return _PLAIN[name][0]
    own = name.removeprefix("prostm.")
    return ("an " if own[0] in "AEIOU" else "a ") + own


def _signature(call):
    """Returns the signature in the first line of a compiled function's docstring, and the type of each parameter."""
    given = ast.parse(f"def {call.__doc__.splitlines()[0]}: ...").body[0].args
    places = [(inspect.Parameter.POSITIONAL_OR_KEYWORD, given.args, given.defaults),
              (inspect.Parameter.KEYWORD_ONLY, given.kwonlyargs, given.kw_defaults)]
    parameters, kinds = [], {}
    for place, arguments, defaults in places:
        defaults = [None] * (len(arguments) - len(defaults)) + list(defaults)
        for argument, default in zip(arguments, defaults):
            usual = inspect.Parameter.empty if default is None else ast.literal_eval(default)
            parameters.append(inspect.Parameter(argument.arg, place, default=usual))
            kinds[argument.arg] = argument.annotation
    if given.kwarg is not None:
        parameters.append(inspect.Parameter(given.kwarg.arg, inspect.Parameter.VAR_KEYWORD))
    return inspect.Signature(parameters), kinds


def wrong_type(label, name, words, value):
    """Returns the error for a value of a wrong type."""
    return TypeError(f"{label}: {name} must be {words}, not {_prostm._described(value)}")


def _wrong_argument(label, name, kind, value):
    """Returns the error for an argument that its parameter does not accept."""
    base, inner = _parts(kind)
    if base == "Optional" and isinstance(value, (list, tuple)):
        base, inner = _parts(inner[0])
    if base == "List" and isinstance(value, (list, tuple)):
        place, item = next((i, item) for i, item in enumerate(value) if not _takes(inner[0], item))
        return wrong_type(label, f"{name}[{place}]", _words(inner[0]), item)
    error = wrong_type(label, name, _words(kind), value)
    own = getattr(value, name, None)
    return TypeError(f"{error}; give its .{name}") if own is not None and _takes(kind, own) else error


def _error(label, call, args, kwargs):
    """Returns the error that explains why a compiled function refused its arguments."""
    signature, kinds = _signature(call)
    try:
        given = signature.bind(*args, **kwargs).arguments
    except TypeError as error:
        return TypeError(f"{label}: {error}")
    typed = {name: value for name, value in given.items() if name in kinds}
    for name, value in typed.items():
        usual = signature.parameters[name].default is None and value is None
        if usual or _takes(kinds[name], value):
            continue
        return _wrong_argument(label, name, kinds[name], value)
    for name, value in typed.items():
        if ast.unparse(kinds[name]) == "int" and not 0 <= value < 2**31:
            return ValueError(f"{label}: {name} = {value} is out of range")
    return TypeError(f"{label}: an argument is of a wrong type; see help()")


def _explained(call, label):
    """Returns the function with errors in words."""
    @functools.wraps(call)
    def explained(*args, **kwargs):
        try:
            return call(*args, **kwargs)
        except TypeError as error:
            if ": incompatible " not in str(error).splitlines()[0]:
                raise
        raise _error(label, call, args, kwargs)

    explained.__qualname__ = label.removesuffix("()")
    return explained


def explain_wrong_types():
    """Makes every function, method and constructor of the compiled module explain wrong arguments in words."""
    for name, value in list(vars(_prostm).items()):
        if inspect.isbuiltin(value) and not name.startswith("_"):
            setattr(_prostm, name, _explained(value, f"{name}()"))
        if not inspect.isclass(value) or issubclass(value, Exception):
            continue
        for member, call in list(vars(value).items()):
            if member == "__init__":
                setattr(value, member, _explained(call, f"{name}()"))
            elif callable(call) and not member.startswith("_"):
                setattr(value, member, _explained(call, f"{name}.{member}()"))
