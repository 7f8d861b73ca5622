"""ParaView with the panel, on a virtual display, driven by the test plug-in: each scenario in a program of its own.

Arguments as in panel_program.py; main_thread, first_image, the_volume_turns and memory_of_a_scan, which are measurements, can be asked for. PALPATE_FOLDER: another scan.
"""

import math
import os
import shutil
import subprocess

from made_segmentation import is_in_cut_ball, voxels, write_segmentation
from mixed_folder import mixed_folder, set_headers
from panel_program import HEAD, PROGRAMS, SCRATCH, ball, main, phantom, real_head, run, scratch
from voxel_ball import write_nifti, write_nrrd


def both():
    """Two series in a folder."""
    folder = phantom("two", "sphere", "--radius", "25")
    shutil.move(phantom("second", "sphere", "--radius", "18"), os.path.join(folder, "second"))
    return folder


def bad():
    folder = os.path.join(SCRATCH, "panel-bad")
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "letter.txt"), "w") as file:
        file.write("This is no scan.")
    return folder


def flow():
    """A 4D-flow study: magnitude, three velocities, and what they are together."""
    folder = scratch("panel-flow")
    shutil.rmtree(folder, ignore_errors=True)
    subprocess.run([os.path.join(PROGRAMS, "palpate-testdata"), "flow", "-o", folder], check=True)
    return folder


def numbered(name, *arguments):
    """The ball with the scanner's image numbers the other way round; and where its image 1 lies."""
    folder = phantom(name, "sphere", "--radius", "25", *arguments)
    files = sorted(os.listdir(folder))
    for n, file in enumerate(files):
        subprocess.run(["dcmodify", "-nb", "-m", f"(0020,0013)={len(files) - n}", os.path.join(folder, file)], check=True)
    for file in files:
        dump = subprocess.run(["dcmdump", "+P", "0020,0013", "+P", "0020,0032", os.path.join(folder, file)], check=True,
                              capture_output=True, text=True).stdout
        values = [line.split("[")[1].split("]")[0].strip() for line in dump.splitlines() if "[" in line]
        if values[0] == "1":
            os.environ["PALPATE_FIRST_H"] = values[1].split("\\")[2]
    return folder


def named():
    """A ball of somebody, with slices twice as far apart as they are thick; what its files say goes to the scenario."""
    folder = phantom("named", "sphere", "--radius", "25", "--spacing", "0.8,0.8,2", "--size", "96,96,40")
    files = [os.path.join(folder, file) for file in sorted(os.listdir(folder))]
    tags = {"0010,0010": "DOE^JANE ANN", "0010,0020": "4711", "0008,0020": "20190312", "0008,103e": "Neck thin",
            "0020,0011": "7", "0018,0050": "1"}
    modified = [word for tag, value in tags.items() for word in ("-m", f"({tag})={value}")]
    subprocess.run(["dcmodify", "-nb", *modified, *files], check=True)
    heights = {}
    for file in files:
        dump = subprocess.run(["dcmdump", "+P", "0020,0013", "+P", "0020,0032", file], check=True, capture_output=True,
                              text=True).stdout
        values = [line.split("[")[1].split("]")[0].strip() for line in dump.splitlines() if "[" in line]
        heights[int(values[0])] = float(values[1].split("\\")[2])
    os.environ["PALPATE_HEIGHTS"] = " ".join(str(heights[n]) for n in sorted(heights))  # of image 1, 2, ...
    return folder


def on_a_table():
    """A ball, and behind it a table of 4 mm: drawn into the pixels, the last bytes of an uncompressed file."""
    folder = phantom("table", "sphere", "--radius", "25", "--spacing", "1,1,1", "--size", "120,120,60")
    for file in os.listdir(folder):
        path = os.path.join(folder, file)
        dump = subprocess.run(["dcmdump", "+P", "0028,1052", "+P", "0028,1053", path], check=True, capture_output=True,
                              text=True).stdout
        intercept, slope = (float(line.split("[")[1].split("]")[0]) for line in dump.splitlines() if "[" in line)
        with open(path, "rb") as scan:
            content = bytearray(scan.read())
        table = int((150 - intercept) / slope).to_bytes(2, "little", signed=True)
        pixels = len(content) - 2 * 120 * 120
        for row in range(100, 104):
            begin = pixels + 2 * 120 * row
            content[begin:begin + 240] = table * 120
        with open(path, "wb") as scan:
            scan.write(content)
    return folder


def chest():
    folder = phantom("chest", "sphere", "--radius", "25")
    for file in os.listdir(folder):
        subprocess.run(["dcmodify", "-nb", "-i", "0018,0015=CHEST", os.path.join(folder, file)], check=True)
    return folder


def six():
    """Six series in a folder."""
    folder = phantom("six", "sphere", "--radius", "25")
    for n in range(5):
        shutil.move(phantom(f"more-{n}", "sphere", "--radius", str(10 + n)), os.path.join(folder, f"more-{n}"))
    return folder


def outlined():
    """A scan and a segmentation in one folder; and beside it one of another patient, and a label map elsewhere."""
    folder = ball()
    write_segmentation(os.path.join(folder, "liver.dcm"), folder)
    other = set_headers(phantom("foreign", "slab"), PatientName="OTHER", PatientID="OTHER", FrameOfReferenceUID="1.2.826.0.1.3680043.10.8.3")
    os.environ["PALPATE_FOREIGN"] = write_segmentation(scratch("foreign.dcm"), other, 2)
    os.environ["PALPATE_OFF"] = scratch("off.mha")
    with open(scratch("off.mha"), "wb") as file:
        file.write(b"NDims = 3\nDimSize = 4 4 4\nElementType = MET_UCHAR\nOffset = 5000 0 0\nElementDataFile = LOCAL\n" +
                   b"\1" * 64)
    os.environ["PALPATE_LIVER"] = f"{voxels() / 1000:.0f} ml"
    return folder


def spoilt():
    """A ball, and a segmentation of it whose cap in front was cut off."""
    folder = ball()
    write_segmentation(os.path.join(folder, "liver.dcm"), folder, is_in=is_in_cut_ball)
    os.environ["PALPATE_CORRECTED"] = scratch("corrected.dcm")
    return folder


def spoilt_in_frames():
    """The same ball at two times, the second smaller, in one series."""
    folder = phantom("frames", "sphere", "--radius", "25")
    set_headers(folder, TemporalPositionIdentifier="1")
    later = set_headers(phantom("later", "sphere", "--radius", "23"), TemporalPositionIdentifier="2")
    subprocess.run(["dcmodify", "-nb", "-gin", *(os.path.join(later, file) for file in os.listdir(later))], check=True)
    first = os.path.join(folder, os.listdir(folder)[0])
    of_both = {"0020,000d": "StudyInstanceUID", "0020,000e": "SeriesInstanceUID", "0020,0052": "FrameOfReferenceUID"}
    for tag, key in of_both.items():
        dump = subprocess.run(["dcmdump", "+P", tag, first], check=True, capture_output=True, text=True).stdout
        set_headers(later, **{key: dump.split("[")[1].split("]")[0]})
    for file in os.listdir(later):
        shutil.move(os.path.join(later, file), os.path.join(folder, "later_" + file))
    write_segmentation(os.path.join(folder, "liver.dcm"), folder, is_in=is_in_cut_ball)
    return folder


def without_an_edge():
    """A ball, and a segmentation of its middle, whose surface lies in one tissue."""
    folder = ball()
    write_segmentation(os.path.join(folder, "liver.dcm"), folder, is_in=lambda *at: math.dist(at, (0, 0, 0)) < 12)
    return folder


def spoilt_beside_a_vessel():
    """The same, and a small ball in front of the cap."""
    folder = spoilt()
    write_segmentation(os.path.join(folder, "vessel.dcm"), folder, 3, lambda *at: math.dist(at, (0, -30, 0)) < 3, "Vessel")
    return folder


FOLDERS = {
    "slices_are_scrolled": lambda: numbered("numbered"),
    "slices_are_scrolled_upside_down": lambda: numbered("upside-down", "--orientation", "1,0,0,0,-1,0"),
    "a_filter_is_felt_and_shown": lambda: phantom("noisy", "sphere", "--radius", "25", "--noise", "80"),
    "frames_are_felt_as_shown": flow,
    "a_flow_is_shown_and_felt": flow,
    "a_flow_is_drawn_as_a_volume": flow,
    "one_tab_is_used_again": both,
    "a_look_is_of_its_scan": both,
    # So fine that its lines take longer than the next picture.
    "lines_are_of_the_slice_that_is_shown": lambda: phantom("fine", "sphere", "--radius", "25", "--size", "256,256,48",
                                                           "--spacing", "0.3,0.3,1"),
    "undo_belongs_to_a_scan": both,
    "another_scan_is_asked_about": both,
    "a_scan_is_overtaken": both,
    "no_scan_shown_no_force": both,
    "a_deleted_scan_comes_back": both,
    "the_scan_changes_in_mid_contact": both,
    "a_series_is_picked": mixed_folder,
    "a_bad_folder": bad,
    "structures_are_seen_and_felt": outlined,
    "an_outline_is_corrected": spoilt,
    "an_outline_is_traced_by_touch": spoilt,
    "a_ball_is_added": spoilt,
    "a_felt_trace_stays_in_its_slice": spoilt,
    "an_outline_is_traced_over_its_surface": spoilt,
    "an_outline_without_an_edge_stays": without_an_edge,
    "margins_are_told": spoilt_beside_a_vessel,
    "a_press_is_of_what_was_chosen": spoilt_beside_a_vessel,
    "nothing_moves_under_the_pointer": outlined,
    "marks_belong_to_a_scan": both,
    "slices_are_read_and_measured": named,
    "the_table_is_cut_away": on_a_table,
    "a_scene_shows_what_it_does": lambda: phantom("wedge", "wedge"),
    "scenes_are_offered_by_the_part": chest,
    "a_picture_at_rest_comes_in_turns": lambda: phantom("large", "sphere", "--radius", "25", "--size", "256,256,256",
                                                        "--spacing", "0.3,0.3,0.3"),
}
SCENARIOS = [
    "the_layout_is_clinical",
    "the_panel_fits_the_screen",
    "the_panel_speaks_german",
    "one_tab_is_used_again",
    "nothing_moves_under_the_pointer",
    "no_text_is_cut_off",
    "the_notice_is_legible",
    "a_menu_names_one_thing",
    "a_missing_folder_is_told_in_the_panel",
    "ones_way_is_found",
    "slices_are_read_and_measured",
    "the_table_is_cut_away",
    "the_volume_is_drawn_seldom",
    "a_closed_scan_is_not_held",
    "a_volume_without_hu_is_drawn",
    "the_volume_lies_in_the_patient",
    "surfaces_are_seen_where_they_are_felt",
    "a_picture_at_rest_comes_in_turns",
    "a_scene_shows_what_it_does",
    "small_things_are_right",
    "series_are_listed_in_full",
    "scenes_are_offered_by_the_part",
    "a_refusal_stands_beside_its_button",
    "words_for_developers_stand_under_technical",
    "a_chosen_look_stays",
    "boundaries_are_drawn_where_they_are_felt",
    "boundaries_are_seen_on_every_slice",
    "lines_are_of_the_slice_that_is_shown",
    "the_place_under_a_dragged_handle_is_told",
    "a_look_is_of_its_scan",
    "a_look_comes_back_with_its_state",
    "four_clicks",
    "letting_go",
    "nothing_moves",
    "escape_releases",
    "escape_releases_under_a_dialog",
    "a_tissue_is_switched",
    "a_curve_is_edited_and_undone",
    "a_fault_is_cleared",
    "the_view_is_clutched",
    "the_scan_changes_in_mid_contact",
    "a_series_is_picked",
    "a_bad_folder",
    "what_is_to_be_known_is_said",
    "what_is_shared_is_what_is_felt",
    "a_color_is_chosen",
    "a_color_for_a_boundary_that_went",
    "what_keeps_the_scene_is_deleted",
    "keys_step_in_the_views",
    "a_dragged_node_is_felt",
    "profile_follows_an_edit",
    "a_curve_shows_its_force",
    "a_touched_boundary_shows_its_force",
    "recordings_are_replayed_and_compared",
    "a_recording_is_of_its_frame",
    "no_scan_shown_no_force",
    "a_deleted_scan_comes_back",
    "what_was_deleted_is_not_in_the_state",
    "a_folder_without_a_scan_takes_nothing_away",
    "a_scan_is_overtaken",
    "a_reset_session_has_no_force",
    "a_loaded_state_has_no_force",
    "undo_belongs_to_a_scan",
    "another_scan_is_asked_about",
    "the_end_is_asked_about",
    "a_session_that_ends_is_kept",
    "a_filter_is_felt_and_shown",
    "frames_are_felt_as_shown",
    "a_scene_without_its_field_is_refused",
    "a_flow_is_shown_and_felt",
    "a_flow_is_drawn_as_a_volume",
    "surfaces_are_of_the_frame_that_is_shown",
    "the_hand_begins_in_sight",
    "keys_go_to_the_marked_view",
    "slices_are_scrolled",
    "slices_follow_the_pointer",
    "slices_are_scrolled_upside_down",
    "structures_are_seen_and_felt",
    "a_press_is_of_what_was_chosen",
    "an_outline_is_corrected",
    "an_outline_is_traced_by_touch",
    "a_ball_is_added",
    "a_felt_trace_stays_in_its_slice",
    "an_outline_is_traced_over_its_surface",
    "an_outline_without_an_edge_stays",
    "a_drawn_structure_is_corrected",
    "margins_are_told",
    "an_outline_is_corrected_on_a_frame",
    "a_correction_is_saved",
    "marks_are_where_the_stylus_was",
    "marks_are_measured_and_changed",
    "marks_belong_to_a_scan",
    "marks_are_saved",
    "styluses_come_and_go",
    "a_lost_stylus_comes_back",
    "other_files_are_opened_and_felt",
    "buttons_of_the_stylus",
    "a_short_press_counts",
    "the_guardian_takes_the_force",
    "closed_in_mid_contact",
]


def shared():
    reader = os.path.join(os.path.dirname(os.path.abspath(__file__)), "igtl_reader.py")
    return run("what_is_shared_is_what_is_felt", ball(), PALPATE_IGTL_READER=reader)


def told_of_its_scan():
    return run("what_is_to_be_known_is_said", PALPATE_DROP=phantom("uneven", "sphere", "--tilt", "12", "--uneven", "0.4"))


def on_its_folder(scenario):
    folder = os.environ.get("PALPATE_FOLDER") or FOLDERS.get(scenario, ball)()
    return run(scenario, folder)


def layout():
    folder = phantom("wedge", "wedge")
    return run("the_layout_is_clinical", folder) and run("advanced_is_remembered", folder, first=False)


def fits():
    """A small laptop's screen, a common one, and one with two pixels to a point that is as large as the first."""
    return all([run("the_panel_fits_the_screen", ball(), screen=screen, QT_SCALE_FACTOR=scale, PALPATE_POINTS=points)
                for screen, scale, points in (("1366x768", "1", "1366x768"), ("1920x1080", "1", "1920x1080"),
                                              ("2732x1536", "2", "1366x768"))])


def other_files():
    return run("other_files_are_opened_and_felt", PALPATE_NIFTI=write_nifti(scratch("ball.nii.gz")),
               PALPATE_NRRD=write_nrrd(scratch("ball.nrrd")))


def german():
    def english(home):
        with open(os.path.join(home, ".config", "ParaView", "ParaView.conf"), "w") as settings:
            settings.write("[palpate]\nlanguage=en\n")

    there = dict(LC_ALL="de_DE.UTF-8", LANGUAGE="")
    return (run("the_panel_speaks_german", ball(), **there) and
            run("the_setting_says_english", ball(), prepare=english, **there))


def not_cut_off():
    """English words, and German ones, which are longer; a real head has many boundaries, and long names, where it is installed."""
    folders = {"C.UTF-8": real_head() if os.path.exists(HEAD) else chest(), "de_DE.UTF-8": chest()}
    return all([run("no_text_is_cut_off", folder, LC_ALL=language, LANGUAGE="") for language, folder in folders.items()])


def marks_last():
    return (run("marks_are_saved", ball()) and run("marks_are_restored", arguments=["--state=" + scratch("marks.pvsm")]) and
            run("marks_are_loaded", phantom("other", "slab")))


def correction_last():
    return (run("a_correction_is_saved", spoilt()) and
            run("a_correction_is_restored", arguments=["--state=" + scratch("correct.pvsm")]) and
            run("a_correction_is_loaded", phantom("other", "slab")))


# Only by name: measurements.
BY_NAME = ["main_thread", "first_image", "the_volume_turns", "memory_of_a_scan"]
TESTS = {name: lambda name=name: on_its_folder(name) for name in SCENARIOS + BY_NAME}
TESTS["the_layout_is_clinical"] = layout
TESTS["the_panel_speaks_german"] = german
TESTS["the_panel_fits_the_screen"] = fits
TESTS["no_text_is_cut_off"] = not_cut_off
TESTS["a_folder_without_a_scan_takes_nothing_away"] = lambda: run(
    "a_folder_without_a_scan_takes_nothing_away", ball(), PALPATE_DROP=bad())
TESTS["a_missing_folder_is_told_in_the_panel"] = lambda: run("a_missing_folder_is_told_in_the_panel")
TESTS["marks_are_saved"] = marks_last
TESTS["a_correction_is_saved"] = correction_last
TESTS["what_is_to_be_known_is_said"] = told_of_its_scan
TESTS["what_is_shared_is_what_is_felt"] = shared
for dropped in ("first_image", "the_volume_turns", "memory_of_a_scan"):
    TESTS[dropped] = lambda name=dropped: run(name, PALPATE_DROP=os.environ.get("PALPATE_FOLDER") or ball())
TESTS["series_are_listed_in_full"] = lambda: run("series_are_listed_in_full", PALPATE_DROP=six())
TESTS["the_volume_is_drawn_seldom"] = lambda: run("the_volume_is_drawn_seldom", PALPATE_DROP=on_a_table())
TESTS["the_volume_lies_in_the_patient"] = lambda: run("the_volume_lies_in_the_patient", PALPATE_DROP=phantom(
    "oblique", "sphere", "--radius", "25", "--orientation", "0.6", "0.8", "0", "-0.64", "0.48", "0.6"))
TESTS["a_volume_without_hu_is_drawn"] = lambda: run("a_volume_without_hu_is_drawn", PALPATE_DROP=write_nifti(scratch("ball.nii.gz")))
TESTS["a_closed_scan_is_not_held"] = lambda: run("a_closed_scan_is_not_held", ball(), PALPATE_DROP=phantom(
    "closed", "sphere", "--radius", "25", "--size", "256,256,256", "--spacing", "0.3,0.3,0.3"))
TESTS["other_files_are_opened_and_felt"] = other_files
for framed in ("an_outline_is_corrected_on_a_frame", "surfaces_are_of_the_frame_that_is_shown", "a_recording_is_of_its_frame"):
    TESTS[framed] = lambda name=framed: run(name, PALPATE_DROP=spoilt_in_frames())
TESTS["what_was_deleted_is_not_in_the_state"] = lambda: run(
    "what_was_deleted_is_not_in_the_state", outlined(), PALPATE_OTHER=phantom("other", "slab"))
main({name: TESTS[name] for name in SCENARIOS}, {name: TESTS[name] for name in BY_NAME})
