"""Slices as the plug-in takes them from a scan, against those of ParaView's own representation: the same pixels."""

from palpate_test import expect, main, open_series, phantom
from paraview import servermanager, simple
from paraview.vtk import vtkUnsignedCharArray


def pictures(reader, mode, own):
    """Of slices in three places, as ParaView's `own` class draws them or as the plug-in's."""
    definitions = servermanager.ActiveConnection.Session.GetProxyDefinitionManager()
    slices = definitions.GetProxyDefinition("representations", "ImageSliceRepresentation")
    quick = slices.GetAttribute("class")
    expect(quick == "PalpateQuickSlices", f"slices are {quick}")
    view = simple.CreateView("RenderView")
    view.ViewSize, view.UseFXAA, view.OrientationAxesVisibility = [200, 200], 0, 0
    if own:
        slices.SetAttribute("class", "vtkImageSliceRepresentation")
    shown = simple.Show(reader, view, "UniformGridRepresentation")
    slices.SetAttribute("class", quick)
    shown.SetRepresentationType("Slice")
    shown.SliceMode = mode
    simple.ColorBy(shown, ("POINTS", "HU"))
    simple.Render(view)  # the first one places the camera
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = (90, -70, 40), (0, 0, 0), (0, 0, 1)
    found = []
    for shown.Slice in (0, 23, 1000):
        simple.Render(view)
        pixels = vtkUnsignedCharArray()
        view.GetRenderWindow().GetPixelData(0, 0, 199, 199, 0, pixels, 0)
        found.append(bytes(memoryview(pixels)))
    simple.Delete(view)
    return found


def slices_are_drawn_as_by_paraview():
    for name in ("noisy", "oblique", "tilted"):
        reader = open_series(phantom(name))
        for mode in ("XY Plane", "YZ Plane", "XZ Plane"):
            own, quick = (pictures(reader, mode, own) for own in (True, False))
            expect(len(set(own)) == 3 and len(set(own[1])) > 20, f"{name}, {mode}: ParaView's own shows nothing")
            expect(quick == own, f"{name}, {mode}: other pixels than ParaView's own")


main([slices_are_drawn_as_by_paraview])
