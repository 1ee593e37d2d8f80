"""Reads form factors as others would, and prints every number of the table so that no bit is lost.
Usage: factor_matrices.py F.csv F.mtx"""
import csv
import sys

import numpy


def read_table(name):
    with open(name, newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(line for line in file if not line.startswith("#"))
    return head, [row[0] for row in rows], numpy.array([[float(x) for x in row[1:]] for row in rows])


head, names, table = read_table(sys.argv[1])
assert head == ["surface", "area", *names, "space", "row_sum", "error"], head
head, others, beside = read_table(sys.argv[2].replace(".mtx", ".names.csv"))
places = [f"{what}_{axis}" for what in ("centre", "normal", "extent") for axis in "xyz"]
assert head == ["surface", "area", "space", "row_sum", "error", "left_out", *places], head
assert others == names, others
assert (beside[:, :4] == table[:, [0, -3, -2, -1]]).all(), "the two tables differ"

try:
    import scipy.io

    matrix = numpy.asarray(scipy.io.mmread(sys.argv[2]).todense())
    reader = "scipy"
except ImportError:
    entries = numpy.loadtxt(sys.argv[2], comments="%", ndmin=2)
    size = entries[0].astype(int)
    matrix = numpy.zeros(size[:2])
    assert len(entries) == size[2] + 1
    matrix[entries[1:, 0].astype(int) - 1, entries[1:, 1].astype(int) - 1] = entries[1:, 2]
    reader = "numpy"
assert (matrix == table[:, 1:-3]).all(), "table and matrix differ"
for row in table:
    print(" ".join(value.hex() for value in row.tolist()))
print("read by", reader, file=sys.stderr)
