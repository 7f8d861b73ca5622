"""Palpate beside 3D Slicer: shows what a stylus feels in `palpate serve`, and sends scenes, folders, marks and segments.

Needs the extension SlicerOpenIGTLink. Research software, not a medical device. Nothing here turns a force on.
"""

import ctk
import qt
import slicer
import vtk
from slicer.ScriptedLoadableModule import ScriptedLoadableModule, ScriptedLoadableModuleWidget

from PalpateLib import logic
from PalpateLib.nodes import Nodes

LOOK_MS = 50


class Palpate(ScriptedLoadableModule):
    def __init__(self, parent):
        ScriptedLoadableModule.__init__(self, parent)
        parent.title = "Palpate"
        parent.categories = ["IGT"]
        parent.dependencies = []
        parent.contributors = ["The authors of Palpate"]
        parent.helpText = "Feel a CT or MR scan with a haptic stylus in the program palpate, and see it here."
        parent.acknowledgementText = "Method: K. L. Palmerius, Fast and High Precision Volume Haptics, 2007."


class PalpateWidget(ScriptedLoadableModuleWidget):
    def setup(self):
        ScriptedLoadableModuleWidget.setup(self)
        self.nodes = Nodes(slicer, vtk)
        self._build_connection()
        self._build_sending()
        self.timer = qt.QTimer()
        self.timer.setInterval(LOOK_MS)
        self.timer.connect("timeout()", self.look)
        self.timer.start()

    def cleanup(self):
        self.timer.stop()
        self.nodes.disconnect()

    def _form(self, title):
        box = ctk.ctkCollapsibleButton()
        box.text = title
        self.layout.addWidget(box)
        return qt.QFormLayout(box)

    def _button(self, form, text, tip, act):
        button = qt.QPushButton(text)
        button.toolTip = tip
        button.connect("clicked()", lambda: self.do(act))
        form.addRow(button)
        return button

    def _chooser(self, form, label, kind):
        chooser = slicer.qMRMLNodeComboBox()
        chooser.nodeTypes = [kind]
        chooser.addEnabled = False
        chooser.noneEnabled = True
        chooser.setMRMLScene(slicer.mrmlScene)
        form.addRow(label, chooser)
        return chooser

    def _build_connection(self):
        form = self._form("Connection")
        self.host = qt.QLineEdit("localhost")
        form.addRow("Host", self.host)
        self.port = qt.QSpinBox()
        self.port.maximum = 65535
        self.port.value = 18944
        form.addRow("Port", self.port)
        self._button(form, "Connect", "to a running `palpate serve`",
                     lambda: self.nodes.connect(self.host.text, self.port.value))
        self._button(form, "Disconnect", "Palpate goes on", self.nodes.disconnect)
        self.state, self.contact, self.said = qt.QLabel(""), qt.QLabel(""), qt.QLabel("")
        form.addRow("State", self.state)
        form.addRow("Contact", self.contact)
        form.addRow(self.said)

    def _build_sending(self):
        form = self._form("To Palpate")
        self.volume = self._chooser(form, "Volume", "vtkMRMLScalarVolumeNode")
        self._button(form, "Feel this volume", "its DICOM folder, which Palpate has to see under the same path",
                     lambda: self.nodes.send_folder_of(self._chosen(self.volume, "volume")))
        self.segmentation = self._chooser(form, "Segmentation", "vtkMRMLSegmentationNode")
        self._button(form, "Feel these segments", "each becomes a structure with a boundary",
                     lambda: self.nodes.send_segments(self._chosen(self.segmentation, "segmentation"),
                                                      self._chosen(self.volume, "volume")))
        self.marks = self._chooser(form, "Marks", "vtkMRMLMarkupsFiducialNode")
        self._button(form, "Send these marks", "they are added to Palpate's; one of the same name is moved",
                     lambda: self.nodes.send_marks(self._chosen(self.marks, "list of points")))
        self.scene_text = qt.QPlainTextEdit()
        form.addRow("Scene", self.scene_text)
        self._button(form, "Fetch the scene", "as it is felt",
                     lambda: self.scene_text.setPlainText(self.nodes.text("PalpateScene")))
        self._button(form, "Send the scene", "it is felt along the ramp; limits cannot be raised",
                     lambda: self.nodes.send_text("PalpateScene", logic.scene_to_send(self.scene_text.toPlainText())))

    def _chosen(self, chooser, what):
        node = chooser.currentNode()
        if node is None:
            raise logic.NotSent("Choose a %s first." % what)
        return node

    def do(self, act):
        """What a button does; why it was not done is said below the contact."""
        try:
            act()
            self.said.text = ""
        except logic.NotSent as why:
            self.said.text = str(why)

    def look(self):
        """Called by the timer: what has come is shown."""
        if not self.nodes.is_connected():
            self.state.text = "Not connected"
            return
        self.state.text = logic.status_line(*self.nodes.status())
        self.contact.text = logic.contact_line(self.nodes.text("PalpateContact"))
        self.nodes.show()
