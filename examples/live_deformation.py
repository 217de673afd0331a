"""A tree that is pulled at, live: python3 examples/live_deformation.py [--show] [--frames N] [--save FILE.ply]

One twig is dragged along a circle while the inlet is held; the tree hangs on to it. With --instrument, a shaft sweeps
through the tree at the same time, and the forces on both hands are told. With --show in a
window (it needs python3-vtk9), otherwise it tells how long a frame takes.
"""

import argparse
import time
from typing import Callable, Optional, Tuple

import numpy as np
import vmesh
from numpy.typing import NDArray


def make_scene(nodes: int) -> Tuple[vmesh.Deformation, int]:
    """A deformation whose inlet is held, and the end that will be dragged: the one farthest away."""
    tree = vmesh.synthetic_tree(nodes, seed=1)
    surface = vmesh.generate(tree, around=8)
    deformation = vmesh.Deformation(surface, young_Pa=1e5, wall_ratio=0.3, damping_s=0.05, drag_per_s=2, step_s=1 / 60)
    deformation.clamp(0)
    farthest = int(np.argmax(np.linalg.norm(tree.nodes - tree.nodes[0], axis=1)))
    return deformation, farthest


def pull(deformation: vmesh.Deformation, node: int, start: NDArray[np.float64], frame: int) -> None:
    """One frame: the node goes along a circle of 12 mm, once in 180 frames."""
    angle = 2 * np.pi * frame / 180
    deformation.drag(node, start + 12 * np.array([np.cos(angle) - 1, 0, np.sin(angle)]))
    deformation.step()


class Shaft:
    """An instrument that goes through the middle of the tree and back, once in 360 frames."""

    def __init__(self, deformation: vmesh.Deformation) -> None:
        self.deformation = deformation
        low, high = deformation.nodes.min(axis=0), deformation.nodes.max(axis=0)
        self.radius = 0.02 * float(np.linalg.norm(high - low))
        half = 0.6 * (high[1] - low[1])
        self.outside = 0.5 * (low + high)
        self.outside[0] = low[0] - 4 * self.radius
        self.way = np.array([0.5 * (high[0] - low[0]), 0, 0])
        self.number = deformation.add_instrument(
            [[0, -half, 0], [0, half, 0]], self.radius, self.outside, friction=0.2
        )
        self.largest = 0.0

    def sweep(self, frame: int) -> None:
        part = 0.5 - 0.5 * np.cos(2 * np.pi * frame / 360)
        self.deformation.move_instrument(self.number, self.outside + part * self.way)

    def feel(self) -> None:
        force = self.deformation.instrument_force(self.number)
        self.largest = max(self.largest, float(np.linalg.norm(force.force)))


class Window:
    """What VTK shows of it. The points of VTK are written anew every frame, without a copy in between."""

    def __init__(self, deformation: vmesh.Deformation) -> None:
        import vtkmodules.vtkInteractionStyle  # noqa: F401
        import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkRenderingCore import vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow

        self.deformation = deformation
        self.poly = deformation.rest.to_vtk()
        self.points = vtk_to_numpy(self.poly.GetPoints().GetData())
        mapper = vtkPolyDataMapper()
        mapper.SetInputData(self.poly)
        mapper.ScalarVisibilityOff()
        actor = vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(0.8, 0.35, 0.3)
        actor.GetProperty().SetInterpolationToFlat()
        self.renderer = vtkRenderer()
        self.renderer.SetBackground(1, 1, 1)
        self.renderer.AddActor(actor)
        self.window = vtkRenderWindow()
        self.window.SetSize(900, 700)
        self.window.AddRenderer(self.renderer)
        camera = self.renderer.GetActiveCamera()
        camera.SetPosition(0, -1, 0)
        camera.SetViewUp(0, 0, 1)
        self.renderer.ResetCamera()

    def draw(self) -> None:
        self.deformation.write_vertices(self.points)
        self.poly.GetPoints().GetData().Modified()
        self.window.Render()


def play(frames: int, step: Callable[[int], None], window: Optional[Window]) -> float:
    """Seconds a frame took, without drawing."""
    spent = 0.0
    for frame in range(frames):
        begin = time.perf_counter()
        step(frame)
        spent += time.perf_counter() - begin
        if window is not None:
            window.draw()
    return spent / frames


def main() -> None:
    parser = argparse.ArgumentParser(description="A tree that is pulled at.")
    parser.add_argument("--show", action="store_true", help="in a window")
    parser.add_argument("--save", help="the surface of the last frame, a .ply")
    parser.add_argument("--instrument", action="store_true", help="a shaft sweeps through the tree")
    parser.add_argument("--frames", type=int, default=180)
    parser.add_argument("--nodes", type=int, default=400)
    arguments = parser.parse_args()

    deformation, node = make_scene(arguments.nodes)
    start = deformation.nodes[node].copy()
    window = Window(deformation) if arguments.show else None
    shaft = Shaft(deformation) if arguments.instrument else None

    def step(frame: int) -> None:
        if shaft is not None:
            shaft.sweep(frame)
        pull(deformation, node, start, frame)
        if shaft is not None:
            shaft.feel()

    seconds = play(arguments.frames, step, window)
    print(f"{len(deformation.vertices)} vertices: {1000 * seconds:.2f} ms a frame, without drawing")
    moved = np.linalg.norm(deformation.vertices - deformation.rest.vertices, axis=1)
    print(f"after {deformation.time:.2f} s: {moved.mean():.1f} mm from rest in the mean, {moved.max():.1f} at most")
    if shaft is not None:
        hand = np.linalg.norm(deformation.drag_force(node).force)
        print(f"the shaft felt up to {1000 * shaft.largest:.2f} mN; at the end, {1000 * hand:.2f} mN pull at the twig")
    if arguments.save:
        deformation.surface().save(arguments.save)


if __name__ == "__main__":
    main()
