"""CalculiX: the wall of a tube under pressure, against Lame's solution."""
import os
import re
import shutil

import numpy

import vessels
from report import Absent, expect, run

PRESSURE = 0.01  # MPa, 75 mmHg
WALL_MM = 0.5
YOUNG, POISSON = 1.0, 0.3  # MPa; stress does not depend on them

DECK = """*INCLUDE, INPUT=mesh.inp
*MATERIAL, NAME=tissue
*ELASTIC
{young}, {poisson}
*SOLID SECTION, ELSET=wall, MATERIAL=tissue
*TRANSFORM, NSET=inlet_wall, TYPE=C
0, 0, 0, 0, 0, 1
*TRANSFORM, NSET=outlet_wall, TYPE=C
0, 0, 0, 0, 0, 1
*BOUNDARY
inlet_wall, 2, 3
outlet_wall, 2, 3
*STEP
*STATIC
*DSLOAD
lumen_wall, P, {pressure}
*EL PRINT, ELSET=wall
S
*END STEP
"""


def read_mesh(path):
    """Points by number, and corners of elements by number."""
    points, elements, table = {}, {}, None
    with open(path) as file:
        for line in file:
            if line.startswith("*"):
                keyword = line.split(",")[0].strip()
                table = {"*NODE": points, "*ELEMENT": elements}.get(keyword)
            elif table is not None:
                words = line.split(",")
                table[int(words[0])] = [float(w) if table is points else int(w) for w in words[1:]]
    return points, elements


def hoop_stresses(folder):
    """Points and elements by number, and of every element its middle and its mean hoop stress, from CalculiX's table."""
    points, elements = read_mesh(os.path.join(folder, "mesh.inp"))
    with open(os.path.join(folder, "tube.dat")) as file:
        rows = [line.split() for line in file if re.match(r"\s*\d+\s+\d+\s", line)]
    stresses = {}
    for row in rows:
        stresses.setdefault(int(row[0]), []).append([float(value) for value in row[2:8]])
    middles, hoop = [], []
    for number, corners in elements.items():
        middle = numpy.mean([points[c] for c in corners], axis=0)
        xx, yy, _, xy, _, _ = numpy.mean(stresses[number], axis=0)
        x, y = middle[:2] / numpy.hypot(*middle[:2])
        middles.append(middle)
        hoop.append(xx * y * y + yy * x * x - 2 * xy * x * y)
    return points, elements, numpy.array(middles), numpy.array(hoop)


def stress_at_mid_length(folder):
    """Number of elements, radius of the middle of those at mid-length, and the hoop stress in these."""
    _, elements, middles, hoop = hoop_stresses(folder)
    inside = abs(middles[:, 2] - vessels.LENGTH_MM / 2) <= vessels.LENGTH_MM / 4
    return len(elements), numpy.hypot(middles[inside, 0], middles[inside, 1]), hoop[inside]


def check_tube(vmesh, folder, table):
    program = shutil.which("ccx")
    if not program:
        raise Absent("CalculiX is not installed (Debian: calculix-ccx)")
    home = os.path.join(folder, "shell")
    os.makedirs(home)
    vmesh.volume("tube", os.path.join(home, "mesh.inp"), "--around", 32, "--wall-thickness", f"{WALL_MM}mm",
                 "--wall-layers", 4, "--wall-only")
    with open(os.path.join(home, "tube.inp"), "w") as file:
        file.write(DECK.format(young=YOUNG, poisson=POISSON, pressure=PRESSURE))
    said = run([program, "tube"], cwd=home, env={"OMP_NUM_THREADS": "1"} | os.environ)
    expect("Job finished" in said, "ccx: " + said[-500:])
    cells, radii, hoop = stress_at_mid_length(home)
    inner, outer = vessels.RADIUS_MM, vessels.RADIUS_MM + WALL_MM
    table.add("CalculiX", "pressurised wall, mean hoop stress", cells, hoop.mean(), PRESSURE * inner / WALL_MM, 0.03,
              "p r / t", "MPa")
    edges = numpy.linspace(inner, outer, 5)
    for name, low, high in (("innermost", edges[0], edges[1]), ("outermost", edges[3], edges[4])):
        within = (radii > low) & (radii < high)
        expected = vessels.lame_hoop(PRESSURE, inner, outer, radii[within]).mean()
        table.add("CalculiX", f"pressurised wall, hoop stress in the {name} layer", cells, hoop[within].mean(),
                  expected, 0.03, "Lame", "MPa")
