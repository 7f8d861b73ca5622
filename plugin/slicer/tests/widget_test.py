"""The module's panel on stand-ins of Qt, CTK and Slicer's widgets: it is built, and each button does what it says or says
why it cannot."""

import sys
import types
import unittest

import stand_ins as rig  # puts the module's folder on the path


class Widget:
    """Only what Qt's documentation lists: properties in slots, signals by their signatures."""

    __slots__ = ("text", "toolTip", "maximum", "value", "slots")
    SIGNALS = ("clicked()", "timeout()")

    def __init__(self, text=""):
        self.text, self.slots = text, {}

    def connect(self, signal, slot):
        assert signal in self.SIGNALS, signal
        self.slots[signal] = slot


class Timer(Widget):
    __slots__ = ("interval", "running")

    def setInterval(self, ms):
        self.interval = ms

    def start(self):
        self.running = True

    def stop(self):
        self.running = False


class PlainTextEdit:
    __slots__ = ("plain",)

    def __init__(self):
        self.plain = ""

    def setPlainText(self, text):
        self.plain = text

    def toPlainText(self):
        return self.plain


class Layout:
    buttons = {}
    __slots__ = ()

    def __init__(self, box=None):
        pass

    def addWidget(self, widget):
        pass

    def addRow(self, *row):
        for item in row:
            if isinstance(item, Widget) and "clicked()" in item.slots:
                self.buttons[item.text] = item


class NodeComboBox:
    __slots__ = ("nodeTypes", "addEnabled", "noneEnabled", "node")

    def __init__(self):
        self.node = None

    def setMRMLScene(self, scene):
        pass

    def currentNode(self):
        return self.node


class LoadableModule:
    def __init__(self, parent):
        self.parent = parent


class LoadableModuleWidget:
    def __init__(self, parent=None):
        self.layout = Layout()

    def setup(self):
        pass


class WidgetTest(unittest.TestCase):
    def setUp(self):
        slicer, vtk = rig.stand_ins()
        slicer.qMRMLNodeComboBox = NodeComboBox
        scripted = types.ModuleType("slicer.ScriptedLoadableModule")
        scripted.ScriptedLoadableModule, scripted.ScriptedLoadableModuleWidget = LoadableModule, LoadableModuleWidget
        package = types.ModuleType("slicer")
        package.__dict__.update(vars(slicer))
        package.__path__ = []
        qt = types.SimpleNamespace(QTimer=Timer, QFormLayout=Layout, QPushButton=Widget, QLineEdit=Widget, QSpinBox=Widget,
                                   QLabel=Widget, QPlainTextEdit=PlainTextEdit)
        sys.modules.update({"slicer": package, "slicer.ScriptedLoadableModule": scripted, "vtk": vtk, "qt": qt,
                            "ctk": types.SimpleNamespace(ctkCollapsibleButton=Widget)})
        sys.modules.pop("Palpate", None)
        import Palpate
        Layout.buttons.clear()
        self.module = Palpate
        self.panel = Palpate.PalpateWidget()
        self.panel.setup()

    def press(self, text):
        Layout.buttons[text].slots["clicked()"]()
        return self.panel.said.text

    def test_it_describes_itself(self):
        parent = types.SimpleNamespace()
        self.module.Palpate(parent)
        self.assertEqual(parent.title, "Palpate")
        self.assertTrue(parent.helpText)

    def test_each_button_without_a_connection_says_why_not(self):
        self.assertEqual(self.press("Feel this volume"), "Choose a volume first.")
        self.assertEqual(self.press("Feel these segments"), "Choose a segmentation first.")
        self.assertEqual(self.press("Send these marks"), "Choose a list of points first.")
        self.assertIn("not JSON", self.press("Send the scene"))
        self.panel.scene_text.setPlainText('{"modes": []}')
        self.assertEqual(self.press("Send the scene"), "Connect to Palpate first.")
        self.panel.look()
        self.assertEqual(self.panel.state.text, "Not connected")

    def test_each_button_sends(self):
        self.assertEqual(self.press("Connect"), "")
        connector = self.panel.nodes.connector
        self.assertEqual(connector.address, ("localhost", 18944))
        self.panel.volume.node = rig.VolumeNode("vtkMRMLScalarVolumeNode", 1)
        self.panel.volume.node.attributes["DICOM.instanceUIDs"] = "1.1 1.2"
        self.panel.segmentation.node = rig.segmentation_of("liver")
        self.panel.marks.node = rig.Node("vtkMRMLMarkupsFiducialNode", 1)
        connector.incoming = [rig.text_of("PalpateScene", '{"modes": []}'),
                              rig.text_of("PalpateContact", '{"boundary": "skin", "force_n": 1}'),
                              rig.status_of("feeling", "Feeling: forces are on")]
        self.panel.look()
        self.assertEqual((self.panel.state.text, self.panel.contact.text), ("Feeling: forces are on", "skin, 1.00 N"))
        for button in ("Feel this volume", "Feel these segments", "Send these marks", "Fetch the scene", "Send the scene"):
            self.assertEqual(self.press(button), "")
        self.assertEqual([(kind, name) for kind, name, _ in connector.sent],
                         [("STRING", "PalpateFolder"), ("IMAGE", "liver"), ("POINT", "PalpateMarks"),
                          ("STRING", "PalpateScene")])
        self.press("Disconnect")
        self.panel.cleanup()
        self.assertFalse(self.panel.timer.running)


if __name__ == "__main__":
    unittest.main()
