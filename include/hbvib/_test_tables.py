"""Columns of measured numbers from MATLAB, NumPy and CSV files, and deviations from coherence."""
from __future__ import annotations

import csv
import os
from typing import TYPE_CHECKING, Any, Union

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._results import ComplexArray, FloatArray


def read_columns(path: Any) -> dict[str, Union[FloatArray, ComplexArray]]:
    """Reads the vectors of numbers of a file by their names, as float or complex: MATLAB .mat (save -v7 or -v6), NumPy .npz, or CSV
    with names in its first line, in which lines that begin with # are left out. Tables, texts and structures of .mat are left out.

    >>> import hbvib, hbvib.io
    >>> import os, tempfile
    >>> path = os.path.join(tempfile.mkdtemp(), "test.csv")
    >>> with open(path, "w") as file:
    ...     print("hz, re\\n10, 1\\n11, -2", file=file)
    ...
    >>> hbvib.io.read_columns(path)["re"]
    array([ 1., -2.])
    """
    name = os.fspath(path)
    lower = str(name).lower()
    found: dict[str, Any] = {}
    if lower.endswith(".mat"):
        from scipy.io import loadmat  # type: ignore[import-untyped, unused-ignore]

        try:
            found = loadmat(name)
        except NotImplementedError:
            raise ValueError(f"{name}: a file of save -v7.3; save it with -v7") from None
    elif lower.endswith(".npz"):
        with np.load(name) as file:
            found = dict(file)
    else:
        # Spreadsheets begin a file with a mark of its encoding, and quote words.
        with open(name, encoding="utf-8-sig") as text:
            lines = list(csv.reader((line for line in text if line.strip() and not line.startswith("#")), skipinitialspace=True))
        if not lines:
            raise ValueError(f"{name}: holds no columns")
        names = [word.strip() for word in lines[0]]
        try:
            rows = np.array([[float(word) for word in line] for line in lines[1:]]).reshape(-1, len(names))
        except ValueError as error:
            raise ValueError(f"{name}: {error}; needs {len(names)} numbers in each line after the names") from None
        found = dict(zip(names, rows.T))
    columns: dict[str, Any] = {}
    for key, value in found.items():
        array = np.asarray(value)
        if array.dtype.kind in "fciub" and array.ndim <= 2 and array.size == max(array.shape, default=0):
            columns[key] = array.ravel().astype(complex if array.dtype.kind == "c" else float)
    return columns


def coherence_sigma(values: ArrayLike, coherence: ArrayLike, averages: float) -> FloatArray:
    """Standard deviations of |H| of a frequency response, as Measured takes them, from its coherence g^2 and the number of averages n:
    |H| ((1 - g^2) / (g^2 n))^1/2, the random error of an estimate with noise in the response (Bendat & Piersol 2010, Random Data,
    doi:10.1002/9781118032428, section 9.2).

    averages   independent ones; segments under Hann windows that overlap by half count 0.95 each.

    >>> import hbvib, hbvib.io
    >>> hbvib.io.coherence_sigma([2j], [0.8], 25)
    array([0.2])
    """
    size, squared = np.abs(np.asarray(values)), np.asarray(coherence, float)
    if not np.all((squared > 0) & (squared <= 1)):
        raise ValueError("coherence has numbers outside 0 .. 1, needs g^2 of each value, above 0")
    if not averages > 1:
        raise ValueError(f"averages = {averages}, needs a number > 1: of one average the coherence is 1 always")
    if np.any(squared == 1):
        raise ValueError("coherence is 1 at a value, whose deviation would be 0; give sigma there")
    return np.asarray(size * np.sqrt((1 - squared) / (squared * averages)))
