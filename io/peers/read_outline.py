"""Prints, as a JSON list with an entry for each file, what pydicom or nibabel reads of an outline: a segmentation's frames with their places, an RTSTRUCT's
contours, or a NIfTI file's voxels with their affine. For the tests alone."""

import json
import sys

import numpy


def of_segmentation(data):
    shared = data.SharedFunctionalGroupsSequence[0]
    pixels = numpy.atleast_3d(data.pixel_array)
    pixels = pixels.reshape(int(data.NumberOfFrames), data.Rows, data.Columns)
    frames = data.PerFrameFunctionalGroupsSequence
    segment = data.SegmentSequence[0]
    return {
        "patient": str(data.PatientName),
        "name": str(segment.SegmentLabel),
        "orientation": [float(x) for x in shared.PlaneOrientationSequence[0].ImageOrientationPatient],
        "spacing": [float(x) for x in shared.PixelMeasuresSequence[0].PixelSpacing],
        "positions": [[float(x) for x in f.PlanePositionSequence[0].ImagePositionPatient] for f in frames],
        "pixels": "".join(str(v) for v in pixels.ravel()),
        "sources": sorted({s.ReferencedSOPInstanceUID for f in frames for d in f.DerivationImageSequence
                           for s in d.SourceImageSequence}),
    }


def of_contours(data):
    roi = data.ROIContourSequence[0]
    return {
        "patient": str(data.PatientName),
        "name": str(data.StructureSetROISequence[0].ROIName),
        "color": [int(x) for x in roi.ROIDisplayColor],
        "contours": [[float(x) for x in c.ContourData] for c in roi.ContourSequence],
        "points": [int(c.NumberOfContourPoints) for c in roi.ContourSequence],
    }


def text_of(extension):
    """Nibabel before 5.3 has no `content`; from then on get_content() refuses comments."""
    content = extension.content if hasattr(extension, "content") else extension.get_content()
    return content.decode("utf-8", "replace") if isinstance(content, bytes) else str(content)


def of_nifti(path):
    import nibabel

    image = nibabel.load(path)
    voxels = numpy.asarray(image.dataobj)
    return {
        "affine": image.affine.tolist(),
        "qform": image.get_qform(coded=True)[1] and image.get_qform().tolist() or None,
        "shape": list(voxels.shape),
        "pixels": "".join(str(int(v)) for v in voxels.ravel(order="F")),
        "extensions": [text_of(extension) for extension in image.header.extensions],
    }


def of_file(path):
    if path.endswith((".nii", ".nii.gz")):
        return of_nifti(path)
    import pydicom

    data = pydicom.dcmread(path)
    return of_segmentation(data) if data.Modality == "SEG" else of_contours(data)


print(json.dumps([of_file(path) for path in sys.argv[1:]]))
