#!/usr/bin/python3
"""bench/volume/measures.py on cells of which everything is known: volume_measures_test.py FOLDER, that of the project."""
import os
import sys
import unittest
from itertools import permutations

sys.dont_write_bytecode = True
ROOT = os.path.abspath(sys.argv.pop(1))
VENV = os.path.join(ROOT, "build", "volume-venv", "bin", "python")


def can_measure_wedges():
    try:
        import numpy  # noqa: F401
        import vtk
    except ImportError:
        return False
    return hasattr(vtk.vtkMeshQuality, "SetWedgeQualityMeasureToJacobian")


if not can_measure_wedges():
    if os.path.exists(VENV) and os.path.realpath(sys.prefix) != os.path.dirname(os.path.dirname(VENV)):
        os.execv(VENV, [VENV, os.path.abspath(__file__), ROOT, *sys.argv[1:]])
    print("SKIPPED: no VTK here that measures wedges; bench/volume/run installs one", file=sys.stderr)
    sys.exit(77)

sys.path.insert(0, os.path.join(ROOT, "bench", "volume"))
import numpy as np  # noqa: E402
from measures import least_angles_deg, measure  # noqa: E402
from surfaces import TETRAHEDRON, WEDGE, Surface  # noqa: E402

CUBE = np.array([(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)], float)
# Bottom and top are caps.
CUBE_FACES = np.array([(0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4), (1, 3, 5), (3, 7, 5),
                       (3, 2, 7), (2, 6, 7), (2, 0, 6), (0, 4, 6)])
CUBE_PATCHES = np.array([2, 2, 3, 3] + 8 * [1])
TWO_WEDGES = np.array([(0, 1, 2, 4, 5, 6), (1, 3, 2, 5, 7, 6)])


def cube_measured(points, wedges):
    return measure(Surface(CUBE, CUBE_FACES, CUBE_PATCHES, np.ones(8)), points, {WEDGE: np.asarray(wedges)})


class Measures(unittest.TestCase):
    def test_a_regular_tetrahedron(self):
        points = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)], float)
        faces = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
        if np.linalg.det(points[1:] - points[0]) < 0:
            faces = faces[:, ::-1]
        surface = Surface(points, faces, np.ones(4, int), np.ones(4))
        result = measure(surface, points, {TETRAHEDRON: np.array([(0, 1, 2, 3)])})
        self.assertAlmostEqual(result["least_angle_deg"], np.degrees(np.arccos(1 / 3)), places=9)
        self.assertAlmostEqual(result["least_radius_ratio"], 1, places=12)
        self.assertAlmostEqual(result["least_scaled_jacobian"], 1, places=12)
        self.assertAlmostEqual(result["tetrahedra_volume_mm3"], 8 / 3, places=12)
        self.assertLess(result["volume_off"], 1e-12)

    def test_angles_in_any_order_of_corners(self):
        points = np.array([(0, 0, 0), (3, 0, 0), (1, 2, 0), (1, .5, .1)])  # flat: the least angle is at one edge
        least = np.inf
        for a, b in ((0, 1), (1, 2), (2, 0)):  # where the base meets the three sides
            along = points[b] - points[a]
            distance = abs(np.cross(along, points[3, :] * (1, 1, 0) - points[a])[2]) / np.linalg.norm(along)
            least = min(least, np.degrees(np.arctan2(.1, distance)))
        for order in permutations(range(4)):
            self.assertAlmostEqual(least_angles_deg(points, np.array([order]))[0], least, places=9)

    def test_a_cube_of_wedges_in_either_order_of_corners(self):
        for wedges in (TWO_WEDGES, TWO_WEDGES[:, [0, 2, 1, 3, 5, 4]]):
            result = cube_measured(CUBE, wedges)
            self.assertEqual((result["wedges"], result["inverted"]), (2, 0))
            self.assertLess(max(result["volume_off"], result["caps_off"]), 1e-12)
            # At its acute corners 1 / sqrt(2), which VTK divides by that of an equilateral base.
            self.assertAlmostEqual(result["least_scaled_jacobian"], (2 / 3)**.5, places=9)

    def test_an_inverted_cell_is_counted(self):
        crossed = CUBE.copy()
        crossed[7] = (1, 1, -.5)  # its edge turns over
        self.assertEqual(cube_measured(crossed, TWO_WEDGES)["inverted"], 1)

    def test_what_is_off(self):
        longer = CUBE * (1, 1, 1.1)
        result = cube_measured(longer, TWO_WEDGES)
        self.assertAlmostEqual(result["volume_off"], .1, places=9)
        self.assertEqual(result["caps_off"], 1)  # no face is in the upper cap's plane
        wider = CUBE.copy()
        wider[5, 0] = wider[7, 0] = 1.1
        self.assertAlmostEqual(cube_measured(wider, TWO_WEDGES)["caps_off"], .1, places=9)


if __name__ == "__main__":
    unittest.main()
