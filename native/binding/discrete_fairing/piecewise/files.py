# SPDX-License-Identifier: GPL-3.0-or-later
"""Saves records of arrays, one array a field, without pickles: .npz files or Zarr groups."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import fields
from os import PathLike
from typing import Any, Self

import numpy as np

from ..errors import fairing_error
from ..whole_files import whole_file


class Record:
    """A dataclass of NumPy arrays and JSON values, or dicts of these."""

    def save(self, path: str | PathLike) -> None:
        """Writes a file (.npz) that is complete or absent: one process may write while others read.

        For a name that ends in .zarr it writes a Zarr group with compressed arrays, in a folder or at any
        address of fsspec, such as s3://…; the group cannot be read before it is complete. Raises OSError.
        """
        arrays: dict[str, np.ndarray] = {}
        plain: dict[str, Any] = {"record": type(self).__name__}
        for field in fields(self):  # type: ignore[arg-type]
            plain[field.name] = _taken(getattr(self, field.name), field.name, arrays)
        if is_group(path):
            return _write_group(str(path), arrays, json.dumps(plain))
        with whole_file(path, suffix=".npz") as place, place.open("wb") as out:
            np.savez(out, **arrays, json=np.array(json.dumps(plain)))

    @classmethod
    def load(cls, path: str | PathLike) -> Self:
        """Reads a file of save(). Raises OSError, and FairingError BAD_OPTION for other files."""
        wrong = fairing_error(
            "BAD_OPTION", f"{path} does not hold a {cls.__name__} of discrete_fairing."
        )
        try:
            with _opened(path) as stored:
                plain = json.loads(str(stored["json"]))
                if plain.pop("record") != cls.__name__:
                    raise wrong
                return cls(**{name: _put_back(value, stored) for name, value in plain.items()})
        except (KeyError, ValueError, TypeError, AttributeError, EOFError) as error:
            raise wrong from error


def is_group(path: str | PathLike) -> bool:
    return str(path).rstrip("/").endswith(".zarr")


def _zarr() -> Any:
    try:
        import zarr
    except ImportError as error:
        raise ImportError(
            f'Files of the kind .zarr need the package zarr: pip install "discrete-fairing[cluster]" '
            f"({error})"
        ) from error
    return zarr


def _write_group(name: str, arrays: dict[str, np.ndarray], text: str) -> None:
    """Writes the arrays, then the text, without which a group is no complete record."""
    group = _zarr().open_group(name, mode="w")
    for key, array in arrays.items():
        group.create_array(key, data=array)
    group.attrs["json"] = text


@contextmanager
def _opened(path: str | PathLike) -> Iterator[Mapping[str, Any]]:
    """The arrays of a record by name, and its text as "json"."""
    if not is_group(path):
        with np.load(path, allow_pickle=False) as stored:
            yield stored
        return
    group = _zarr().open_group(str(path), mode="r")
    yield _Group(group)


class _Group(dict):
    """A mapping that reads each array on access."""

    def __init__(self, group: Any) -> None:
        super().__init__(json=group.attrs["json"])
        self._group = group

    def __missing__(self, name: str) -> np.ndarray:
        return self._group[name][...]


def _taken(value: Any, name: str, arrays: dict[str, np.ndarray]) -> Any:
    if isinstance(value, np.ndarray):
        arrays[name] = value
        return {"array": name}
    if isinstance(value, dict):
        return {"dict": {key: _taken(v, f"{name}.{key}", arrays) for key, v in value.items()}}
    return {"value": value}


def _put_back(value: dict[str, Any], stored: Any) -> Any:
    if "array" in value:
        return stored[value["array"]]
    if "dict" in value:
        return {key: _put_back(v, stored) for key, v in value["dict"].items()}
    return value["value"]
