"""The module in Slicer, without Slicer: its logic alone, and its calls on stand-ins."""

import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
import zipfile

from stand_ins import HERE, Node, VolumeNode, segmentation_of, stand_ins, status_of, text_of, transform_at  # puts the module's folder on the path

from PalpateLib import logic  # noqa: E402
from PalpateLib.nodes import Nodes  # noqa: E402


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
