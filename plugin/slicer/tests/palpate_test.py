"""The module in Slicer, without Slicer: its logic alone, and its calls on stand-ins that have what Slicer's documentation
(apidocs.slicer.org, SlicerOpenIGTLink) lists and nothing else: any other call is an AttributeError or a TypeError."""

import json
import math
import os
import subprocess
import sys
import tempfile
import types
import unittest
import zipfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))

from PalpateLib import logic  # noqa: E402
from PalpateLib.nodes import Nodes  # noqa: E402


# --- Stand-ins. Slots keep a misspelled property from being made by its assignment.

class Matrix:
    __slots__ = ("rows",)

    def __init__(self):
        self.rows = [[1.0 if row == column else 0.0 for column in range(4)] for row in range(4)]

    def GetElement(self, row, column):
        return self.rows[row][column]

    def SetElement(self, row, column, value):
        self.rows[row][column] = float(value)


class StringArray:
    __slots__ = ("values",)

    def __init__(self):
        self.values = []

    def InsertNextValue(self, value):
        self.values.append(value)

    def GetNumberOfValues(self):
        return len(self.values)

    def GetValue(self, n):
        return self.values[n]


class Source:
    __slots__ = ("radius",)

    def GetOutputPort(self):
        return self


class SphereSource(Source):
    __slots__ = ()

    def SetRadius(self, radius):
        self.radius = float(radius)


class Node:
    __slots__ = ("kind", "id", "name", "attributes")

    def __init__(self, kind, number):
        self.kind, self.id, self.name, self.attributes = kind, "%s%d" % (kind, number), kind, {}

    def GetID(self):
        return self.id

    def GetName(self):
        return self.name

    def SetName(self, name):
        self.name = name

    def IsA(self, kind):
        return kind in (self.kind, "vtkMRMLNode")

    def GetAttribute(self, name):
        return self.attributes.get(name)


class TextNode(Node):
    __slots__ = ("text",)

    def GetText(self):
        return getattr(self, "text", None)

    def SetText(self, text):
        self.text = text


class StatusNode(Node):
    __slots__ = ("error", "status")

    def GetErrorName(self):
        return self.error

    def GetStatusString(self):
        return self.status


class LinearTransformNode(Node):
    __slots__ = ("matrix",)

    def GetMatrixTransformToParent(self, matrix):
        matrix.rows = [list(row) for row in self.matrix.rows]

    def SetMatrixTransformToParent(self, matrix):
        self.matrix = matrix


class DisplayNode:
    __slots__ = ("color",)

    def SetColor(self, red, green, blue):
        self.color = (red, green, blue)


class ModelNode(Node):
    __slots__ = ("display", "transform")

    def GetDisplayNode(self):
        return self.display

    def SetAndObserveTransformNodeID(self, node_id):
        self.transform = node_id


class Segment:
    __slots__ = ("name",)

    def GetName(self):
        return self.name


class Segmentation:
    __slots__ = ("segments",)

    def GetSegmentIDs(self, ids):
        for key in self.segments:
            ids.InsertNextValue(key)

    def GetSegment(self, key):
        return self.segments[key]


class SegmentationNode(Node):
    __slots__ = ("segmentation",)

    def GetSegmentation(self):
        return self.segmentation


class VolumeNode(Node):
    __slots__ = ("labels",)


class ConnectorNode(Node):
    """What is pushed is kept as it was at that moment: that is what goes over the wire."""

    __slots__ = ("address", "running", "outgoing", "incoming", "sent", "connected")
    StateOff, StateWaitConnection, StateConnected = 0, 1, 2
    # The kinds that the connector has a message for; a label map is none of them.
    SENDS = {"vtkMRMLScalarVolumeNode": "IMAGE", "vtkMRMLTextNode": "STRING", "vtkMRMLMarkupsFiducialNode": "POINT"}

    def __init__(self, kind, number):
        Node.__init__(self, kind, number)
        self.address, self.running, self.outgoing, self.incoming, self.sent, self.connected = None, False, [], [], [], True

    def SetTypeClient(self, host, port):
        self.address = (host, int(port))

    def Start(self):
        self.running = True
        return 1

    def Stop(self):
        self.running = False
        return 1

    def GetState(self):
        return self.StateOff if not self.running else self.StateConnected if self.connected else self.StateWaitConnection

    def GetNumberOfIncomingMRMLNodes(self):
        return len(self.incoming)

    def GetIncomingMRMLNode(self, n):
        return self.incoming[n]

    def RegisterOutgoingMRMLNode(self, node):
        if node.kind not in self.SENDS:
            return 0
        self.outgoing.append(node.GetID())
        return 1

    def UnregisterOutgoingMRMLNode(self, node):
        self.outgoing.remove(node.GetID())

    def PushNode(self, node):
        if node.GetID() not in self.outgoing:
            return 0
        content = node.GetText() if node.kind == "vtkMRMLTextNode" else getattr(node, "labels", None)
        self.sent.append((self.SENDS[node.kind], node.GetName(), content))
        return 1


KINDS = {"vtkMRMLTextNode": TextNode, "vtkMRMLIGTLConnectorNode": ConnectorNode,
         "vtkMRMLLinearTransformNode": LinearTransformNode, "vtkMRMLLabelMapVolumeNode": VolumeNode,
         "vtkMRMLScalarVolumeNode": VolumeNode}


class Scene:
    __slots__ = ("nodes", "number")

    def __init__(self):
        self.nodes, self.number = [], 0

    def AddNewNodeByClass(self, kind, name=""):
        self.number += 1
        node = KINDS[kind](kind, self.number)
        node.SetName(name)
        self.nodes.append(node)
        return node

    def RemoveNode(self, node):
        self.nodes.remove(node)


class ModelsLogic:
    def AddModel(self, port):
        assert isinstance(port, Source)
        model = ModelNode("vtkMRMLModelNode", 0)
        model.display = DisplayNode()
        return model


class SegmentationsLogic:
    def ExportSegmentsToLabelmapNode(self, segmentation, ids, labels, reference=None):
        assert isinstance(ids, StringArray) and labels.kind == "vtkMRMLLabelMapVolumeNode"
        assert reference is None or reference.IsA("vtkMRMLScalarVolumeNode")
        labels.labels = list(ids.values)
        return True


class VolumesLogic:
    def CreateScalarVolumeFromVolume(self, scene, output, source):
        assert output.kind == "vtkMRMLScalarVolumeNode"
        output.labels = source.labels
        return output


class DicomDatabase:
    def fileForInstance(self, uid):
        return {"1.1": "/scans/head/1.dcm", "1.2": "/scans/head/2.dcm", "1.3": "/elsewhere/3.dcm"}.get(uid, "")


def module_with(logic_of_it):
    return types.SimpleNamespace(logic=lambda: logic_of_it)


def stand_ins():
    slicer = types.SimpleNamespace(
        mrmlScene=Scene(), vtkMRMLIGTLConnectorNode=ConnectorNode, dicomDatabase=DicomDatabase(),
        modules=types.SimpleNamespace(models=module_with(ModelsLogic()), segmentations=module_with(SegmentationsLogic()),
                                      volumes=module_with(VolumesLogic())))
    vtk = types.SimpleNamespace(vtkMatrix4x4=Matrix, vtkStringArray=StringArray, vtkArrowSource=Source,
                                vtkSphereSource=SphereSource)
    return slicer, vtk


def transform_at(name, place):
    node = LinearTransformNode("vtkMRMLLinearTransformNode", 0)
    node.SetName(name)
    node.matrix = Matrix()
    for row in range(3):
        node.matrix.SetElement(row, 3, place[row])
    return node


def text_of(name, text):
    node = TextNode("vtkMRMLTextNode", 0)
    node.SetName(name)
    node.SetText(text)
    return node


def status_of(name, text):
    node = StatusNode("vtkMRMLIGTLStatusNode", 0)
    node.SetName("Palpate")
    node.error, node.status = name, text
    return node


def segmentation_of(*names):
    node = SegmentationNode("vtkMRMLSegmentationNode", 0)
    node.segmentation = Segmentation()
    node.segmentation.segments = {}
    for n, name in enumerate(names):
        segment = Segment()
        segment.name = name
        node.segmentation.segments["Segment_%d" % n] = segment
    return node


class LogicTest(unittest.TestCase):
    def test_names_fit_on_the_wire_and_differ(self):
        taken = []
        for name in ("liver", "Leber mit Blutgefäßen links", "Leber mit Blutgefäßen rechts", "肝臓の区域その一と二", "", "liver"):
            taken.append(logic.device_name(name, taken))
            self.assertLessEqual(len(taken[-1].encode("utf-8")), 20)
        self.assertEqual(len(set(taken)), len(taken))
        self.assertEqual(taken[0], "liver")
        self.assertEqual(taken[-1], "liver 2")

    def test_a_scene_is_json_with_modes_and_not_too_long(self):
        self.assertEqual(json.loads(logic.scene_to_send('{"version": 1, "modes": []}')), {"version": 1, "modes": []})
        for text in ("", "{", "[]", '{"version": 1}', '{"modes": [], "name": "%s"}' % (65536 * "x")):
            with self.assertRaises(logic.NotSent):
                logic.scene_to_send(text)

    def test_a_folder_holds_all_files(self):
        self.assertEqual(logic.folder_of(["/a/b/1.dcm", "/a/b/2.dcm"]), "/a/b")
        for files in ([], [""], ["/a/1.dcm", "/b/2.dcm"], ["/a/1.dcm", "/a/b/2.dcm"]):
            with self.assertRaises(logic.NotSent):
                logic.folder_of(files)

    def test_a_contact_is_a_line(self):
        contact = {"boundary": "skin", "force_n": 0.834, "value": 45.2, "unit": "HU", "distances_mm": {"liver": -2.13}}
        self.assertEqual(logic.contact_line(json.dumps(contact)), "skin, 0.83 N, 45 HU; liver 2.1 mm away")
        contact = {"boundary": None, "force_n": 0, "value": None, "distances_mm": {"liver": 1.0, "spleen": None}}
        self.assertEqual(logic.contact_line(json.dumps(contact)), "no contact, 0.00 N; liver 1.0 mm inside")
        for text in ("", "{", "[]", "7"):
            self.assertEqual(logic.contact_line(text), "")

    def test_the_arrow_points_along_the_force(self):
        for force in ([1, 0, 0], [0, 2, 0], [0, 0, -3], [1, 1, 1], [0.1, -0.7, 0.2]):
            rows = logic.arrow_rows([1, 2, 3], force)
            newtons = math.sqrt(sum(f * f for f in force))
            columns = [[rows[row][column] for row in range(3)] for column in range(3)]
            for row in range(3):
                self.assertAlmostEqual(columns[0][row], logic.MM_PER_N * force[row])
            for a, b in ((0, 1), (0, 2), (1, 2)):
                self.assertAlmostEqual(sum(x * y for x, y in zip(columns[a], columns[b])), 0)
            turned = sum(columns[0][n] * (columns[1][(n + 1) % 3] * columns[2][(n + 2) % 3]
                                          - columns[1][(n + 2) % 3] * columns[2][(n + 1) % 3]) for n in range(3))
            self.assertAlmostEqual(turned, (logic.MM_PER_N * newtons) ** 3, msg="not mirrored")
        for force in ([0, 0, 0], [float("nan"), 0, 0], [float("inf"), 0, 0]):
            self.assertLess(logic.arrow_rows([1, 2, 3], force)[0][0], 1e-3)


class NodesTest(unittest.TestCase):
    def setUp(self):
        self.slicer, self.vtk = stand_ins()
        self.nodes = Nodes(self.slicer, self.vtk)
        self.nodes.connect("localhost", 18944)
        self.connector = self.nodes.connector

    def test_it_connects_as_a_client_and_again(self):
        self.assertEqual(self.connector.address, ("localhost", 18944))
        self.assertTrue(self.nodes.is_connected())
        self.nodes.disconnect()
        self.assertFalse(self.nodes.is_connected())
        self.nodes.connect("other", 7)
        self.assertIs(self.nodes.connector, self.connector)
        self.connector.connected = False
        self.assertFalse(self.nodes.is_connected())

    def test_without_the_extension_it_says_what_to_install(self):
        del self.slicer.vtkMRMLIGTLConnectorNode
        with self.assertRaisesRegex(logic.NotSent, "SlicerOpenIGTLink"):
            Nodes(self.slicer, self.vtk).connect("localhost", 18944)

    def test_nothing_is_sent_before_it_is_connected(self):
        self.nodes.disconnect()
        before = list(self.slicer.mrmlScene.nodes)
        with self.assertRaises(logic.NotSent):
            self.nodes.send_text("PalpateScene", "{}")
        self.assertEqual(self.slicer.mrmlScene.nodes, before, "and nothing is left in the scene")

    def test_texts_go_out_under_their_name_once(self):
        self.nodes.send_text("PalpateScene", "{}")
        self.assertEqual(self.connector.sent, [("STRING", "PalpateScene", "{}")])
        self.assertEqual(self.connector.outgoing, [])

    def test_the_folder_of_a_volume_goes_out(self):
        volume = VolumeNode("vtkMRMLScalarVolumeNode", 1)
        volume.attributes["DICOM.instanceUIDs"] = "1.1 1.2"
        self.assertEqual(self.nodes.send_folder_of(volume), "/scans/head")
        self.assertEqual(self.connector.sent, [("STRING", "PalpateFolder", "/scans/head")])
        for uids in ("1.1 1.3", "9.9", None):
            volume.attributes["DICOM.instanceUIDs"] = uids
            with self.assertRaises(logic.NotSent):
                self.nodes.send_folder_of(volume)

    def test_segments_go_out_as_volumes_by_their_names(self):
        reference = VolumeNode("vtkMRMLScalarVolumeNode", 1)
        before = list(self.slicer.mrmlScene.nodes)
        self.assertEqual(self.nodes.send_segments(segmentation_of("liver", "spleen", "liver"), reference),
                         ["liver", "spleen", "liver 2"])
        self.assertEqual(self.connector.sent, [("IMAGE", "liver", ["Segment_0"]), ("IMAGE", "spleen", ["Segment_1"]),
                                               ("IMAGE", "liver 2", ["Segment_2"])])
        self.assertEqual(self.slicer.mrmlScene.nodes, before)
        with self.assertRaises(logic.NotSent):
            self.nodes.send_segments(segmentation_of(), reference)

    def test_marks_go_out_under_palpates_name_and_keep_their_own(self):
        marks = Node("vtkMRMLMarkupsFiducialNode", 1)
        marks.SetName("my points")
        self.nodes.send_marks(marks)
        self.assertEqual(self.connector.sent, [("POINT", "PalpateMarks", None)])
        self.assertEqual(marks.GetName(), "my points")

    def test_what_comes_is_shown(self):
        self.nodes.show()  # nothing has come
        self.assertIsNone(self.nodes.arrow)
        self.connector.incoming = [transform_at("Stylus", (1, 2, 3)), transform_at("Proxy", (4, 5, 6)),
                                   transform_at("Force", (0, 0, 2)), text_of("PalpateContact", "{}"),
                                   status_of("feeling", "Feeling: forces are on")]
        for _ in range(3):
            self.nodes.show()
        self.assertEqual(sorted(self.nodes.shown), ["Proxy", "Stylus"], "each once")
        self.assertEqual(self.nodes.shown["Proxy"].transform, self.connector.incoming[1].GetID())
        rows = self.nodes.arrow.matrix.rows
        self.assertEqual([rows[row][3] for row in range(3)], [4, 5, 6])
        self.assertAlmostEqual(rows[2][0], 20)
        self.assertEqual(self.nodes.text("PalpateContact"), "{}")
        self.assertEqual(self.nodes.status(), ("feeling", "Feeling: forces are on"))
        self.assertEqual(self.nodes.text("PalpateScene"), "")


class ZipTest(unittest.TestCase):
    def test_what_is_unpacked_is_what_slicer_needs(self):
        packer = os.path.join(HERE, "..", "..", "packaging", "slicer_zip.py")
        with tempfile.TemporaryDirectory() as folder:
            packed = [os.path.join(folder, name) for name in ("a.zip", "b.zip")]
            for file in packed:
                subprocess.run([sys.executable, packer, file], check=True)
            with open(packed[0], "rb") as first, open(packed[1], "rb") as second:
                self.assertEqual(first.read(), second.read(), "the same bytes")
            with zipfile.ZipFile(packed[0]) as archive:
                self.assertEqual(sorted(archive.namelist()),
                                 ["slicer-palpate/Palpate.py", "slicer-palpate/PalpateLib/__init__.py",
                                  "slicer-palpate/PalpateLib/logic.py", "slicer-palpate/PalpateLib/nodes.py"])


if __name__ == "__main__":
    unittest.main()
