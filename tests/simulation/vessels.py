"""Centerlines of simple vessels, what is known of the flow in them, and of pressure in their walls."""
import math

import numpy

RADIUS_MM, LENGTH_MM = 2.0, 30.0
BEND_MM = 8.0  # radius of the bend's axis


def write_swc(path, points):
    with open(path, "w") as file:
        file.write("# SPACE=LPS UNIT=mm\n")
        for i, (x, y, z) in enumerate(points):
            file.write(f"{i + 1} 0 {x:.12g} {y:.12g} {z:.12g} {RADIUS_MM:g} {i if i else -1}\n")


def tube():
    """Along z from 0."""
    return [(0.0, 0.0, LENGTH_MM * k / 15) for k in range(16)]


def bend():
    """Straight for four radii, a quarter of a circle, straight for four radii."""
    straight = 4 * RADIUS_MM
    before = [(0.0, 0.0, straight * k / 4) for k in range(4)]
    turn = [math.pi / 2 * k / 8 for k in range(9)]
    arc = [(BEND_MM * (1 - math.cos(t)), 0.0, straight + BEND_MM * math.sin(t)) for t in turn]
    x, _, z = arc[-1]
    return before + arc + [(x + straight * (k + 1) / 4, 0.0, z) for k in range(4)]


def poiseuille_gradient(flow, viscosity, area):
    """Pressure lost per length by `flow` (volume per time) in a round tube of that cross-section."""
    return 8 * math.pi * viscosity * flow / area**2


def parabola(points, centre, area):
    """The developed profile in a round tube, with mean 1, at points of its cross-section (n x 3)."""
    square = numpy.sum((points - centre) ** 2, axis=1) * math.pi / area
    return numpy.clip(2 * (1 - square), 0, None)


def lame_hoop(pressure, inner, outer, radius):
    """Hoop stress in a tube under inner pressure whose ends are held apart (Lame)."""
    return pressure * inner**2 / (outer**2 - inner**2) * (1 + outer**2 / radius**2)
