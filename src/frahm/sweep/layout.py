"""How a store lies on disk: arrays in chunks with checksums, and a head that says what they are.

Every chunk of every array is written, blank ones too, and ends with its CRC32C: one that is lost or changed can be told
from one that holds nothing. The head, `zarr.json` of the group, holds a hash of itself.
"""

from __future__ import annotations

import functools
import hashlib
import json
import math
import warnings
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from frahm import __version__
from frahm.case import field_table
from frahm.errors import ParameterError
from frahm.files import patiently, write_text
from frahm.sweep.reasons import Reasons
from frahm.sweep.study import Axes, Study
from frahm.sweep.variables import ROOTS, STATUS_CODES, Variable, variables_of

SCHEMA = "frahm-sweep-2"
ALLOWED = "a folder that `frahm sweep` wrote"
HEAD = "zarr.json"
_ANY_SCHEMA = "frahm-sweep-"
_CHUNK = 16_384  # points
_STATUS = Variable("status", "what became of the point", codes=STATUS_CODES, dtype="i1")
_REASON = Variable(
    "reason", "why the point failed or is unverified", codes="0 none, others: see the attribute reasons", dtype="i4"
)
_SEED = Variable("seed", "seed of the initial states sampled at this point", dtype="i8")
_HASH = "checksum"
_OWN = ("title", "schema", "study", "study_digest", "frahm_version", "reasons")


def is_sweep(folder: str | Path) -> bool:
    """Whether a folder holds the store of a sweep, in whatever state it is."""
    try:
        return str(_document(Path(folder))["attributes"]["schema"]).startswith(_ANY_SCHEMA)
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return False


def head_of(folder: Path) -> dict[str, Any]:
    """The head of a store as it was written.

    Raises
    ------
    ParameterError
        If the folder does not hold a sweep, one of another form, or one whose head is damaged.
    """
    if not is_sweep(folder):
        raise ParameterError("store", str(folder), ALLOWED)
    head = _document(folder)
    schema = head["attributes"]["schema"]
    if schema != SCHEMA and head["attributes"].get(_HASH) != _hash(head):
        hint = f"It is of the form {schema}; this version of frahm writes and reads {SCHEMA}."
        raise ParameterError("store", str(folder), ALLOWED, hint=hint)
    if head["attributes"].get(_HASH) != _hash(head):
        hint = f"Its {HEAD} is damaged: what the numbers belong to is not known. Begin anew with --force (force=True)."
        raise ParameterError("store", str(folder), ALLOWED, hint=hint)
    return head


def attributes_of(folder: Path) -> dict[str, Any]:
    """What is said of the store as a whole."""
    return dict(head_of(folder)["attributes"])


def write_reasons(folder: Path, text: str) -> None:
    """Put another table of reasons into the head."""
    head = head_of(folder)
    head["attributes"]["reasons"] = text
    _write_head(folder, head)


def wrong_descriptions(folder: Path, head: dict[str, Any]) -> dict[str, str]:
    """Arrays whose own description is not that of the head, with what it should be."""
    texts = {name: json.dumps(facts, indent=2) for name, facts in head["consolidated_metadata"]["metadata"].items()}
    return {name: text for name, text in texts.items() if _text(folder / name / HEAD) != text}


def lay_out(path: Path, study: Study) -> None:
    """Make a new store of a study at a path where nothing is."""
    import zarr

    attributes = {
        "title": study.title or study.name,
        "schema": SCHEMA,
        "study": study.text,
        "study_digest": study.digest,
        "frahm_version": __version__,
        "reasons": Reasons().text,
    }
    group = zarr.create_group(path, zarr_format=3, attributes=attributes)
    facts = field_table(Axes)
    for name, values in study.axes_given.items():
        more: dict[str, Any] = {"long_name": facts[name].title.lower(), "units": facts[name].unit or "1"}
        _create(group, name, (len(values),), (len(values),), (name,), dtype="f8", attributes=more)
    for variable in (*variables_of(study), _REASON, _STATUS):
        _add(group, study, variable, fill=variable.blank if variable not in (_REASON, _STATUS) else 0)
    if _has_seeds(study):
        _add(group, study, _SEED, fill=0)
    for name, known in known_values(study):
        write_chunks(group[name], known)
    with warnings.catch_warnings():  # not yet part of the zarr 3 specification, and what xarray wants for a quick look
        warnings.filterwarnings("ignore", message="Consolidated metadata")
        zarr.consolidate_metadata(path)
    _write_head(path, _document(path))


def known_values(study: Study) -> Iterator[tuple[str, np.ndarray]]:
    """Arrays that the study itself says, by their names: its axes, and the seeds of the points."""
    for name, values in study.axes_given.items():
        yield name, np.array(values)
    if _has_seeds(study):
        seeds = np.array([study.seed_at(index) for index in range(study.size)], dtype="i8")
        yield _SEED.name, seeds.reshape(study.shape)


def chunk_shape(shape: tuple[int, ...]) -> tuple[int, ...]:
    """Chunks of whole runs of the fastest axes: points that are computed together are stored together."""
    sizes, room = [1] * len(shape), _CHUNK
    for axis in range(len(shape) - 1, -1, -1):
        if shape[axis] > room:
            sizes[axis] = max(1, room)
            break
        sizes[axis] = shape[axis]
        room //= shape[axis]
    return tuple(sizes)


def chunk_counts(shape: tuple[int, ...]) -> tuple[int, ...]:
    """Number of chunks along every axis."""
    return tuple(-(-n // c) for n, c in zip(shape, chunk_shape(shape), strict=True))


def chunk_part(array: Any, chunk: int) -> tuple[slice, ...]:
    """Part of an array that one of its chunks holds, by the number of the chunk."""
    places = np.unravel_index(chunk, array.cdata_shape)
    return tuple(slice(int(i) * c, (int(i) + 1) * c) for i, c in zip(places, array.chunks, strict=True))


def chunk_is_there(folder: Path, array: Any, chunk: int) -> bool:
    """Whether the file of a chunk is."""
    places = tuple(int(place) for place in np.unravel_index(chunk, array.cdata_shape))
    return bool((folder / array.path / array.metadata.encode_chunk_key(places)).is_file())


def write_chunks(array: Any, values: np.ndarray, chunks: Iterable[int] | None = None) -> None:
    """Write chunks of an array, all of them if they are not named; each is replaced in one step, blank ones too."""
    import zarr

    whole = values.reshape(array.shape)
    config: Any = {"order": "C", "write_empty_chunks": True}
    again = zarr.AsyncArray(metadata=array.metadata, store_path=array.store_path, config=config)
    written: Any = zarr.Array(again)
    for chunk in range(math.prod(array.cdata_shape)) if chunks is None else chunks:
        part = chunk_part(array, chunk)
        patiently(functools.partial(written.__setitem__, part, whole[part]))


def _has_seeds(study: Study) -> bool:
    return "attractors" in study.asked or "fatigue" in study.asked


def _add(group: Any, study: Study, variable: Variable, fill: float) -> None:
    attributes: dict[str, Any] = variable.attributes if variable not in (_STATUS, _SEED) else _plain(variable)
    more = ((ROOTS,), (ROOTS,), ("root",)) if variable.roots else ((), (), ())
    shape, chunks = (*study.shape, *more[0]), (*chunk_shape(study.shape), *more[1])
    names = (*study.axes_given, *more[2])
    _create(group, variable.name, shape, chunks, names, dtype=variable.dtype, fill_value=fill, attributes=attributes)


def _create(
    group: Any, name: str, shape: tuple[int, ...], chunks: tuple[int, ...], dims: tuple[str, ...], **more: Any
) -> None:
    from zarr.codecs import Crc32cCodec, ZstdCodec

    packed = (ZstdCodec(level=0), Crc32cCodec())
    group.create_array(name, shape=shape, chunks=chunks, dimension_names=dims, compressors=packed, **more)


def _plain(variable: Variable) -> dict[str, Any]:
    """Attributes of a variable that is known at every point."""
    return {key: text for key, text in variable.attributes.items() if key != "missing"}


def _document(folder: Path) -> dict[str, Any]:
    return dict(json.loads((folder / HEAD).read_text(encoding="utf-8")))


def _write_head(folder: Path, head: dict[str, Any]) -> None:
    head["attributes"][_HASH] = _hash(head)
    write_text(folder / HEAD, json.dumps(head, indent=2))


def _hash(head: dict[str, Any]) -> str:
    """Hash of what frahm wrote into a head; attributes that somebody added are theirs."""
    own = {key: head["attributes"].get(key) for key in _OWN}
    text = json.dumps([own, head.get("consolidated_metadata")], sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def _text(file: Path) -> str | None:
    try:
        return file.read_text(encoding="utf-8")
    except (FileNotFoundError, NotADirectoryError, UnicodeDecodeError):
        return None
