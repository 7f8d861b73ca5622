"""All calls of Slicer and VTK. The modules are handed in, so that tests can put stand-ins in their place."""

from . import logic

CONNECTOR = "vtkMRMLIGTLConnectorNode"  # of the extension SlicerOpenIGTLink


class Nodes:
    def __init__(self, slicer, vtk):
        self.slicer = slicer
        self.vtk = vtk
        self.scene = slicer.mrmlScene
        self.connector = None
        self.shown = {}  # models, by the transform that moves them
        self.arrow = None  # the transform of the force's arrow

    # --- The connection.

    def connect(self, host, port):
        if not hasattr(self.slicer, CONNECTOR):
            raise logic.NotSent("Install the extension SlicerOpenIGTLink in Slicer's Extensions Manager first.")
        if self.connector is None:
            self.connector = self.scene.AddNewNodeByClass(CONNECTOR, "Palpate")
        self.connector.SetTypeClient(host, port)
        self.connector.Start()

    def disconnect(self):
        if self.connector is not None:
            self.connector.Stop()

    def is_connected(self):
        return self.connector is not None and self.connector.GetState() == self.slicer.vtkMRMLIGTLConnectorNode.StateConnected

    # --- What has come.

    def incoming(self, name, kind):
        """The node that the connector made of a message; None before the first."""
        if self.connector is None:
            return None
        for n in range(self.connector.GetNumberOfIncomingMRMLNodes()):
            node = self.connector.GetIncomingMRMLNode(n)
            if node is not None and node.GetName() == name and node.IsA(kind):
                return node
        return None

    def text(self, name):
        node = self.incoming(name, "vtkMRMLTextNode")
        return node.GetText() or "" if node is not None else ""

    def status(self):
        """Its name and text."""
        node = self.incoming("Palpate", "vtkMRMLIGTLStatusNode")
        return (node.GetErrorName() or "", node.GetStatusString() or "") if node is not None else ("", "")

    def translation(self, name):
        node = self.incoming(name, "vtkMRMLLinearTransformNode")
        if node is None:
            return None
        matrix = self.vtk.vtkMatrix4x4()
        node.GetMatrixTransformToParent(matrix)
        return [matrix.GetElement(row, 3) for row in range(3)]

    # --- What is shown.

    def show(self):
        """Balls for stylus and proxy, as soon as they come; the arrow of the force at the proxy."""
        self._ball("Stylus", 1.5, (1.0, 1.0, 1.0))
        self._ball("Proxy", 2.0, (1.0, 0.85, 0.1))
        position, force = self.translation("Proxy"), self.translation("Force")
        if position is None or force is None:
            return
        if self.arrow is None:
            self.arrow = self.scene.AddNewNodeByClass("vtkMRMLLinearTransformNode", "Palpate force")
            source = self.vtk.vtkArrowSource()
            self._model(source, "Palpate force arrow", (0.1, 0.45, 1.0), self.arrow)
        matrix = self.vtk.vtkMatrix4x4()
        for row, numbers in enumerate(logic.arrow_rows(position, force)):
            for column, number in enumerate(numbers):
                matrix.SetElement(row, column, number)
        self.arrow.SetMatrixTransformToParent(matrix)

    def _ball(self, name, radius, color):
        transform = self.incoming(name, "vtkMRMLLinearTransformNode")
        if transform is None or name in self.shown:
            return
        source = self.vtk.vtkSphereSource()
        source.SetRadius(radius)
        self.shown[name] = self._model(source, "Palpate " + name.lower(), color, transform)

    def _model(self, source, name, color, transform):
        model = self.slicer.modules.models.logic().AddModel(source.GetOutputPort())
        model.SetName(name)
        model.GetDisplayNode().SetColor(*color)
        model.SetAndObserveTransformNodeID(transform.GetID())
        return model

    # --- What is sent.

    def _push(self, node):
        """Once: a node that stays registered would be sent at every change, also those that come from Palpate."""
        if not self.is_connected():
            raise logic.NotSent("Connect to Palpate first.")
        self.connector.RegisterOutgoingMRMLNode(node)
        self.connector.PushNode(node)
        self.connector.UnregisterOutgoingMRMLNode(node)

    def send_text(self, device, text):
        node = self.scene.AddNewNodeByClass("vtkMRMLTextNode", "Palpate outgoing")
        try:
            node.SetName(device)
            node.SetText(text)
            self._push(node)
        finally:
            self.scene.RemoveNode(node)

    def send_folder_of(self, volume):
        """The folder of the DICOM files that the volume was loaded from."""
        uids = (volume.GetAttribute("DICOM.instanceUIDs") or "").split()
        folder = logic.folder_of([self.slicer.dicomDatabase.fileForInstance(uid) for uid in uids])
        self.send_text("PalpateFolder", folder)
        return folder

    def send_marks(self, markups):
        """Under the name that Palpate knows marks by; the node keeps its own."""
        name = markups.GetName()
        try:
            markups.SetName("PalpateMarks")
            self._push(markups)
        finally:
            markups.SetName(name)

    def send_segments(self, segmentation, reference):
        """Each segment as an image of its own, named after it. The connector sends volumes and no label maps, so it
        becomes a volume. Returns the names."""
        names = []
        ids = self.vtk.vtkStringArray()
        segmentation.GetSegmentation().GetSegmentIDs(ids)
        for n in range(ids.GetNumberOfValues()):
            segment = segmentation.GetSegmentation().GetSegment(ids.GetValue(n))
            name = logic.device_name(segment.GetName(), names)
            one = self.vtk.vtkStringArray()
            one.InsertNextValue(ids.GetValue(n))
            labels = self.scene.AddNewNodeByClass("vtkMRMLLabelMapVolumeNode", "Palpate outgoing labels")
            volume = self.scene.AddNewNodeByClass("vtkMRMLScalarVolumeNode", "Palpate outgoing volume")
            try:
                self.slicer.modules.segmentations.logic().ExportSegmentsToLabelmapNode(segmentation, one, labels, reference)
                self.slicer.modules.volumes.logic().CreateScalarVolumeFromVolume(self.scene, volume, labels)
                volume.SetName(name)
                self._push(volume)
            finally:
                self.scene.RemoveNode(labels)
                self.scene.RemoveNode(volume)
            names.append(name)
        if not names:
            raise logic.NotSent("This segmentation has no segments.")
        return names
