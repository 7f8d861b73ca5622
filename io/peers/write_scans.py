"""Writes scans by nibabel or pydicom into a folder, and prints as JSON where some of their voxels lie (LPS, mm) and what they hold. For the tests alone:
write_scans.py nibabel|pydicom FOLDER"""

import json
import os
import sys

import numpy

random = numpy.random.default_rng(17)
written = []


def tell(path, frame, places, values):
    written.append({"path": path, "frame": frame,
                    "voxels": [[float(x) for x in place] + [float(value)] for place, value in zip(places, values)]})


def some_voxels(shape):
    return [tuple(int(random.integers(size)) for size in shape) for _ in range(8)]


def by_nibabel(folder):
    import nibabel

    def affine():
        turn, _ = numpy.linalg.qr(random.normal(size=(3, 3)))
        matrix = numpy.eye(4)
        matrix[:3, :3] = turn @ numpy.diag(random.uniform(0.5, 3, 3))
        matrix[:3, 3] = random.uniform(-200, 200, 3)
        return matrix

    shape = (5, 4, 6)
    kinds = [(c, e, t, f, q) for c in (nibabel.Nifti1Image, nibabel.Nifti2Image) for e in (".nii", ".nii.gz")
             for t in ("u1", "i1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8", ">i2", ">u4", ">i8", ">f8")
             for f in (1, 3) for q in (False, True)]
    for n, (kind, ending, number, frames, by_quaternion) in enumerate(kinds):
        values = random.integers(0, 100, shape + (frames,)).astype(numpy.dtype(number))
        image = kind(values if frames > 1 else values[..., 0], affine(), dtype=numpy.dtype(number))
        if number[0] == ">":
            image = kind(image.dataobj, image.affine, image.header.as_byteswapped(">"), dtype=numpy.dtype(number))
        if by_quaternion:
            image.set_qform(image.affine, 1)
            image.set_sform(None, 0)
        if n % 3 == 0:
            image.header.set_slope_inter(2.5, -7)
        path = os.path.join(folder, f"{n}{ending}")
        nibabel.save(image, path)
        read = nibabel.load(path)
        stored = read.get_fdata().reshape(shape + (frames,))
        for frame in range(frames):
            at = some_voxels(shape)
            ras = [read.affine[:3, :3] @ numpy.array(v) + read.affine[:3, 3] for v in at]
            tell(path, frame, [(-x, -y, z) for x, y, z in ras], [stored[v + (frame,)] for v in at])
    for parts in (3, 4):
        color = random.integers(0, 256, shape + (parts,)).astype("u1")
        packed = numpy.dtype([(letter, "u1") for letter in "RGBA"[:parts]])
        path = os.path.join(folder, f"colors{parts}.nii.gz")
        nibabel.save(nibabel.Nifti1Image(color.view(packed).reshape(shape), numpy.diag([-1, -1, 1, 1])), path)
        at = some_voxels(shape)
        tell(path, 0, at, [round(float(color[v][:3] @ numpy.array([0.299, 0.587, 0.114]))) for v in at])


def by_pydicom(folder):
    import pydicom
    from pydicom.encaps import encapsulate
    from pydicom.pixel_data_handlers.rle_handler import rle_encode_frame
    from pydicom.uid import (DeflatedExplicitVRLittleEndian, ExplicitVRBigEndian, ExplicitVRLittleEndian,
                             ImplicitVRLittleEndian, RLELossless, generate_uid)

    def image(sop_class, modality, syntax, pixels):
        data = pydicom.Dataset()
        data.file_meta = pydicom.dataset.FileMetaDataset()
        data.file_meta.TransferSyntaxUID = syntax
        data.file_meta.MediaStorageSOPClassUID = data.SOPClassUID = sop_class
        data.file_meta.MediaStorageSOPInstanceUID = data.SOPInstanceUID = generate_uid()
        data.StudyInstanceUID, data.SeriesInstanceUID, data.FrameOfReferenceUID = "1.2.3", "1.2.3.4", "1.2.3.5"
        data.Modality, data.SamplesPerPixel, data.PhotometricInterpretation = modality, 1, "MONOCHROME2"
        data.ImagePositionPatient, data.ImageOrientationPatient = [-10, -20, 30], [1, 0, 0, 0, 1, 0]
        data.PixelSpacing, data.SliceThickness = [2, 1.5], 3
        data.Rows, data.Columns = pixels.shape[-2:]
        data.BitsAllocated = data.BitsStored = 8 * pixels.dtype.itemsize
        data.HighBit, data.PixelRepresentation = data.BitsStored - 1, int(pixels.dtype.kind == "i")
        data.is_little_endian, data.is_implicit_VR = syntax != ExplicitVRBigEndian, syntax == ImplicitVRLittleEndian
        data.PixelData = pixels.astype(pixels.dtype.newbyteorder("<" if data.is_little_endian else ">")).tobytes()
        data["PixelData"].VR = "OW"
        return data

    def place(k, j, i):
        return -10 + 1.5 * i, -20 + 2 * j, 30 + 3 * k

    shape = (5, 7, 6)
    z, y, x = numpy.mgrid[:5, :7, :6]
    bump = numpy.exp(-0.1 * ((x - 2) ** 2 + (y - 3) ** 2 + (z - 2) ** 2))
    for syntax in (ImplicitVRLittleEndian, ExplicitVRLittleEndian, ExplicitVRBigEndian, DeflatedExplicitVRLittleEndian, RLELossless):
        for most in (2**31, 70000, 900):
            pixels = (most * bump).astype("u4")
            dose = image("1.2.840.10008.5.1.4.1.1.481.2", "RTDOSE", syntax, pixels)
            dose.NumberOfFrames, dose.GridFrameOffsetVector, dose.FrameIncrementPointer = 5, [0, 3, 6, 9, 12], 0x3004000C
            dose.DoseGridScaling, dose.DoseUnits = "0.001", "GY"
            if syntax == RLELossless:
                dose.PixelData = encapsulate([rle_encode_frame(frame) for frame in pixels])
                dose["PixelData"].VR, dose["PixelData"].is_undefined_length = "OB", True
            path = os.path.join(folder, f"dose{len(written)}.dcm")
            dose.save_as(path, write_like_original=False)
            at = some_voxels(shape)
            tell(path, 0, [place(*v) for v in at], [0.001 * pixels[v] for v in at])
    for syntax in (ImplicitVRLittleEndian, ExplicitVRBigEndian):
        path = os.path.join(folder, f"signs{len(written)}")
        os.mkdir(path)
        slices = [random.integers(30000, 65535, shape[1:]).astype("u2") if k % 2 else
                  random.integers(-30000, 30000, shape[1:]).astype("i2") for k in range(shape[0])]
        for k, pixels in enumerate(slices):
            data = image("1.2.840.10008.5.1.4.1.1.4", "MR", syntax, pixels)
            data.ImagePositionPatient = [-10, -20, 30 + 3 * k]
            data.save_as(os.path.join(path, str(k)), write_like_original=False)
        at = some_voxels(shape)
        tell(path, 0, [place(*v) for v in at], [slices[v[0]][v[1:]] for v in at])
    for ties in (1, 2, 60):  # an MR stack of 55 slices in two passes: each second slice, then the others
        path = os.path.join(folder, f"passes{ties}")
        os.mkdir(path)
        stack = random.integers(0, 1000, (55, 7, 6)).astype("u2")
        for rank, k in enumerate(list(range(0, 55, 2)) + list(range(1, 55, 2))):
            data = image("1.2.840.10008.5.1.4.1.1.4", "MR", ExplicitVRLittleEndian, stack[k])
            data.ImagePositionPatient, data.PixelSpacing = [-10, -20, 30 + 2.5 * k], [2, f"{1.5 + 1e-6 * (k % 3):.6f}"]
            data.SliceThickness, data.SpacingBetweenSlices, data.InstanceNumber = 2.5, 2.5, k + 1
            data.PatientID = "" if k % 2 else "7"
            data.ContentTime = data.AcquisitionTime = f"1010{rank * ties // 60:02d}"
            data.save_as(os.path.join(path, str(rank)), write_like_original=False)
        at = some_voxels(stack.shape)
        tell(path, 0, [(-10 + 1.5 * i, -20 + 2 * j, 30 + 2.5 * k) for k, j, i in at], [stack[v] for v in at])


{"nibabel": by_nibabel, "pydicom": by_pydicom}[sys.argv[1]](sys.argv[2])
print(json.dumps(written))
