"""Networks in HDF5, made and read by h5py, read by vmesh."""
import os

import numpy

import small_files as small
from inputs import check_tree
from report import Absent, Wrong, expect


def h5py_module():
    try:
        import h5py
    except ImportError as error:
        raise Absent(f"h5py is not installed (Debian: python3-h5py): {error}") from None
    return h5py


def make(path):
    """MorphIO's layout: sections of points with diameters, micrometres, and pairs of sections of which the second goes
    on where the first ends."""
    points = numpy.concatenate([small.POINTS[s] for s in small.SEGMENTS]) * 1000
    with h5py_module().File(path, "w") as file:
        file["points"] = numpy.concatenate([points, numpy.full((6, 1), 2000 * small.RADIUS)], 1)
        file["structure"] = numpy.array([[0, 0], [2, 0], [4, 0]])
        file["connectivity"] = numpy.array([[0, 1], [0, 2]])
    return path


def check(table, written, shared_data):
    h5py, vmesh, path = h5py_module(), written.vmesh, written.vmesh.path("tree.h5")
    program = f"h5py {h5py.__version__}"
    try:
        vmesh("info", make(path))
    except Wrong as wrong:
        if "VMESH_WITH_HDF5" not in str(wrong):
            raise
        table.notes.append("SKIPPED .h5: this vmesh is built without HDF5")
        return
    check_tree(table, ".h5", program, vmesh, lambda: make(path), place="um (the format's)")
    for name in ("vasculature1", "vasculature2"):
        file = os.path.join(shared_data, "microvascular_loops", name + ".h5")
        if os.path.exists(file):
            table.check(".h5", "in", f"as {program}: {name}.h5", lambda file=file: shared_network(vmesh, h5py, file))


def shared_network(vmesh, h5py, path):
    """Cleaning merges points that lie in each other; those that arrive (a twentieth is looked at) are within their
    radius of one of the file's."""
    with h5py.File(path) as file:
        theirs = file["points"][:, :3] / 1000
    there = vmesh.tree(path)
    for point, radius in zip(there.points[::20], there.radii[::20]):
        expect(((theirs - point) ** 2).sum(1).min() <= radius**2, f"{point} is far from all of the file's points")
    return len(there.points), len(there.segments), "radius", "um (the format's)"
