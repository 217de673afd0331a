"""Vessel centerlines to surfaces.

A centerline (points with radii, and the segments between them) becomes a closed triangle mesh with
few, well-shaped triangles, that is measured, fitted to a segmentation and deformed:

>>> import vmesh
>>> tree = vmesh.read_centerline("tree.swc")
>>> surface = vmesh.generate(tree, around=6)
>>> surface.vertices, surface.faces                      # NumPy arrays, not copied
>>> surface.save("tree.ply")

Lengths are in millimetres, positions in the LPS frame (x to the left, y to the back, z up); a name
says where it is otherwise. Long calls let other threads run and end on Ctrl-C. What vmesh raises is
derived from vmesh.Error; bad arguments raise vmesh.InvalidInput, which is a ValueError too.
"""

TYPE_CHECKING = False  # for checkers of types it is true

# NumPy and the compiled module are loaded when the first name is asked for; the command `vmesh` asks for none.
if TYPE_CHECKING:
    from ._public import *
    from ._public import __all__, __version__
else:

    def _load():
        import vmesh._public as public

        globals().update({name: getattr(public, name) for name in ("__all__", *public.__all__)})

    def __getattr__(name):
        if not name.startswith("_") or name in ("__all__", "__version__"):
            _load()
            if name in globals():
                return globals()[name]
        raise AttributeError(f"module 'vmesh' has no attribute '{name}'")

    def __dir__():
        _load()
        return sorted(globals())
