"""Methods of others: Python callables, by themselves or by a text that says where they are.

A method is `(recording, start) -> Track`, or `(recording, start, params) -> Track`; one that needs footfalls
alone is given `Footfalls` in place of the recording. What it is given cannot be written to. A dataclass with
such a `__call__` has its fields for parameters.
"""

from __future__ import annotations

import contextlib
import copy
import hashlib
import importlib
import importlib.util
import inspect
import pickle
import re
import sys
import traceback
from collections.abc import Callable, Mapping
from dataclasses import dataclass, is_dataclass, replace
from functools import partial
from importlib.metadata import entry_points
from pathlib import Path
from types import ModuleType
from typing import Any, TypeVar, get_args, get_type_hints

import numpy as np

from footfall.errors import InputError
from footfall.hdr.method import Method, Needs, require_name
from footfall.hdr.sound import article, require_sound
from footfall.hdr.tracks import Reckoning
from footfall.pdr.track import Track
from footfall.settings import did_you_mean

GROUP = "footfall.methods"  # of entry points
FORMS = "package.module:NAME or file.py:NAME"
_SIGNATURES = "(recording, start) or (recording, start, params)"

Held = TypeVar("Held")


def entry_point_names() -> list[str]:
    """Methods that installed packages bring."""
    return sorted({point.name for point in entry_points(group=GROUP)})


def load(use: str) -> Any:
    """The object that `package.module:NAME`, `file.py:NAME` or the name of an entry point means.

    Raises
    ------
    InputError
        No such file, module, name or entry point, or one that raises an exception when it is loaded.
    """
    if ":" not in use:
        values = {point.value for point in entry_points(group=GROUP) if point.name == use}
        if len(values) > 1:
            raise InputError(f"several packages have it: {', '.join(sorted(values))}; say which", use)
        return load(values.pop())
    place, _, name = use.rpartition(":")
    found: Any = _load_file(place) if _is_file(place) else _load_module(place, use)
    for part in name.split("."):
        if not hasattr(found, part):
            public = (
                [one for one in vars(found) if not one.startswith("_")] if hasattr(found, "__dict__") else []
            )
            raise InputError(f"there is no {part!r} in it{did_you_mean(part, public)}", place)
        found = getattr(found, part)
    return found


def ready(use: str) -> None:
    """Load the file that a method comes from, so that what it defines can be unpickled."""
    place = use.rpartition(":")[0]
    if _is_file(place):
        _load_file(place)


def _is_file(place: str) -> bool:
    return place.endswith(".py") or "/" in place or "\\" in place


def _load_file(place: str) -> ModuleType:
    """A file as a module of a name of its own; once, unless its content changes."""
    file = Path(place)
    if file.suffix != ".py":
        raise InputError("expected a file of Python, file.py:NAME", place)
    try:
        content = file.read_bytes()
    except OSError as error:
        raise InputError(f"cannot be read ({error.strerror})", place) from None
    digest = hashlib.sha256(str(file.resolve()).encode() + b"\0" + content).hexdigest()[:12]
    name = f"_footfall_{re.sub(r'[^0-9a-zA-Z_]', '_', file.stem)}_{digest}"
    if name in sys.modules:
        return sys.modules[name]
    _importable(file.resolve().parent)  # what lies beside it
    spec = importlib.util.spec_from_file_location(name, file.resolve())
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    try:
        # Not by the loader: it takes compiled code that is as old and as long as the file for the file's.
        exec(compile(content, str(file.resolve()), "exec"), module.__dict__)
    except (Exception, SystemExit) as error:
        del sys.modules[name]
        raise InputError(f"cannot be loaded: {_told(error, str(file.resolve()))}", place) from error
    return module


def _load_module(place: str, use: str) -> ModuleType:
    if not all(part.isidentifier() for part in place.split(".")):
        raise InputError(f"expected {FORMS}", use)
    try:
        try:
            return importlib.import_module(place)
        except ModuleNotFoundError as error:
            if error.name != place.partition(".")[0]:
                raise
            _importable(Path.cwd())
            return importlib.import_module(place)
    except ModuleNotFoundError as error:
        if error.name is not None and f"{place}.".startswith(f"{error.name}."):
            raise InputError(f"there is no module {error.name!r}", use) from None
        raise InputError(f"cannot be imported: {_told(error)}", use) from error
    except (Exception, SystemExit) as error:
        raise InputError(f"cannot be imported: {_told(error)}", use) from error


def _importable(folder: Path) -> None:
    """At the end of the path, where it hides nothing; and for good: worker processes take the path over."""
    if str(folder) not in sys.path:
        sys.path.append(str(folder))
        importlib.invalidate_caches()


def _told(error: BaseException, file: str = "") -> str:
    """Type, message and place of an exception; the place in `file` where it passed there."""
    frames = [one for one in traceback.extract_tb(error.__traceback__) if "importlib" not in one.filename]
    own = [frame for frame in frames if frame.filename == file] or frames
    at = (own[-1].filename, own[-1].lineno) if own else None
    message = str(error)
    if isinstance(error, SyntaxError) and error.filename:
        at, message = (error.filename, error.lineno), error.msg
    first = (message.strip().splitlines() or [""])[0]
    place = f" ({Path(at[0]).name}, line {at[1]})" if at else ""
    return f"{type(error).__name__}{': ' + first if first else ''}{place}"


def adapted(found: Any, *, use: str = "", name: str | None = None, needs: Needs | None = None) -> Method:
    """Anybody's callable as a method.

    Parameters
    ----------
    found : a function, a dataclass with `__call__` or its class, another class that is made without
        arguments, or a `Method`
    use : text that it was found by
    name : of the method; None for its own attribute `name`, or what it is called
    needs : what it is given; None for its own attribute `needs`, or samples

    Raises
    ------
    InputError
        Not callable, or not with what a method is given.
    """
    if isinstance(found, Method):
        made = replace(found, use=use or found.use, version=found.version or content_version(found.run))
        return made if name is None else made.renamed(name)
    culprit = use or _called(found)
    if isinstance(found, type):
        try:
            found = found()
        except Exception as error:
            raise InputError(f"cannot be made without arguments: {_told(error)}", culprit) from None
    if not callable(found):
        raise InputError(f"is {article(type(found).__name__)}, expected a callable {_SIGNATURES}", culprit)
    wants: Any = needs or getattr(found, "needs", "samples")
    if wants not in get_args(Needs):
        raise InputError(f'needs = {wants!r}, expected "footfalls" or "samples"', culprit)
    own = is_dataclass(found)
    takes, default = _third(found, culprit)
    if own and takes:
        raise InputError(f"has its fields for parameters, expected __call__{_SIGNATURES[:18]}", culprit)
    own_name = getattr(found, "name", None)
    told = require_name(name) if name is not None else _as_name(own_name, use, found)
    return Method(
        name=told,
        description=(inspect.getdoc(found) or culprit).partition("\n")[0],
        run=Foreign(culprit, None if own else found, takes, wants, _file_of(found)),
        params=found if own else default,
        needs=wants,
        version=_version(found),
        use=use,
    )


@dataclass(frozen=True)
class Foreign:
    """Calls a method of others, and refuses what it must not do.

    Attributes
    ----------
    culprit : what it is called in messages
    call : the callable; None where the params are what is called
    takes_params : whether it is given them as well
    needs : what it is given first
    file : that it is defined in, for messages
    judged : whether the track is judged here (`footfall.hdr.check` does it by itself)
    """

    culprit: str
    call: Callable[..., Any] | None
    takes_params: bool
    needs: Needs
    file: str
    judged: bool = True

    def __call__(self, reckoning: Reckoning, params: Any) -> Track:
        """The track.

        Raises
        ------
        InputError
            An exception in the method, which is the cause; or a track that cannot be.
        """
        given = guarded(reckoning.footfalls if self.needs == "footfalls" else reckoning.recording)
        call = params if self.call is None else self.call
        extra = (params,) if self.takes_params else ()
        try:
            # Standard output is for results.
            with contextlib.redirect_stdout(sys.stderr):
                made = call(given, reckoning.start, *extra)
        except InputError:
            raise
        except Exception as error:
            raise InputError(_told(error, self.file), self.culprit) from error
        if self.judged:
            require_sound(made, given.t, self.culprit)
        return made


def guarded(value: Held) -> Held:
    """The same dataclass with arrays that cannot be written to, and mappings of its own."""
    held = copy.copy(value)
    for name, part in vars(value).items():
        if isinstance(part, np.ndarray):
            view = part.view()
            view.flags.writeable = False
            object.__setattr__(held, name, view)
        elif isinstance(part, Mapping):
            object.__setattr__(held, name, copy.deepcopy(dict(part)))
    return held


def content_version(found: Any) -> str:
    """Hash (16 hex digits) of what a method is: the file that defines it and what else it holds."""
    digest = hashlib.sha256()
    file = _file_of(found)
    inner = found.func if isinstance(found, partial) else found
    if file and Path(file).is_file():
        digest.update(Path(file).read_bytes())
    elif hasattr(inner, "__code__"):  # typed in, in a session
        digest.update(inner.__code__.co_code + repr(inner.__code__.co_consts).encode())
    named = inner if hasattr(inner, "__qualname__") else type(inner)
    digest.update(named.__qualname__.encode())
    cells = getattr(inner, "__closure__", None) or ()
    held: list[Any] = [cell.cell_contents for cell in cells]
    if not is_dataclass(found) and not inspect.isfunction(found):
        held.append(found)
    for one in held:
        with contextlib.suppress(Exception):  # what cannot be pickled cannot be told apart
            digest.update(pickle.dumps(one))
    return digest.hexdigest()[:16]


def _version(found: Any) -> str:
    told = getattr(found, "version", "")
    return told if isinstance(told, str) and told else content_version(found)


def _file_of(found: Any) -> str:
    while isinstance(found, partial):
        found = found.func
    place = found if inspect.isroutine(found) else type(found)
    try:
        return inspect.getsourcefile(place) or ""
    except TypeError:
        return ""


def _third(call: Callable[..., Any], culprit: str) -> tuple[bool, Any]:
    """Whether a callable takes parameters as its third argument, and their defaults."""
    try:
        signature = inspect.signature(call)
    except (TypeError, ValueError):  # compiled
        return False, None
    ways = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
    places = [one for one in signature.parameters.values() if one.kind in ways]
    third = places[2] if len(places) > 2 else None
    wanted = third is not None and (
        third.default is third.empty or third.name == "params" or is_dataclass(third.default)
    )
    try:
        signature.bind(*range(3 if wanted else 2))
    except TypeError:
        raise InputError(f"takes {signature}, expected {_SIGNATURES}", culprit) from None
    if third is None or not wanted:
        return False, None
    if is_dataclass(third.default) or isinstance(third.default, Mapping):
        return True, third.default
    hint: Any = None
    with contextlib.suppress(Exception):
        hint = get_type_hints(call if inspect.isroutine(call) else type(call).__call__).get(third.name)
    if isinstance(hint, type) and is_dataclass(hint):
        try:
            return True, hint()
        except TypeError as error:
            raise InputError(f"its params {hint.__name__} lack defaults ({error})", culprit) from None
    return True, {}


def _called(found: Any) -> str:
    return getattr(found, "__qualname__", None) or type(found).__qualname__


def _as_name(own: Any, use: str, found: Any) -> str:
    """What a method calls itself, or else its text's last part, or the callable's name."""
    text = own if isinstance(own, str) and own else use.rpartition(":")[2] or _called(found)
    return require_name(re.sub(r"[^0-9A-Za-z_-]+", "-", text.rpartition(".")[2]).strip("-") or "method")
