# SPDX-License-Identifier: GPL-3.0-or-later
"""Records of arrays as files: .npz, one array a field, without pickles."""

from __future__ import annotations

import json
from dataclasses import fields
from pathlib import Path
from typing import Any, Self

import numpy as np

from ..errors import fairing_error
from ..whole_files import whole_file


class Record:
    """A dataclass of NumPy arrays and of what JSON can hold, dicts of both among them."""

    def save(self, path: str | Path) -> None:
        """Writes a file (.npz) that is whole or not there: one process may write while others read.

        Raises OSError.
        """
        arrays: dict[str, np.ndarray] = {}
        plain: dict[str, Any] = {"record": type(self).__name__}
        for field in fields(self):  # type: ignore[arg-type]
            plain[field.name] = _taken(getattr(self, field.name), field.name, arrays)
        with whole_file(path, suffix=".npz") as place, place.open("wb") as out:
            np.savez(out, **arrays, json=np.array(json.dumps(plain)))

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Reads what save() has written. Raises OSError, and FairingError BAD_OPTION for other files."""
        wrong = fairing_error("BAD_OPTION", f"{path} holds no {cls.__name__} of discrete_fairing.")
        try:
            with np.load(path, allow_pickle=False) as stored:
                plain = json.loads(str(stored["json"]))
                if plain.pop("record") != cls.__name__:
                    raise wrong
                return cls(**{name: _put_back(value, stored) for name, value in plain.items()})
        except (KeyError, ValueError, TypeError, AttributeError, EOFError) as error:
            raise wrong from error


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
