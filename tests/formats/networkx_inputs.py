"""Graphs written by networkx, read by vmesh."""
import json

import small_files as small
from inputs import check_tree
from report import Absent


def networkx_module():
    try:
        import networkx
    except ImportError as error:
        raise Absent(f"networkx is not installed (Debian: python3-networkx): {error}") from None
    return networkx


def graph(networkx, as_text):
    """The small tree; positions as three attributes or as one text, as GraphML has no lists."""
    made = networkx.Graph()
    for number, place in enumerate(small.POINTS.tolist()):
        where = {"pos": str(place)} if as_text else dict(zip("xyz", place))
        made.add_node(f"node {number}", radius=small.RADIUS, **where)
    made.add_edges_from((f"node {a}", f"node {b}") for a, b in small.SEGMENTS)
    return made


def write_json(networkx, path):
    return small.write(path, json.dumps(networkx.node_link_data(graph(networkx, False))))


def written_by(writer, made, path):
    writer(made, path)
    return path


def check(table, written):
    networkx, vmesh = networkx_module(), written.vmesh
    program = f"networkx {networkx.__version__}"
    for form, writer in ((".graphml", networkx.write_graphml), (".gexf", networkx.write_gexf)):
        for as_text, word in ((False, "x, y, z"), (True, "pos")):
            path = vmesh.path(f"by_networkx_{as_text}{form}")
            made = graph(networkx, as_text)
            check_tree(
                table,
                form,
                program,
                vmesh,
                lambda writer=writer, made=made, path=path: written_by(writer, made, path),
                way=f"in, {word}",
            )
    check_tree(
        table,
        ".json",
        program,
        vmesh,
        lambda: write_json(networkx, vmesh.path("by_networkx.json")),
        way="in, node-link",
    )
