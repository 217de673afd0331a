"""One small tree in the formats that no program at hand writes, after their documentation and files of their
programs."""
import json
import math
import struct
import zipfile

import numpy

from report import Tree

# Millimetres, LPS; every vessel has the radius 2, so that formats with one radius per vessel hold the same tree.
POINTS = numpy.array([[0, 0, 0], [0, 0, 20], [-8, 0, 33], [8, 3, 33]], float)
SEGMENTS = numpy.array([[0, 1], [1, 2], [1, 3]])
RADIUS = 2.0
TREE = Tree(POINTS, numpy.full(4, RADIUS), SEGMENTS)


def write(path, content):
    with open(path, "wb") as file:
        file.write(content.encode() if isinstance(content, str) else content)
    return path


def markups(path, curve):
    """A curve of 3D Slicer, in RAS as its older versions wrote."""
    points = [{"id": str(i + 1), "position": [-p[0], -p[1], p[2]]} for i, p in enumerate(POINTS[curve])]
    markup = {
        "type": "Curve",
        "coordinateSystem": "RAS",
        "coordinateUnits": "mm",
        "controlPoints": points,
        "measurements": [{"name": "Radius", "controlPointValues": [RADIUS] * len(points), "units": "mm"}],
    }
    return write(path, json.dumps({"markups": [markup]}))


def contour_group(path):
    """A contour group of SimVascular, in cm: rings around a straight vessel, the tree's trunk."""
    corners = 64
    # As large as a circle of that radius.
    reach = RADIUS / 10 * math.sqrt(2 * math.pi / (corners * math.sin(2 * math.pi / corners)))
    contours = ""
    for number, z in enumerate((0, 1, 2)):
        ring = "".join(
            f'<point id="{i}" x="{reach * math.cos(a)!r}" y="{reach * math.sin(a)!r}" z="{z}" />'
            for i, a in enumerate(2 * math.pi * k / corners for k in range(corners))
        )
        contours += (
            f'<contour id="{number}" type="Circle" method="Manual" closed="true"><path_point id="{number}">'
            f'<pos x="0" y="0" z="{z}" /></path_point><control_points /><contour_points>{ring}'
            "</contour_points></contour>"
        )
    return write(
        path,
        '<?xml version="1.0" encoding="UTF-8" ?><format version="1.0" /><contourgroup path_name="trunk" '
        f'path_id="1"><timestep id="0"><lofting_parameters />{contours}</timestep></contourgroup>',
    )


def path_of_points(path):
    """A path of SimVascular, in cm."""
    points = "".join(
        f'<path_point id="{i}"><pos x="0" y="0" z="{z}" /><tangent x="0" y="0" z="1" /></path_point>'
        for i, z in enumerate((0, 1, 2))
    )
    return write(
        path,
        '<?xml version="1.0" encoding="UTF-8" ?><format version="1.0" /><path id="1" method="0"><timestep '
        f'id="0"><path_element><control_points /><path_points>{points}</path_points></path_element></timestep>'
        "</path>",
    )


TRUNK = Tree(
    numpy.array([[0, 0, 0], [0, 0, 10], [0, 0, 20]], float), numpy.full(3, RADIUS), numpy.array([[0, 1], [1, 2]])
)


def gxl(path, voxel):
    """A tree of VascuSynth: positions in voxels, names with a leading blank."""

    def node(number, place):
        floats = "".join(f"<float>{x!r}</float>" for x in place / voxel)
        return (
            f'<node id="n{number}"><attr name=" nodeType"><string> bifurication </string></attr>'
            f'<attr name=" position"><tup>{floats}</tup></attr></node>'
        )

    edges = "".join(
        f'<edge id="e{i}" to="n{b}" from="n{a}"><attr name=" flow"><float>1</float></attr>'
        f'<attr name=" radius"><float>{RADIUS}</float></attr></edge>'
        for i, (a, b) in enumerate(SEGMENTS)
    )
    nodes = "".join(node(i, p) for i, p in enumerate(POINTS))
    return write(
        path, f'<gxl><graph id="vasculature" edgeids="true" edgemode="undirected">{nodes}{edges}</graph></gxl>'
    )


def spatial_graph(path, binary):
    """A spatial graph of Amira, micrometres, `thickness` being the radius."""
    points = numpy.concatenate([POINTS[segment] for segment in SEGMENTS]) * 1000
    blocks = [
        (POINTS * 1000, "f"),
        (SEGMENTS, "i"),
        (numpy.full(3, 2), "i"),
        (points, "f"),
        (numpy.full(6, RADIUS * 1000), "f"),
    ]
    head = (
        "# AmiraMesh " + ("BINARY-LITTLE-ENDIAN" if binary else "3D ASCII") + " 2.0\n\ndefine VERTEX 4\ndefine EDGE 3\n"
        'define POINT 6\n\nParameters {\n  ContentType "HxSpatialGraph"\n}\n\n'
        "VERTEX { float[3] VertexCoordinates } @1\nEDGE { int[2] EdgeConnectivity } @2\nEDGE { int NumEdgePoints } @3\n"
        "POINT { float[3] EdgePointCoordinates } @4\nPOINT { float thickness } @5\n\n# Data section follows\n"
    )
    body = b""
    for number, (values, kind) in enumerate(blocks, 1):
        flat = [kind == "i" and int(v) or float(v) if kind == "f" else int(v) for v in numpy.asarray(values).ravel()]
        text = "\n".join(map(str, flat)).encode()
        body += f"@{number}\n".encode() + (struct.pack(f"<{len(flat)}{kind}", *flat) if binary else text) + b"\n\n"
    return write(path, head.encode() + body)


def network(path):
    """network.dat of the Secomb group: diameters, micrometres."""
    segments = "".join(f"{i} 5 {a + 1} {b + 1} {2000 * RADIUS} 1 0.4\n" for i, (a, b) in enumerate(SEGMENTS, 1))
    nodes = "".join(f"{i} {' '.join(str(1000 * x) for x in p)}\n" for i, p in enumerate(POINTS, 1))
    return write(
        path,
        "Small tree\n20000 20000 40000 box dimensions in microns\n32 32 32 number of tissue points\n"
        "20 outer bound distance\n4000 max. segment length\n50 maximum number of segments per node\n"
        f"3 total number of segments\nSegName Type StartNode EndNode Diam Flow Hd\n{segments}"
        f"4 total number of nodes\nNodName x y z\n{nodes}",
    )


def vmv(path):
    """VessMorphoVis, micrometres."""
    vertices = "".join(f"{i} {' '.join(str(1000 * x) for x in p)} {1000 * RADIUS}\n" for i, p in enumerate(POINTS, 1))
    strands = "".join(f"{i} {a + 1} {b + 1}\n" for i, (a, b) in enumerate(SEGMENTS, 1))
    return write(
        path,
        f"$PARAM_BEGIN\nNUM_VERTS 4\nNUM_STRANDS 3\nNUM_ATTRIB_PER_VERT 4\n$PARAM_END\n$VERT_LIST_BEGIN\n"
        f"{vertices}$VERT_LIST_END\n\n$STRANDS_LIST_BEGIN\n{strands}$STRANDS_LIST_END\n",
    )


def swc(path):
    rows = [
        f"{i + 1} 0 {p[0]} {p[1]} {p[2]} {RADIUS} {parent}" for i, (p, parent) in enumerate(zip(POINTS, (-1, 1, 2, 2)))
    ]
    return write(path, "\n".join(rows) + "\n")


def pair(path):
    write(path.replace(".csv", ".segments.csv"), "a,b\n" + "".join(f"{a},{b}\n" for a, b in SEGMENTS))
    return write(
        path, "id,x,y,z,radius\n" + "".join(f"{i},{p[0]},{p[1]},{p[2]},{RADIUS}\n" for i, p in enumerate(POINTS))
    )


def voreen(path):
    """Tables of nodes and edges by Voreen, a radius per edge."""
    write(
        path.replace("nodes", "edges"),
        "id;node1id;node2id;length;avgRadiusAvg;avgRadiusStd\n"
        + "".join(f"{i};{a};{b};20;{RADIUS};0\n" for i, (a, b) in enumerate(SEGMENTS)),
    )
    return write(
        path,
        "id;pos_x;pos_y;pos_z;degree;isAtSampleBorder\n"
        + "".join(f"{i};{p[0]};{p[1]};{p[2]};1;0\n" for i, p in enumerate(POINTS)),
    )


def tubes(path, binary):
    """A scene of ITK-TubeTK: a tube per vessel, in voxels of half a millimetre, children at a point of their parent."""
    scene = b"ObjectType = Scene\nNDims = 3\nNObjects = 3\n"
    for number, (a, b) in enumerate(SEGMENTS):
        scene += (
            f"ObjectType = Tube\nObjectSubType = Vessel\nNDims = 3\nID = {number}\nParentID = {number and 0 or -1}\n"
            f"BinaryData = {binary}\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\nElementSpacing = 0.5 0.5 0.5\n"
            f"ParentPoint = {number and 1 or -1}\nRoot = {not number}\nPointDim = id x y z red r\nNPoints = 2\nPoints = \n"
        ).encode()
        rows = [[i, *(POINTS[n] * 2), 1, RADIUS * 2] for i, n in enumerate((a, b))]
        if binary:
            scene += struct.pack("<12f", *rows[0], *rows[1]) + b"\n"
        else:
            scene += "".join(" ".join(map(str, row)) + " \n" for row in rows).encode()
    return write(path, scene + b"EndGroup = \n")


def own_json(path):
    return write(
        path,
        json.dumps(
            {
                "schema": "vmesh.centerline/1",
                "unit": "cm",
                "space": "RAS",
                "segments": SEGMENTS.tolist(),
                "nodes": [[-p[0] / 10, -p[1] / 10, p[2] / 10, RADIUS / 10] for p in POINTS],
            }
        ),
    )


def model_3mf(path, surface):
    """A 3MF of one object, millimetres."""
    vertices = "".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}" />' for x, y, z in surface.points.tolist())
    faces = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}" />' for a, b, c in surface.faces.tolist())
    relations = (
        '<?xml version="1.0" encoding="UTF-8"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/'
        'relationships"><Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/'
        '3dmanufacturing/2013/01/3dmodel" /></Relationships>'
    )
    model = (
        '<?xml version="1.0" encoding="UTF-8"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/'
        '3dmanufacturing/core/2015/02"><resources><object id="1" type="model"><mesh>'
        f"<vertices>{vertices}</vertices><triangles>{faces}</triangles></mesh></object></resources>"
        '<build><item objectid="1" /></build></model>'
    )
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("_rels/.rels", relations)
        archive.writestr("3D/3dmodel.model", model)
    return path
