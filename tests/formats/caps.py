"""Capped ends for flow: what vmesh writes for SimVascular's models, read by VTK, beside the caps of the models."""
import json
import os

import numpy

from report import expect

MODELS = (
    (
        "SU201",
        "generate-1d-mesh_example_SU201_2005_RPA1_cl.vtp",
        "generate-1d-mesh_example_SU201_2005_RPA1_exterior.vtp",
        6,
    ),
    (
        "the aorta",
        "centerline-based-material-props_c++_aorta_cl.vtp",
        "centerline-based-material-props_c++_aorta.vtp",
        3,
    ),
)
ALLOWED = 0.05  # of a cap's area, and of its root


def caps_of(surface):
    """Area of the triangles, the same seen along the normal, mm2, and centre of every group of faces of one ModelFaceID
    that is flat, which walls are not."""
    caps = {}
    for number in numpy.unique(surface.of_faces["ModelFaceID"]):
        corners = surface.points[surface.faces[surface.of_faces["ModelFaceID"] == number]]
        normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
        areas = numpy.linalg.norm(normals, axis=1)
        seen = numpy.linalg.norm(normals.sum(0))
        if seen > 0.95 * areas.sum():
            center = (corners.mean(1) * areas[:, None]).sum(0) / areas.sum()
            caps[int(number)] = areas.sum(), seen, center
    return caps


def check(table, vtk, vmesh, shared_data):
    folder = os.path.join(shared_data, "pairs_centerline_surface")
    if not os.path.isdir(folder):
        table.notes.append("SKIPPED caps: the folder of shared data is not there")
        return
    for title, centerline, model, count in MODELS:
        table.check(
            ".vtp",
            f"out, the {count} caps of {title}",
            vtk.name,
            lambda names=(centerline, model, count): agree(vtk, vmesh, folder, *names),
        )


def agree(vtk, vmesh, folder, centerline, model, count):
    out, summary = vmesh.path("caps.vtp"), vmesh.path("caps.json")
    model = os.path.join(folder, model)
    vmesh("generate", os.path.join(folder, centerline), out, "--fit", model, "--ends", "flat", "--json", summary)
    surface = vtk.surface("vtkXMLPolyDataReader", out)
    ours, theirs = caps_of(surface), caps_of(vtk.surface("vtkXMLPolyDataReader", model))
    expect(sorted(ours) == list(range(2, count + 2)), f"the caps' ModelFaceIDs are {sorted(ours)}")
    expect(len(theirs) == count, f"the model has {len(theirs)} caps")
    with open(summary) as file:
        listed = {cap["model_face_id"]: cap["area_mm2"] for cap in json.load(file)["caps"]}
    expect(set(listed) == set(ours), f"the summary lists {sorted(listed)}")
    worst = 0
    for number, (area, seen, center) in ours.items():
        expect(abs(listed[number] - seen) < 1e-9 * seen, f"cap {number}: {seen} mm2, the summary says {listed[number]}")
        nearest = min(theirs, key=lambda key: numpy.linalg.norm(theirs[key][2] - center))
        their_area, _, their_center = theirs.pop(nearest)
        off = numpy.linalg.norm(center - their_center)
        expect(off <= ALLOWED * their_area**0.5, f"cap {number}: its centre is off by {off:.3g} mm")
        worst = max(worst, abs(area / their_area - 1))
    expect(worst <= ALLOWED, f"an area is off by {100 * worst:.3g} %")
    return len(surface.points), len(surface.faces), f"areas within {100 * worst:.1g} %", "mm, LPS (field data)"
