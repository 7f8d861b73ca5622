"""Stand-ins of Slicer: they have what Slicer's documentation (apidocs.slicer.org, SlicerOpenIGTLink) lists and nothing
else: any other call is an AttributeError or a TypeError. Slots keep a misspelled property from being made by its
assignment."""

import os
import sys
import types

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.dirname(HERE))  # the module's folder

from PalpateLib.nodes import Nodes  # noqa: E402


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
