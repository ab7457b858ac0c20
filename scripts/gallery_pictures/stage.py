"""One frame of a run as a picture."""

import itertools

import vtkmodules.vtkInteractionStyle  # noqa: F401  (these two register themselves)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkLightKit, vtkRenderer, vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter

import actors
import walls


class Stage:
    """A camera that stays where the first frame that is drawn has put it."""

    def __init__(self, picture, run, size=(900, 600)):
        self.picture, self.run, self.size = picture, run, size
        self.renderer = None
        self.lights = vtkLightKit()
        self.lights.SetKeyLightAngle(60, 20)
        self.lights.SetKeyToFillRatio(2.2)
        self.window = vtkRenderWindow()
        self.window.SetOffScreenRendering(1)
        self.window.SetMultiSamples(8)
        self.window.SetSize(*size)

    def draw(self, k):
        """@return pixels of frame k: rows × columns × 3, bytes"""
        camera = self.renderer.GetActiveCamera() if self.renderer else None
        if self.renderer:
            self.window.RemoveRenderer(self.renderer)
        self.renderer = vtkRenderer()
        self.renderer.SetBackground(1, 1, 1)
        self.lights.AddLightsToRenderer(self.renderer)
        self.window.AddRenderer(self.renderer)
        bars = []
        time = self.run.series("grains")[k][0]
        for make in (self.grains, self.solids, self.lines, self.walls):
            for actor, bar in make(k):
                self.renderer.AddActor(actor)
                if bar and bar.GetTitle() not in [other.GetTitle() for other in bars]:
                    bars.append(bar)
        self.label(time, bars)
        if camera:
            self.renderer.SetActiveCamera(camera)
            self.renderer.ResetCameraClippingRange()
        else:
            self.place_camera()
        return self.pixels()

    def grains(self, k):
        yield actors.grains(self.run.series("grains")[k][1], self.picture)

    def solids(self, k):
        for solid in self.run.scene.get("solids", []):
            frames = self.run.series(f"solid_{solid['name']}")
            if frames:
                yield actors.solid(frames[min(k, len(frames) - 1)][1], solid["name"], self.picture)

    def lines(self, k):
        if self.picture.lines:
            frames = self.run.series(self.picture.lines)
            yield from actors.lines(frames[min(k, len(frames) - 1)][1], self.picture)

    def walls(self, k):
        bounds = self.renderer.ComputeVisiblePropBounds()
        for number, wall in enumerate(self.run.scene.get("walls", [])):
            frames = self.run.series(f"wall_{number}")
            surface = walls.from_frame(frames[k][1], self.picture) if frames else walls.from_scene(wall, bounds)
            if surface:
                yield walls.actor(surface, self.picture.wall_opacity if frames else 0.2), None

    def label(self, time, bars):
        text = vtkTextActor()
        text.SetInput(f"t = {time:.3g} s")
        text.GetTextProperty().SetColor(0.15, 0.15, 0.15)
        text.GetTextProperty().SetFontSize(max(12, self.size[1] // 30))
        text.SetPosition(12, self.size[1] - self.size[1] // 16)
        self.renderer.AddViewProp(text)
        for number, bar in enumerate(bars):
            actors.place_bar(bar, number, len(bars), self.size[1])
            self.renderer.AddViewProp(bar)

    def place_camera(self):
        camera = self.renderer.GetActiveCamera()
        camera.SetFocalPoint(0, 0, 0)
        camera.SetPosition(*self.picture.direction)
        camera.SetViewUp(*self.picture.up)
        camera.SetViewAngle(20)
        self.renderer.ResetCamera()
        (left, right), (below, above) = self.extent()
        zoom = self.picture.zoom * min(1.9 / (right - left), 1.65 / (above - below))
        camera.Zoom(zoom)
        camera.SetWindowCenter(0.5 * zoom * (left + right), 0.5 * zoom * (below + above) - 0.12)  # bars are below
        self.renderer.ResetCameraClippingRange()

    def extent(self):
        """Of the box around everything, in the window: −1 … 1 across and upwards."""
        bounds = self.renderer.ComputeVisiblePropBounds()
        camera = self.renderer.GetActiveCamera()
        matrix = camera.GetCompositeProjectionTransformMatrix(self.size[0] / self.size[1], 0, 1)
        seen = []
        for corner in itertools.product(bounds[0:2], bounds[2:4], bounds[4:6]):
            x, y, _, w = matrix.MultiplyPoint((*corner, 1.0))
            seen.append((x / w, y / w))
        return [(min(values), max(values)) for values in zip(*seen)]

    def pixels(self):
        self.window.Render()
        grab = vtkWindowToImageFilter()
        grab.SetInput(self.window)
        grab.SetInputBufferTypeToRGB()
        grab.ReadFrontBufferOff()
        grab.Update()
        image = grab.GetOutput()
        columns, rows, _ = image.GetDimensions()
        return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(rows, columns, 3)[::-1].copy()
