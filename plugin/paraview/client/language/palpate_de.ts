<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1" language="de_DE" sourcelanguage="en">
<context>
    <name>ArchiveSearch</name>
    <message>
        <source>Patient</source>
        <translation>Patient</translation>
    </message>
    <message>
        <source>Part of the name, family name first</source>
        <translation>Teil des Namens, Nachname zuerst</translation>
    </message>
    <message>
        <source>Patient&apos;s id</source>
        <translation>Patienten-ID</translation>
    </message>
    <message>
        <source>The whole id; * stands for anything</source>
        <translation>Die ganze ID; * steht für Beliebiges</translation>
    </message>
    <message>
        <source>Description</source>
        <translation>Beschreibung</translation>
    </message>
    <message>
        <source>Part of the study&apos;s description</source>
        <translation>Teil der Studienbeschreibung</translation>
    </message>
    <message>
        <source>Date</source>
        <translation>Datum</translation>
    </message>
    <message>
        <source>Of the study: 2026, 2026-01, 2026-01-04, or a span 20260101-20260131</source>
        <translation>Der Studie: 2026, 2026-01, 2026-01-04 oder ein Zeitraum 20260101-20260131</translation>
    </message>
    <message>
        <source>All</source>
        <translation>Alle</translation>
    </message>
    <message>
        <source>Modality</source>
        <translation>Modalität</translation>
    </message>
</context>
<context>
    <name>ArchiveTab</name>
    <message>
        <source>Date</source>
        <translation>Datum</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Keep</source>
        <translation>Behalten</translation>
    </message>
    <message>
        <source>Waiting for %1</source>
        <translation>Warten auf %1</translation>
    </message>
    <message>
        <source>%1 of %2 images, %3 MiB</source>
        <translation>%1 von %2 Bildern, %3 MiB</translation>
    </message>
    <message>
        <source>%1 images, %2 MiB</source>
        <translation>%1 Bilder, %2 MiB</translation>
    </message>
    <message>
        <source>On disk: %1 series, %2 MiB</source>
        <translation>Auf der Platte: %1 Serien, %2 MiB</translation>
    </message>
    <message>
        <source>The archives that were entered here or with `palpate archive add`</source>
        <translation>Die Archive, die hier oder mit `palpate archive add` eingetragen wurden</translation>
    </message>
    <message>
        <source>Echo</source>
        <translation>Prüfen</translation>
    </message>
    <message>
        <source>Tests whether the archive answers and accepts our AE title (C-ECHO)</source>
        <translation>Ob das Archiv antwortet und uns kennt (C-ECHO)</translation>
    </message>
    <message>
        <source>Add…</source>
        <translation>Eintragen…</translation>
    </message>
    <message>
        <source>Adds an archive, or changes the settings of the archive with that name</source>
        <translation>Trägt ein Archiv ein oder ändert das mit diesem Namen</translation>
    </message>
    <message>
        <source>Fetch and open</source>
        <translation>Holen und öffnen</translation>
    </message>
    <message>
        <source>Open what was fetched</source>
        <translation>Geholtes öffnen</translation>
    </message>
    <message>
        <source>It was fetched, but it is not open: you chose another scan meanwhile, or kept the one before.</source>
        <translation>Es ist geholt, aber nicht geöffnet: Sie haben inzwischen eine andere Aufnahme gewählt oder die vorige behalten.</translation>
    </message>
    <message>
        <source>Fetches the selected series, or the whole study. A double click does the same.</source>
        <translation>Die markierte Serie oder die ganze Studie. Ein Doppelklick tut dasselbe.</translation>
    </message>
    <message>
        <source>Keeps the fetched scans after the program ends. Otherwise they are deleted.</source>
        <translation>Behält die geholten Aufnahmen nach dem Ende des Programms. Sonst werden sie gelöscht.</translation>
    </message>
    <message>
        <source>Empty</source>
        <translation>Leeren</translation>
    </message>
    <message>
        <source>Deletes all fetched scans except the open one</source>
        <translation>Löscht alles Geholte außer der offenen Aufnahme</translation>
    </message>
</context>
<context>
    <name>BoundaryRow</name>
    <message>
        <source>Turns the boundary on or off</source>
        <translation>Schaltet die Grenze ein oder aus</translation>
    </message>
    <message>
        <source>Switch on %1</source>
        <translation>%1 einschalten</translation>
    </message>
    <message>
        <source>Switch off %1</source>
        <translation>%1 ausschalten</translation>
    </message>
    <message>
        <source>The boundary&apos;s color, here and in the views</source>
        <translation>Ihre Farbe, hier und in den Ansichten</translation>
    </message>
    <message>
        <source>Color %1</source>
        <translation>Farbe von %1</translation>
    </message>
    <message>
        <source>Rename %1</source>
        <translation>%1 umbenennen</translation>
    </message>
    <message>
        <source>in</source>
        <translation>hinein</translation>
    </message>
    <message>
        <source>out</source>
        <translation>hinaus</translation>
    </message>
    <message>
        <source>both</source>
        <translation>beide</translation>
    </message>
    <message>
        <source>The direction in which the stylus is resisted: into the denser tissue, out of it, or both</source>
        <translation>In welche Richtung die Grenze dem Stift widersteht: in das dichtere Gewebe hinein, hinaus oder beides</translation>
    </message>
    <message>
        <source>Direction of %1</source>
        <translation>Richtung von %1</translation>
    </message>
    <message>
        <source> N</source>
        <translation> N</translation>
    </message>
    <message>
        <source>The force at which the stylus breaks through this boundary</source>
        <translation>Die Kraft, mit der sie widersteht, bevor der Stift hindurchgeht</translation>
    </message>
    <message>
        <source>Strength of %1</source>
        <translation>Stärke von %1</translation>
    </message>
    <message>
        <source>A hand cannot tell this strength from that of %1: it feels only differences of a tenth or more.</source>
        <translation>Eine Hand kann diese Stärke nicht von der von %1 unterscheiden: Sie fühlt erst Unterschiede ab einem Zehntel.</translation>
    </message>
</context>
<context>
    <name>ClinicalToolbar</name>
    <message>
        <source>Palpate</source>
        <translation>Palpate</translation>
    </message>
    <message>
        <source>Open…</source>
        <translation>Öffnen…</translation>
    </message>
    <message>
        <source>Opens a folder of DICOM files, with all its subfolders</source>
        <translation>Öffnet einen Ordner mit DICOM-Dateien, mit allen Unterordnern</translation>
    </message>
    <message>
        <source>Window </source>
        <translation>Fenster </translation>
    </message>
    <message>
        <source>Four-up</source>
        <translation>Vier Ansichten</translation>
    </message>
    <message>
        <source>Four-up: axial, sagittal, coronal and volume beside each other</source>
        <translation>Vier Ansichten: axial, sagittal, koronal und Volumen nebeneinander</translation>
    </message>
    <message>
        <source>One-up</source>
        <translation>Eine Ansicht</translation>
    </message>
    <message>
        <source>One-up: the active view alone. A double click in a view does the same.</source>
        <translation>Eine Ansicht: nur die markierte Ansicht. Ein Doppelklick in eine Ansicht tut dasselbe.</translation>
    </message>
    <message>
        <source>Ruler</source>
        <translation>Lineal</translation>
    </message>
    <message>
        <source>Drag in a slice to measure a length (key L). The delete key deletes the last measurement.</source>
        <translation>In einer Schicht ziehen, um eine Länge zu messen (Taste L). Die Taste Entf nimmt die letzte weg.</translation>
    </message>
    <message>
        <source>Angle</source>
        <translation>Winkel</translation>
    </message>
    <message>
        <source>In a slice, drag along one leg of the angle, then click at the end of the other leg (key A).</source>
        <translation>In einer Schicht am einen Schenkel ziehen, dann auf das Ende des anderen klicken (Taste A).</translation>
    </message>
    <message>
        <source>Connect stylus</source>
        <translation>Verbinden</translation>
    </message>
    <message>
        <source>Release  (Esc)</source>
        <translation>Loslassen  (Esc)</translation>
    </message>
    <message>
        <source>Takes the force away</source>
        <translation>Nimmt die Kraft weg</translation>
    </message>
    <message>
        <source>Picture…</source>
        <translation>Bild…</translation>
    </message>
    <message>
        <source>Saves what the views show as a PNG file</source>
        <translation>Speichert, was die Ansichten zeigen, als PNG-Datei</translation>
    </message>
    <message>
        <source>Marks</source>
        <translation>Marken</translation>
    </message>
    <message>
        <source>Shows the marks, and the distances and angles between them</source>
        <translation>Zeigt die Marken und die Abstände und Winkel zwischen ihnen</translation>
    </message>
    <message>
        <source>Advanced</source>
        <translation>Erweitert</translation>
    </message>
    <message>
        <source>Shows ParaView&apos;s own toolbars, pipeline and properties</source>
        <translation>ParaViews eigene Werkzeugleisten, Pipeline und Eigenschaften</translation>
    </message>
    <message>
        <source>Volume</source>
        <translation>Volumen</translation>
    </message>
    <message>
        <source>Hides parts of the volume</source>
        <translation>Blendet Teile des Volumens aus</translation>
    </message>
    <message>
        <source>Without table and headrest</source>
        <translation>Ohne Tisch und Kopfstütze</translation>
    </message>
    <message>
        <source>Crop box</source>
        <translation>Ausschnitt</translation>
    </message>
    <message>
        <source>Drag its handles in the volume view</source>
        <translation>Die Griffe in der Volumenansicht ziehen</translation>
    </message>
    <message>
        <source>Disconnect stylus</source>
        <translation>Trennen</translation>
    </message>
    <message>
        <source>Disconnects the stylus</source>
        <translation>Trennt den Stift</translation>
    </message>
    <message>
        <source>Connects the stylus that is chosen in the panel</source>
        <translation>Verbindet den Stift, der im Bedienfeld gewählt ist</translation>
    </message>
    <message>
        <source>Marks (%1)</source>
        <translation>Marken (%1)</translation>
    </message>
    <message>
        <source>No folder has been opened yet</source>
        <translation>Noch wurde kein Ordner geöffnet</translation>
    </message>
</context>
<context>
    <name>ClinicalViews</name>
    <message>
        <source>custom</source>
        <translation>eigenes</translation>
    </message>
    <message>
        <source>Axial</source>
        <translation>Axial</translation>
    </message>
    <message>
        <source>Coronal</source>
        <translation>Koronal</translation>
    </message>
    <message>
        <source>Sagittal</source>
        <translation>Sagittal</translation>
    </message>
    <message>
        <source>Volume</source>
        <translation>Volumen</translation>
    </message>
</context>
<context>
    <name>CorrectBox</name>
    <message>
        <source>scan&apos;s edge up to %1 mm outside (±%2 mm)</source>
        <translation>Kante der Aufnahme bis zu %1 mm außerhalb (±%2 mm)</translation>
    </message>
    <message>
        <source>scan&apos;s edge up to %1 mm inside (±%2 mm)</source>
        <translation>Kante der Aufnahme bis zu %1 mm innerhalb (±%2 mm)</translation>
    </message>
    <message>
        <source>no edge in the scan: the tissue is the same on both sides</source>
        <translation>keine Kante in der Aufnahme: beiderseits dasselbe Gewebe</translation>
    </message>
    <message>
        <source>a small separate part</source>
        <translation>ein kleiner, getrennter Teil</translation>
    </message>
    <message>
        <source>a small hole</source>
        <translation>ein kleines Loch</translation>
    </message>
    <message>
        <source>Places at which the outline is doubtful, the most doubtful first. A click goes there.</source>
        <translation>Stellen, an denen der Umriss zweifelhaft ist, die zweifelhafteste zuerst. Ein Klick führt hin.</translation>
    </message>
    <message>
        <source>Take the scan&apos;s edge</source>
        <translation>Kante der Aufnahme nehmen</translation>
    </message>
    <message>
        <source>Moves the outline to the scan&apos;s own edge at this place</source>
        <translation>Verschiebt den Umriss an dieser Stelle zur Kante der Aufnahme</translation>
    </message>
    <message>
        <source>Leave it</source>
        <translation>So lassen</translation>
    </message>
    <message>
        <source>Marks the outline as correct at this place</source>
        <translation>Der Umriss stimmt an dieser Stelle</translation>
    </message>
    <message>
        <source>Trace</source>
        <translation>Nachziehen</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Adds to the structure what the ball passes over</source>
        <translation>Fügt zur Struktur hinzu, was die Kugel überstreicht</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Wegnehmen</translation>
    </message>
    <message>
        <source>Removes from the structure what the ball passes over</source>
        <translation>Nimmt von der Struktur weg, was die Kugel überstreicht</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source> N</source>
        <translation> N</translation>
    </message>
    <message>
        <source>Radius of what is added or removed</source>
        <translation>Radius dessen, was hinzugefügt oder weggenommen wird</translation>
    </message>
    <message>
        <source>How strongly the scan&apos;s edge holds the stylus</source>
        <translation>Wie stark die Kante der Aufnahme den Stift hält</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Takes back the last correction</source>
        <translation>Nimmt die letzte Korrektur zurück</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>Applies the undone correction again</source>
        <translation>Wendet die zurückgenommene Korrektur wieder an</translation>
    </message>
    <message>
        <source>Before</source>
        <translation>Vorher</translation>
    </message>
    <message>
        <source>While this button, or the key B in a view, is pressed, the outline of the file is shown</source>
        <translation>Zeigt den Umriss der Datei, solange gedrückt wird; oder B in einer Ansicht</translation>
    </message>
    <message>
        <source>Save…</source>
        <translation>Speichern…</translation>
    </message>
    <message>
        <source>Saves it as DICOM SEG or RTSTRUCT, NIfTI, NRRD or MetaImage</source>
        <translation>Als DICOM SEG oder RTSTRUCT, NIfTI, NRRD oder MetaImage</translation>
    </message>
    <message>
        <source>Send…</source>
        <translation>Senden…</translation>
    </message>
    <message>
        <source>Sends the outline to an archive. First shows what is sent, and for which patient.</source>
        <translation>Sendet an ein Archiv; zeigt erst, was und für welchen Patienten</translation>
    </message>
    <message>
        <source>Looking for doubtful places, %1 %</source>
        <translation>Suche nach zweifelhaften Stellen, %1 %</translation>
    </message>
    <message>
        <source>%1 cm²</source>
        <translation>%1 cm²</translation>
    </message>
    <message>
        <source>corrected: %1</source>
        <translation>korrigiert: %1</translation>
    </message>
    <message>
        <source>kept: %1</source>
        <translation>so gelassen: %1</translation>
    </message>
    <message>
        <source>No doubtful place was found.</source>
        <translation>Keine zweifelhafte Stelle gefunden.</translation>
    </message>
    <message>
        <source>1 doubtful place</source>
        <translation>1 zweifelhafte Stelle</translation>
    </message>
    <message>
        <source>%1 doubtful places</source>
        <translation>%1 zweifelhafte Stellen</translation>
    </message>
    <message>
        <source>The stylus is held in the axial slice</source>
        <translation>Der Stift wird in der axialen Schicht gehalten</translation>
    </message>
    <message>
        <source>The stylus is held in the coronal slice</source>
        <translation>Der Stift wird in der koronalen Schicht gehalten</translation>
    </message>
    <message>
        <source>The stylus is held in the sagittal slice</source>
        <translation>Der Stift wird in der sagittalen Schicht gehalten</translation>
    </message>
    <message>
        <source>Drag along the true edge in a slice: the outline moves to your line. Or hold M while the stylus touches the edge. In the volume view drag over the outline: there it moves to the scan&apos;s own edge.</source>
        <translation>In einer Schicht den wahren Rand nachziehen: Der Umriss folgt. Oder M halten, während der Stift den Rand fühlt. In der Volumenansicht über den Umriss ziehen: Er geht dort zur Kante der Aufnahme.</translation>
    </message>
    <message>
        <source>The stylus stays in the slice of the active view while it traces. Hold F in a view to free it.</source>
        <translation>Der Stift bleibt beim Nachziehen in der Schicht der markierten Ansicht. F in einer Ansicht halten, um ihn freizugeben.</translation>
    </message>
    <message>
        <source>Hold the stylus in the slice</source>
        <translation>Den Stift in der Schicht halten</translation>
    </message>
    <message>
        <source>Free while F is held</source>
        <translation>Frei, solange F gehalten wird</translation>
    </message>
</context>
<context>
    <name>CorrectionModel</name>
    <message>
        <source>Correct %1</source>
        <translation>%1 korrigieren</translation>
    </message>
    <message>
        <source>End correcting</source>
        <translation>Korrigieren beenden</translation>
    </message>
    <message>
        <source>Snap to the scan&apos;s edge</source>
        <translation>An der Kante der Aufnahme einrasten</translation>
    </message>
    <message>
        <source>Trace</source>
        <translation>Nachziehen</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Wegnehmen</translation>
    </message>
    <message>
        <source>Take the scan&apos;s edge</source>
        <translation>Kante der Aufnahme nehmen</translation>
    </message>
    <message>
        <source>Undo a correction</source>
        <translation>Korrektur zurücknehmen</translation>
    </message>
    <message>
        <source>Redo a correction</source>
        <translation>Korrektur wiederholen</translation>
    </message>
    <message>
        <source>Hold in the slice</source>
        <translation>In der Schicht halten</translation>
    </message>
    <message>
        <source>Release from the slice</source>
        <translation>Aus der Schicht lassen</translation>
    </message>
</context>
<context>
    <name>CurveEditor</name>
    <message>
        <source>Drag a node to move it; click to add one. Delete removes the chosen node, and the arrow keys move it. Drag with Shift to move the whole curve. The line marks what is under the pointer in a slice.</source>
        <translation>Einen Knoten ziehen, um ihn zu bewegen; klicken, um einen hinzuzufügen. Entf entfernt den gewählten Knoten, die Pfeiltasten bewegen ihn. Mit gedrückter Umschalttaste wird die ganze Kurve gezogen. Die Linie zeigt, was in einer Schicht unter dem Zeiger liegt.</translation>
    </message>
    <message>
        <source>Node</source>
        <translation>Knoten</translation>
    </message>
</context>
<context>
    <name>CurveProfile</name>
    <message>
        <source>The force along a line in the present scene. The dashed line shows it before the last drag. Hold the pointer still over a boundary in a slice, touch a boundary, or pick two points in Force profile.</source>
        <translation>Die Kraft längs einer Linie, wie sie jetzt zu fühlen wäre; gestrichelt: bevor die Kurve gezogen wurde. Den Zeiger in einer Schicht auf einer Grenze ruhen lassen, eine berühren oder im Kraftprofil zwei Punkte wählen.</translation>
    </message>
    <message>
        <source>Hold the pointer still over a boundary in a slice: the force across it is drawn here.</source>
        <translation>Den Zeiger in einer Schicht auf einer Grenze ruhen lassen: Die Kraft quer dazu wird hier gezeichnet.</translation>
    </message>
    <message>
        <source>%1 up to %2 N</source>
        <translation>%1 bis %2 N</translation>
    </message>
    <message>
        <source>no boundary is met</source>
        <translation>es wird keine Grenze getroffen</translation>
    </message>
    <message>
        <source>Along the chosen stroke</source>
        <translation>Längs des gewählten Strichs</translation>
    </message>
    <message>
        <source>Across the place last touched</source>
        <translation>Quer zur zuletzt berührten Stelle</translation>
    </message>
    <message>
        <source>Across the place pointed at</source>
        <translation>Quer zur Stelle unter dem Zeiger</translation>
    </message>
    <message>
        <source>%1: %2.</source>
        <translation>%1: %2.</translation>
    </message>
    <message>
        <source>%1 Before: %2.</source>
        <translation>%1 Vorher: %2.</translation>
    </message>
</context>
<context>
    <name>CurvesSection</name>
    <message>
        <source>Undo. Hold B to feel the scene as it was before the last edit.</source>
        <translation>Rückgängig. B gedrückt halten, um die Szene vor der letzten Änderung zu fühlen.</translation>
    </message>
    <message>
        <source>Redo</source>
        <translation>Wiederholen</translation>
    </message>
    <message>
        <source>gradient</source>
        <translation>Gradient</translation>
    </message>
    <message>
        <source>strength, N</source>
        <translation>Stärke, N</translation>
    </message>
    <message>
        <source>value</source>
        <translation>Wert</translation>
    </message>
    <message>
        <source>factor</source>
        <translation>Faktor</translation>
    </message>
    <message>
        <source>Preset curve…</source>
        <translation>Vorlage der Kurve…</translation>
    </message>
    <message>
        <source>Curve of %1</source>
        <translation>Kurve von %1</translation>
    </message>
    <message>
        <source>gradient per mm</source>
        <translation>Gradient pro mm</translation>
    </message>
    <message>
        <source>%1 per mm</source>
        <translation>%1 pro mm</translation>
    </message>
    <message>
        <source>Shape: %1</source>
        <translation>Form: %1</translation>
    </message>
    <message>
        <source>Soft edge: the force rises gradually</source>
        <translation>Weicher Rand: die Kraft steigt allmählich</translation>
    </message>
    <message>
        <source>Firm edge: the full force at once</source>
        <translation>Fester Rand: sofort die volle Kraft</translation>
    </message>
    <message>
        <source>Steep edges only</source>
        <translation>Nur steile Ränder</translation>
    </message>
    <message>
        <source>Everywhere the same</source>
        <translation>Überall gleich</translation>
    </message>
</context>
<context>
    <name>FileName</name>
    <message>
        <source>%1 is there already. Replace it?</source>
        <translation>%1 gibt es schon. Ersetzen?</translation>
    </message>
</context>
<context>
    <name>FilterRow</name>
    <message>
        <source>Filter</source>
        <translation>Filter</translation>
    </message>
    <message>
        <source>Reduces noise, which is felt as roughness. The stylus feels the filtered values. Bilateral and non-local means keep edges where they are; a Gaussian rounds them.</source>
        <translation>Verringert Rauschen, das als Rauheit zu fühlen ist. Der Stift fühlt die gefilterten Werte. Bilateral und nichtlokale Mittelung lassen Kanten, wo sie sind; ein Gauß-Filter rundet sie.</translation>
    </message>
    <message>
        <source>None</source>
        <translation>Keiner</translation>
    </message>
    <message>
        <source>Gaussian</source>
        <translation>Gauß</translation>
    </message>
    <message>
        <source>Median</source>
        <translation>Median</translation>
    </message>
    <message>
        <source>Bilateral</source>
        <translation>Bilateral</translation>
    </message>
    <message>
        <source>Non-local means</source>
        <translation>Nichtlokale Mittelung</translation>
    </message>
    <message>
        <source>Show</source>
        <translation>Zeigen</translation>
    </message>
    <message>
        <source>On: the views show the filtered values, as they are felt. Off: the views show the values as scanned.</source>
        <translation>An: Die Ansichten zeigen die gefilterten Werte, wie sie gefühlt werden. Aus: wie sie aufgenommen wurden.</translation>
    </message>
    <message>
        <source>Filtering %p%</source>
        <translation>Filtern %p%</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source> pixels</source>
        <translation> Pixel</translation>
    </message>
    <message>
        <source>filter</source>
        <translation>Filter</translation>
    </message>
    <message>
        <source>%1 (the views show unfiltered values)</source>
        <translation>%1 (ungefiltert gezeigt)</translation>
    </message>
    <message>
        <source>Width of the square of pixels in a slice</source>
        <translation>Kante des Quadrats in der Schicht</translation>
    </message>
    <message>
        <source>Differences smaller than this count as noise</source>
        <translation>Werte, die sich um weniger unterscheiden, gelten als Rauschen</translation>
    </message>
    <message>
        <source>Standard deviation of the Gaussian</source>
        <translation>Standardabweichung der Gauß-Kurve</translation>
    </message>
</context>
<context>
    <name>Footer</name>
    <message>
        <source>Value of the scan and tissue at the proxy</source>
        <translation>Wert der Aufnahme und Gewebe am Proxy</translation>
    </message>
    <message>
        <source>Force on the stylus</source>
        <translation>Kraft auf den Stift</translation>
    </message>
    <message>
        <source>How far the stylus has gone past the boundary that holds it, in mm in the patient</source>
        <translation>Wie weit der Stift hinter der Grenze ist, die ihn hält, in mm im Patienten</translation>
    </message>
    <message>
        <source>Scan, frame and scene that the stylus feels</source>
        <translation>Aufnahme, Bild und Szene, die der Stift fühlt</translation>
    </message>
    <message>
        <source>No scan is open.</source>
        <translation>Es ist keine Aufnahme geöffnet.</translation>
    </message>
    <message>
        <source>Technical</source>
        <translation>Technisches</translation>
    </message>
    <message>
        <source>For developers: solver, servo, the stylus&apos; own limits, and the parts of the scene that are left out</source>
        <translation>Für Entwickler: Löser, Takt der Kraft, die Grenzen des Stifts und welche Teile der Szene fehlen</translation>
    </message>
    <message>
        <source>Record…</source>
        <translation>Aufzeichnen…</translation>
    </message>
    <message>
        <source>Records all that is felt in a file, to be replayed later. The file holds no patient&apos;s name.</source>
        <translation>Zeichnet alles Gefühlte in einer Datei auf, um es später abzuspielen. Die Datei enthält keinen Patientennamen.</translation>
    </message>
    <message>
        <source>Release  (Esc)</source>
        <translation>Loslassen  (Esc)</translation>
    </message>
    <message>
        <source>Feel</source>
        <translation>Fühlen</translation>
    </message>
    <message>
        <source>Mark  (M)</source>
        <translation>Marke  (M)</translation>
    </message>
    <message>
        <source>Marks the point that the stylus touches. Keep it pressed while the stylus moves to mark a path. The stylus&apos; second button and the key M in a view do the same.</source>
        <translation>Markiert den Punkt, den der Stift berührt. Gedrückt halten, während er sich bewegt, um einen Pfad zu markieren. Die zweite Taste des Stifts und die Taste M in einer Ansicht tun dasselbe.</translation>
    </message>
    <message>
        <source>Correct  (M)</source>
        <translation>Korrigieren  (M)</translation>
    </message>
    <message>
        <source>Corrects the outline with the chosen tool at the point that the stylus touches. Keep it pressed while the stylus moves along the true edge. The stylus&apos; second button and the key M in a view do the same.</source>
        <translation>Korrigiert den Umriss mit dem gewählten Werkzeug an dem Punkt, den der Stift berührt. Gedrückt halten, während er sich den wahren Rand entlang bewegt. Die zweite Taste des Stifts und die Taste M in einer Ansicht tun dasselbe.</translation>
    </message>
    <message>
        <source>Stop recording</source>
        <translation>Aufzeichnung beenden</translation>
    </message>
    <message>
        <source>Record to</source>
        <translation>Aufzeichnen nach</translation>
    </message>
    <message>
        <source>Recordings (*.h5)</source>
        <translation>Aufzeichnungen (*.h5)</translation>
    </message>
    <message>
        <source>unknown</source>
        <translation>unbekannt</translation>
    </message>
    <message>
        <source>Open the stylus again</source>
        <translation>Den Stift neu öffnen</translation>
    </message>
    <message>
        <source>Clear fault</source>
        <translation>Störung quittieren</translation>
    </message>
    <message>
        <source>⚠ %1: within its margin</source>
        <translation>⚠ %1: im Sicherheitsabstand</translation>
    </message>
    <message>
        <source>no stylus</source>
        <translation>kein Stift</translation>
    </message>
    <message>
        <source>%1 N</source>
        <translation>%1 N</translation>
    </message>
    <message>
        <source>%1 mm</source>
        <translation>%1 mm</translation>
    </message>
    <message>
        <source>no boundary touched</source>
        <translation>keine Grenze berührt</translation>
    </message>
    <message>
        <source>%1 from the proxy</source>
        <translation>%1 vom Proxy</translation>
    </message>
    <message>
        <source>%1 past %2</source>
        <translation>%1 hinter %2</translation>
    </message>
    <message>
        <source>outside the scan</source>
        <translation>außerhalb der Aufnahme</translation>
    </message>
    <message>
        <source>Distance to the nearest structure of the scene; colored inside its margin</source>
        <translation>Abstand zur nächsten Struktur der Szene; farbig in ihrem Sicherheitsabstand</translation>
    </message>
    <message>
        <source>Which solver balanced the forces, and how far from the exact balance the proxy can be</source>
        <translation>Welcher Löser die Kräfte ausglich und wie weit der Proxy vom genauen Gleichgewicht entfernt sein kann</translation>
    </message>
    <message>
        <source>Median time of a tick of the servo, and deadlines that it missed</source>
        <translation>Median der Dauer eines Takts und versäumte Takte</translation>
    </message>
    <message>
        <source>%1 solver, error below %2 mm</source>
        <translation>Löser %1, Fehler unter %2 mm</translation>
    </message>
    <message>
        <source>recorded: tick %1 µs</source>
        <translation>aufgezeichnet: Takt %1 µs</translation>
    </message>
    <message>
        <source>tick %1 µs, %2 missed</source>
        <translation>Takt %1 µs, %2 versäumt</translation>
    </message>
</context>
<context>
    <name>ForceStrip</name>
    <message>
        <source>Force of the last ten seconds. The dashed line is the limit; it appears when the force reaches a third of it.</source>
        <translation>Kraft der letzten zehn Sekunden. Die gestrichelte Linie ist die Grenze; sie erscheint, sobald ein Drittel der Grenze gefühlt wurde.</translation>
    </message>
    <message>
        <source>limit %1 N</source>
        <translation>Grenze %1 N</translation>
    </message>
    <message>
        <source>10 s</source>
        <translation>10 s</translation>
    </message>
</context>
<context>
    <name>FrameRow</name>
    <message>
        <source>First frame</source>
        <translation>Erstes Bild</translation>
    </message>
    <message>
        <source>One frame back</source>
        <translation>Ein Bild zurück</translation>
    </message>
    <message>
        <source>Next frame</source>
        <translation>Ein Bild weiter</translation>
    </message>
    <message>
        <source>Last frame</source>
        <translation>Letztes Bild</translation>
    </message>
    <message>
        <source>The frame that is shown and felt. ParaView&apos;s time follows it.</source>
        <translation>Das Bild der Folge, das gezeigt und gefühlt wird: dasselbe wie die Zeit von ParaView</translation>
    </message>
</context>
<context>
    <name>HelpMenu</name>
    <message>
        <source>Help</source>
        <translation>Hilfe</translation>
    </message>
    <message>
        <source>Palpate guide</source>
        <translation>Palpate-Anleitung (englisch)</translation>
    </message>
    <message>
        <source>About Palpate</source>
        <translation>Über Palpate</translation>
    </message>
    <message>
        <source>&lt;h3&gt;Palpate %1&lt;/h3&gt;&lt;p&gt;Feel a CT or MR scan with a haptic stylus.&lt;/p&gt;&lt;p&gt;&lt;b&gt;Research software, not a medical device.&lt;/b&gt;&lt;/p&gt;&lt;p&gt;Apache License 2.0. Runs in %2; the libraries that it uses and their licenses are listed in its package.&lt;/p&gt;</source>
        <translation>&lt;h3&gt;Palpate %1&lt;/h3&gt;&lt;p&gt;Eine CT- oder MR-Aufnahme mit einem haptischen Stift fühlen.&lt;/p&gt;&lt;p&gt;&lt;b&gt;Forschungssoftware, kein Medizinprodukt.&lt;/b&gt;&lt;/p&gt;&lt;p&gt;Apache License 2.0. Läuft in %2; die benutzten Bibliotheken und ihre Lizenzen stehen in dessen Paket.&lt;/p&gt;</translation>
    </message>
</context>
<context>
    <name>MarksModel</name>
    <message>
        <source>Mark</source>
        <translation>Marke</translation>
    </message>
    <message>
        <source>Mark a path</source>
        <translation>Pfad markieren</translation>
    </message>
</context>
<context>
    <name>MarksSection</name>
    <message>
        <source>Choose two marks for their distance, three for the angle at the second. A double click goes to a mark; F2 renames it.</source>
        <translation>Zwei Marken für ihren Abstand wählen, drei für den Winkel an der zweiten. Ein Doppelklick geht zu einer Marke; F2 benennt sie um.</translation>
    </message>
    <message>
        <source>Keep</source>
        <translation>Behalten</translation>
    </message>
    <message>
        <source>The distance or angle stays in the list and in the views</source>
        <translation>Abstand oder Winkel bleibt in der Liste und in den Ansichten</translation>
    </message>
    <message>
        <source>Move here</source>
        <translation>Hierher</translation>
    </message>
    <message>
        <source>Moves the mark to the point that the stylus touches now</source>
        <translation>Setzt die Marke auf den Punkt, den der Stift jetzt berührt</translation>
    </message>
    <message>
        <source>Delete</source>
        <translation>Löschen</translation>
    </message>
    <message>
        <source>Deletes what is chosen in the list</source>
        <translation>Löscht, was in der Liste gewählt ist</translation>
    </message>
    <message>
        <source>Undo</source>
        <translation>Rückgängig</translation>
    </message>
    <message>
        <source>Takes back the last change of the marks or of the scene</source>
        <translation>Nimmt die letzte Änderung an den Marken oder der Szene zurück</translation>
    </message>
    <message>
        <source>Send…</source>
        <translation>Senden…</translation>
    </message>
    <message>
        <source>Sends the marks to an archive. First shows what is sent, and for which patient.</source>
        <translation>Sendet an ein Archiv; zeigt erst, was und für welchen Patienten</translation>
    </message>
    <message>
        <source>no boundary felt</source>
        <translation>keine Grenze gefühlt</translation>
    </message>
    <message>
        <source>%1 N</source>
        <translation>%1 N</translation>
    </message>
    <message>
        <source>%1 without contact</source>
        <translation>%1 ohne Berührung</translation>
    </message>
    <message>
        <source>%1, of which %2 along the surface</source>
        <translation>%1, davon %2 auf der Oberfläche</translation>
    </message>
    <message>
        <source>%1 along the surface</source>
        <translation>%1 auf der Oberfläche</translation>
    </message>
    <message>
        <source>%1 to %2</source>
        <translation>%1 bis %2</translation>
    </message>
    <message>
        <source>Angle at %1</source>
        <translation>Winkel bei %1</translation>
    </message>
    <message>
        <source>%1°</source>
        <translation>%1°</translation>
    </message>
    <message>
        <source>Between %1 and %2</source>
        <translation>Zwischen %1 und %2</translation>
    </message>
    <message>
        <source>%1 from %2 to %3</source>
        <translation>%1 von %2 bis %3</translation>
    </message>
    <message>
        <source>%1° at %2</source>
        <translation>%1° bei %2</translation>
    </message>
    <message>
        <source>Rename to %1</source>
        <translation>Umbenennen in %1</translation>
    </message>
    <message>
        <source>Keep a distance</source>
        <translation>Abstand behalten</translation>
    </message>
    <message>
        <source>Keep an angle</source>
        <translation>Winkel behalten</translation>
    </message>
    <message>
        <source>Move %1</source>
        <translation>%1 bewegen</translation>
    </message>
    <message>
        <source>Delete marks</source>
        <translation>Marken löschen</translation>
    </message>
    <message>
        <source>1 path</source>
        <translation>1 Pfad</translation>
    </message>
    <message>
        <source>%1 paths</source>
        <translation>%1 Pfade</translation>
    </message>
    <message>
        <source>%1
%2 s after the session began</source>
        <translation>%1
%2 s nach Beginn der Sitzung</translation>
    </message>
</context>
<context>
    <name>MarksSender</name>
    <message>
        <source>Writing the report</source>
        <translation>Der Bericht wird geschrieben</translation>
    </message>
    <message>
        <source>%1 of %2 files</source>
        <translation>%1 von %2 Dateien</translation>
    </message>
</context>
<context>
    <name>ModesSection</name>
    <message>
        <source>Switch on %1</source>
        <translation>%1 einschalten</translation>
    </message>
    <message>
        <source>Switch off %1</source>
        <translation>%1 ausschalten</translation>
    </message>
    <message>
        <source>Add</source>
        <translation>Hinzufügen</translation>
    </message>
    <message>
        <source>Remove</source>
        <translation>Entfernen</translation>
    </message>
    <message>
        <source> N</source>
        <translation> N</translation>
    </message>
    <message>
        <source>Strength</source>
        <translation>Stärke</translation>
    </message>
    <message>
        <source>Resists</source>
        <translation>Widersteht</translation>
    </message>
    <message>
        <source>entering (towards higher values)</source>
        <translation>beim Eintreten (zu höheren Werten)</translation>
    </message>
    <message>
        <source>leaving (towards lower values)</source>
        <translation>beim Austreten (zu niedrigeren Werten)</translation>
    </message>
    <message>
        <source>both</source>
        <translation>in beide Richtungen</translation>
    </message>
    <message>
        <source>Side</source>
        <translation>Seite</translation>
    </message>
    <message>
        <source>Tissues</source>
        <translation>Gewebe</translation>
    </message>
    <message>
        <source>From</source>
        <translation>Von</translation>
    </message>
    <message>
        <source>To</source>
        <translation>Bis</translation>
    </message>
    <message>
        <source>Direction</source>
        <translation>Richtung</translation>
    </message>
    <message>
        <source>the vector field</source>
        <translation>Vektorfeld</translation>
    </message>
    <message>
        <source>the gradient</source>
        <translation>Gradient</translation>
    </message>
    <message>
        <source>Shape</source>
        <translation>Form</translation>
    </message>
    <message>
        <source>point</source>
        <translation>Punkt</translation>
    </message>
    <message>
        <source>line</source>
        <translation>Linie</translation>
    </message>
    <message>
        <source>plane</source>
        <translation>Ebene</translation>
    </message>
    <message>
        <source>Put the landmark where the proxy is</source>
        <translation>An den Proxy setzen</translation>
    </message>
    <message>
        <source>Place</source>
        <translation>Ort</translation>
    </message>
    <message>
        <source>%1 of %2</source>
        <translation>%1 von %2</translation>
    </message>
    <message>
        <source>Add %1</source>
        <translation>%1 hinzufügen</translation>
    </message>
    <message>
        <source>Remove %1</source>
        <translation>%1 entfernen</translation>
    </message>
    <message>
        <source>(any)</source>
        <translation>(alle)</translation>
    </message>
    <message>
        <source>%1: %2</source>
        <translation>%1: %2</translation>
    </message>
    <message>
        <source>%1 (%2)</source>
        <translation>%1 (%2)</translation>
    </message>
    <message>
        <source>%1: %2 (saves %3)</source>
        <translation>%1: %2 (spart %3)</translation>
    </message>
    <message>
        <source>Everything is needed; nothing was left out.</source>
        <translation>Alles wird gebraucht; nichts wurde weggelassen.</translation>
    </message>
    <message>
        <source>Left out, because nothing here needs it:
• %1</source>
        <translation>Weggelassen, weil hier nichts es braucht:
• %1</translation>
    </message>
</context>
<context>
    <name>OutlineOut</name>
    <message>
        <source>Writing %p%</source>
        <translation>Schreiben %p%</translation>
    </message>
    <message>
        <source>Sending</source>
        <translation>Senden</translation>
    </message>
</context>
<context>
    <name>PalpatePanel</name>
    <message>
        <source>Palpate</source>
        <translation>Palpate</translation>
    </message>
</context>
<context>
    <name>Column</name>
    <message>
        <source>3D Slicer</source>
        <translation>3D Slicer</translation>
    </message>
    <message>
        <source>Scan</source>
        <translation>Aufnahme</translation>
    </message>
    <message>
        <source>Tissues</source>
        <translation>Gewebe</translation>
    </message>
    <message>
        <source>Structures</source>
        <translation>Strukturen</translation>
    </message>
    <message>
        <source>Stylus</source>
        <translation>Stift</translation>
    </message>
    <message>
        <source>Marks</source>
        <translation>Marken</translation>
    </message>
    <message>
        <source>Transfer function</source>
        <translation>Transferfunktion</translation>
    </message>
    <message>
        <source>Modes</source>
        <translation>Modi</translation>
    </message>
    <message>
        <source>Force profile</source>
        <translation>Kraftprofil</translation>
    </message>
    <message>
        <source>Recordings</source>
        <translation>Aufzeichnungen</translation>
    </message>
    <message>
        <source>Palpate %1. Research software, not a medical device.</source>
        <translation>Palpate %1. Forschungssoftware, kein Medizinprodukt.</translation>
    </message>
    <message>
        <source>Boundaries on the slices</source>
        <translation>Grenzen auf den Schichten</translation>
    </message>
    <message>
        <source>Draws a line where each boundary is felt, in its color. The lines follow each edit.</source>
        <translation>Zeichnet eine Linie, wo jede Grenze gefühlt wird, in ihrer Farbe. Die Linien folgen jeder Änderung.</translation>
    </message>
    <message>
        <source>Crosshair</source>
        <translation>Fadenkreuz</translation>
    </message>
    <message>
        <source>Shows where the other two slices lie. Hold Shift to make them follow the pointer.</source>
        <translation>Zeigt, wo die beiden anderen Schichten liegen. Mit gedrückter Umschalttaste folgen sie dem Zeiger.</translation>
    </message>
</context>
<context>
    <name>DrawnLayers</name>
    <message>
        <source>drawing</source>
        <translation>Zeichnen</translation>
    </message>
</context>
<context>
    <name>PanelParts</name>
    <message>
        <source>Save a picture of the views</source>
        <translation>Ein Bild der Ansichten speichern</translation>
    </message>
    <message>
        <source>Pictures (*.png)</source>
        <translation>Bilder (*.png)</translation>
    </message>
    <message>
        <source>No scan is open.</source>
        <translation>Es ist keine Aufnahme geöffnet.</translation>
    </message>
    <message>
        <source>Open: %1. Scene: %2.</source>
        <translation>Geöffnet: %1. Szene: %2.</translation>
    </message>
    <message>
        <source>Opening %1…</source>
        <translation>%1 wird geöffnet…</translation>
    </message>
    <message>
        <source>Felt: %1. Scene: %2.</source>
        <translation>Gefühlt: %1. Szene: %2.</translation>
    </message>
    <message>
        <source>Also shown, not felt: %1.</source>
        <translation>Auch gezeigt, nicht gefühlt: %1.</translation>
    </message>
    <message>
        <source>the folder does not exist, or you may not write to it</source>
        <translation>den Ordner gibt es nicht, oder er darf nicht beschrieben werden</translation>
    </message>
    <message>
        <source>DICOM contours, RTSTRUCT (*.dcm)</source>
        <translation>DICOM-Konturen, RTSTRUCT (*.dcm)</translation>
    </message>
    <message>
        <source>DICOM segmentation, SEG (*.dcm)</source>
        <translation>DICOM-Segmentierung, SEG (*.dcm)</translation>
    </message>
    <message>
        <source>Save the corrected outline</source>
        <translation>Korrigierten Umriss speichern</translation>
    </message>
</context>
<context>
    <name>TissueStudy</name>
    <message>
        <source>Looking for tissues %p%</source>
        <translation>Gewebe werden gesucht %p%</translation>
    </message>
</context>
<context>
    <name>UnsavedGuard</name>
    <message>
        <source>Another scan is about to replace this one.</source>
        <translation>Eine andere Aufnahme ersetzt diese.</translation>
    </message>
    <message>
        <source>ParaView is about to end.</source>
        <translation>ParaView wird beendet.</translation>
    </message>
    <message>
        <source>This closes everything that is open.</source>
        <translation>Alles, was offen ist, wird geschlossen.</translation>
    </message>
    <message>
        <source>Save all that is open</source>
        <translation>Alles Offene speichern</translation>
    </message>
    <message>
        <source>ParaView states (*.pvsm)</source>
        <translation>Zustände von ParaView (*.pvsm)</translation>
    </message>
    <message>
        <source>the folder does not exist, or you may not write to it</source>
        <translation>den Ordner gibt es nicht, oder er darf nicht beschrieben werden</translation>
    </message>
</context>
<context>
    <name>ProfileSection</name>
    <message>
        <source>Pick two points</source>
        <translation>Zwei Punkte wählen</translation>
    </message>
    <message>
        <source>In a slice or in the 3D view: drag from the start point to the end point, or click on both.</source>
        <translation>In den Schichten oder auf dem, was die 3D-Ansicht zeigt: vom einen zum anderen ziehen oder auf beide klicken.</translation>
    </message>
    <message>
        <source> mm/s</source>
        <translation> mm/s</translation>
    </message>
    <message>
        <source>How fast the stylus goes along the stroke</source>
        <translation>Wie schnell der Stift dem Strich folgt</translation>
    </message>
    <message>
        <source>x, y, z</source>
        <translation>x, y, z</translation>
    </message>
    <message>
        <source>DICOM patient coordinates (LPS) in mm: + to the left, to the back, to the head</source>
        <translation>mm im Patienten: nach links, nach hinten, zum Kopf</translation>
    </message>
    <message>
        <source>Stylus</source>
        <translation>Stift</translation>
    </message>
    <message>
        <source>Uses the place where the stylus is now</source>
        <translation>Wo der Stift jetzt ist</translation>
    </message>
    <message>
        <source>From</source>
        <translation>Von</translation>
    </message>
    <message>
        <source>To</source>
        <translation>Bis</translation>
    </message>
    <message>
        <source>%1 at %2 mm, up to %3 N</source>
        <translation>%1 bei %2 mm, bis %3 N</translation>
    </message>
    <message>
        <source>%1, known to ±%2 mm</source>
        <translation>%1, bekannt auf ±%2 mm</translation>
    </message>
    <message>
        <source>No boundary is met.</source>
        <translation>Keine Grenze wird getroffen.</translation>
    </message>
    <message>
        <source>Force against depth along a stroke through the scan, as it would be felt now</source>
        <translation>Kraft über der Tiefe längs eines Strichs durch die Aufnahme, wie sie jetzt zu fühlen wäre</translation>
    </message>
    <message>
        <source>The stroke would take %1 s: choose nearer points or a higher speed, so that it takes at most %2 s.</source>
        <translation>Der Strich würde %1 s dauern: nähere Punkte oder eine höhere Geschwindigkeit wählen, damit er höchstens %2 s dauert.</translation>
    </message>
</context>
<context>
    <name>RecordingComparison</name>
    <message>
        <source>Blue: %1, orange: %2. %3</source>
        <translation>Blau: %1, orange: %2. %3</translation>
    </message>
</context>
<context>
    <name>RecordingsSection</name>
    <message>
        <source>Open recording</source>
        <translation>Aufzeichnung öffnen</translation>
    </message>
    <message>
        <source>Recordings (*.h5)</source>
        <translation>Aufzeichnungen (*.h5)</translation>
    </message>
    <message>
        <source>Open recording…</source>
        <translation>Aufzeichnung öffnen…</translation>
    </message>
    <message>
        <source>Play or pause</source>
        <translation>Abspielen oder anhalten</translation>
    </message>
    <message>
        <source>Playback speed</source>
        <translation>Abspielgeschwindigkeit</translation>
    </message>
    <message>
        <source>Disconnect the stylus to play a recording. While it is connected, the views show what it feels.</source>
        <translation>Zum Abspielen den Stift trennen. Solange er verbunden ist, zeigen die Ansichten, was er fühlt.</translation>
    </message>
    <message>
        <source>Compare with…</source>
        <translation>Vergleichen mit…</translation>
    </message>
    <message>
        <source>Close the recordings</source>
        <translation>Die Aufzeichnungen schließen</translation>
    </message>
    <message>
        <source>%1 s are left out: they were recorded on another scan.</source>
        <translation>%1 s sind ausgelassen: Sie wurden an einer anderen Aufnahme aufgezeichnet.</translation>
    </message>
    <message>
        <source>%1 of %2 s</source>
        <translation>%1 von %2 s</translation>
    </message>
    <message>
        <source>Compares with another recording of the same stroke, place by place. The speeds may differ.</source>
        <translation>Vergleicht mit einer anderen Aufzeichnung desselben Strichs, Ort für Ort, bei beliebiger Geschwindigkeit</translation>
    </message>
    <message>
        <source>Disconnect the stylus to play. While it is connected, the views show what it feels</source>
        <translation>Zum Abspielen den Stift trennen: Die Ansichten zeigen, was er fühlt</translation>
    </message>
</context>
<context>
    <name>SampleScan</name>
    <message>
        <source>Try the sample head</source>
        <translation>Beispielkopf ausprobieren</translation>
    </message>
    <message>
        <source>Try a phantom</source>
        <translation>Phantom ausprobieren</translation>
    </message>
</context>
<context>
    <name>SaveButtons</name>
    <message>
        <source>Save table…</source>
        <translation>Tabelle speichern…</translation>
    </message>
    <message>
        <source>Save picture…</source>
        <translation>Bild speichern…</translation>
    </message>
    <message>
        <source>Save table</source>
        <translation>Tabelle speichern</translation>
    </message>
    <message>
        <source>Save picture</source>
        <translation>Bild speichern</translation>
    </message>
    <message>
        <source>Tables (*.csv)</source>
        <translation>Tabellen (*.csv)</translation>
    </message>
    <message>
        <source>Pictures (*.png)</source>
        <translation>Bilder (*.png)</translation>
    </message>
</context>
<context>
    <name>ScanHandle</name>
    <message>
        <source>frame</source>
        <translation>Bild</translation>
    </message>
    <message>
        <source>%1 %2 of %3</source>
        <translation>%1 %2 von %3</translation>
    </message>
    <message>
        <source>%1, %2 of %3</source>
        <translation>%1, %2 von %3</translation>
    </message>
    <message>
        <source>%1, %2 slices of %3 x %4, every %5 mm</source>
        <translation>%1, %2 Schichten von %3 x %4, alle %5 mm</translation>
    </message>
</context>
<context>
    <name>ScanIdentity</name>
    <message>
        <source>ID %1</source>
        <translation>ID %1</translation>
    </message>
</context>
<context>
    <name>ScanPipeline</name>
    <message>
        <source>Finding series</source>
        <translation>Serien werden gesucht</translation>
    </message>
    <message>
        <source>Loading</source>
        <translation>Laden</translation>
    </message>
</context>
<context>
    <name>ScanSection</name>
    <message>
        <source>Finding series</source>
        <translation>Serien werden gesucht</translation>
    </message>
    <message>
        <source>Showing</source>
        <translation>Wird angezeigt</translation>
    </message>
    <message>
        <source>Loading</source>
        <translation>Laden</translation>
    </message>
    <message>
        <source>Key %1</source>
        <translation>Taste %1</translation>
    </message>
    <message>
        <source>Custom (%1 / %2)</source>
        <translation>Eigenes (%1 / %2)</translation>
    </message>
    <message>
        <source>Open DICOM folder…</source>
        <translation>DICOM-Ordner öffnen…</translation>
    </message>
    <message>
        <source>Opens a folder of DICOM files, with all its subfolders. A folder may also be dropped here.</source>
        <translation>Öffnet einen Ordner mit DICOM-Dateien, mit allen Unterordnern. Er kann auch hier abgelegt werden.</translation>
    </message>
    <message>
        <source>File…</source>
        <translation>Datei…</translation>
    </message>
    <message>
        <source>A scan in NIfTI, NRRD or MetaImage, or a zipped study. It may also be dropped here.</source>
        <translation>Eine Aufnahme in NIfTI, NRRD oder MetaImage oder eine gezippte Studie. Sie kann auch hier abgelegt werden.</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
    <message>
        <source>Keys 1 to 9. Also: drag in a slice, to the right for a wider window, up for a brighter one.</source>
        <translation>Tasten 1 bis 9. Auch: in einer Schicht ziehen, nach rechts für ein breiteres Fenster, nach oben für ein helleres.</translation>
    </message>
    <message>
        <source>Folder</source>
        <translation>Ordner</translation>
    </message>
    <message>
        <source>Archive</source>
        <translation>Archiv</translation>
    </message>
    <message>
        <source>Open DICOM folder</source>
        <translation>DICOM-Ordner öffnen</translation>
    </message>
    <message>
        <source>Open a file</source>
        <translation>Datei öffnen</translation>
    </message>
    <message>
        <source>Scans</source>
        <translation>Aufnahmen</translation>
    </message>
    <message>
        <source>All files</source>
        <translation>Alle Dateien</translation>
    </message>
    <message>
        <source>As the scanner set it</source>
        <translation>Wie vom Gerät gesetzt</translation>
    </message>
    <message>
        <source>Soft tissue</source>
        <translation>Weichteile</translation>
    </message>
    <message>
        <source>Brain</source>
        <translation>Gehirn</translation>
    </message>
    <message>
        <source>Lung</source>
        <translation>Lunge</translation>
    </message>
    <message>
        <source>Bone</source>
        <translation>Knochen</translation>
    </message>
    <message>
        <source>Mediastinum</source>
        <translation>Mediastinum</translation>
    </message>
    <message>
        <source>Abdomen</source>
        <translation>Abdomen</translation>
    </message>
    <message>
        <source>Angio</source>
        <translation>Angiographie</translation>
    </message>
    <message>
        <source>Stroke</source>
        <translation>Schlaganfall</translation>
    </message>
    <message>
        <source>1st to 99th percentile</source>
        <translation>1. bis 99. Perzentil</translation>
    </message>
    <message>
        <source>Speed</source>
        <translation>Geschwindigkeit</translation>
    </message>
    <message>
        <source>All values</source>
        <translation>Alle Werte</translation>
    </message>
    <message>
        <source>Show the pointer's position in RAS</source>
        <translation>Ort des Zeigers in RAS zeigen</translation>
    </message>
    <message>
        <source>Right, anterior and superior are positive; DICOM and radiology write L/R, P/A, H/F instead.</source>
        <translation>Rechts, vorn und oben sind positiv; DICOM und Radiologie schreiben stattdessen L/R, P/A, H/F.</translation>
    </message>
    <message>
        <source>A copy on this machine…</source>
        <translation>Eine Kopie auf diesem Rechner…</translation>
    </message>
    <message>
        <source>A folder of this machine with the same scan. The scan is then read from here, not from the server.</source>
        <translation>Ein Ordner dieses Rechners mit derselben Aufnahme. Sie wird dann von hier gelesen, nicht vom Server.</translation>
    </message>
    <message>
        <source>Folder of this machine with the scan that the server shows</source>
        <translation>Ordner dieses Rechners mit der Aufnahme, die der Server zeigt</translation>
    </message>
    <message>
        <source> of the server</source>
        <translation> des Servers</translation>
    </message>
</context>
<context>
    <name>SendDialog</name>
    <message>
        <source>To</source>
        <translation>An</translation>
    </message>
    <message>
        <source>Send marks</source>
        <translation>Marken senden</translation>
    </message>
    <message>
        <source>Patient</source>
        <translation>Patient</translation>
    </message>
    <message>
        <source>Study</source>
        <translation>Studie</translation>
    </message>
    <message>
        <source>What</source>
        <translation>Was</translation>
    </message>
    <message>
        <source>A report (SR) of %1 marks, %2 distances and %3 paths, and %4 pictures of the marks</source>
        <translation>Ein Bericht (SR) mit %1 Marken, %2 Abständen und %3 Pfaden und %4 Bilder der Marken</translation>
    </message>
    <message>
        <source>Report</source>
        <translation>Bericht</translation>
    </message>
    <message>
        <source>They go into this study. The report says that research software, not a medical device, made it. The pictures show the scan and no name.</source>
        <translation>Sie kommen in diese Studie. Der Bericht sagt, dass er mit Forschungssoftware gemacht ist, nicht mit einem Medizinprodukt. Die Bilder zeigen die Aufnahme und keinen Namen.</translation>
    </message>
    <message>
        <source>Send</source>
        <translation>Senden</translation>
    </message>
    <message>
        <source>Send the corrected outline</source>
        <translation>Korrigierten Umriss senden</translation>
    </message>
    <message>
        <source>A segmentation (SEG) of %1. %2</source>
        <translation>Eine Segmentierung (SEG) von %1. %2</translation>
    </message>
    <message>
        <source>It goes into this study as a new series, made with research software, not a medical device. The original outline is not changed.</source>
        <translation>Sie kommt als neue Serie in diese Studie, gemacht mit Forschungssoftware, nicht mit einem Medizinprodukt. Der Umriss, der korrigiert wurde, bleibt.</translation>
    </message>
</context>
<context>
    <name>SeriesCard</name>
    <message>
        <source>Opens this series</source>
        <translation>Öffnet diese Serie</translation>
    </message>
    <message>
        <source>★ Recommended: %1</source>
        <translation>★ Empfohlen: %1</translation>
    </message>
    <message>
        <source>Cannot be felt: %1</source>
        <translation>Kann nicht gefühlt werden: %1</translation>
    </message>
</context>
<context>
    <name>SeriesList</name>
    <message>
        <source>★ Recommended: %1</source>
        <translation>★ Empfohlen: %1</translation>
    </message>
    <message>
        <source>%1
ID %2, study of %3</source>
        <translation>%1
ID %2, Studie vom %3</translation>
    </message>
</context>
<context>
    <name>SeriesWords</name>
    <message>
        <source>slices every %1 mm</source>
        <translation>Schichten alle %1 mm</translation>
    </message>
    <message>
        <source>sharp kernel %1</source>
        <translation>scharfer Kern %1</translation>
    </message>
    <message>
        <source>soft kernel %1</source>
        <translation>weicher Kern %1</translation>
    </message>
    <message>
        <source>%1 mm thick</source>
        <translation>%1 mm dick</translation>
    </message>
    <message>
        <source>every %1 mm</source>
        <translation>alle %1 mm</translation>
    </message>
    <message>
        <source>without a description</source>
        <translation>ohne Beschreibung</translation>
    </message>
    <message>
        <source>1 slice</source>
        <translation>1 Schicht</translation>
    </message>
    <message>
        <source>%1 slices</source>
        <translation>%1 Schichten</translation>
    </message>
    <message>
        <source>%1 frames</source>
        <translation>%1 Bilder</translation>
    </message>
    <message>
        <source>not a volume</source>
        <translation>kein Volumen</translation>
    </message>
</context>
<context>
    <name>SessionController</name>
    <message>
        <source>Clutch</source>
        <translation>Auskuppeln</translation>
    </message>
</context>
<context>
    <name>SessionState</name>
    <message>
        <source>%1 took %2 s</source>
        <translation>%1 dauerte %2 s</translation>
    </message>
    <message>
        <source>Off: no stylus is connected</source>
        <translation>Aus: es ist kein Stift verbunden</translation>
    </message>
    <message>
        <source>Stopped: %1</source>
        <translation>Angehalten: %1</translation>
    </message>
    <message>
        <source>Ready: clutched, move your hand or the view freely</source>
        <translation>Bereit: ausgekuppelt, Hand und Ansicht frei bewegen</translation>
    </message>
    <message>
        <source>Ready: the stylus is starting</source>
        <translation>Bereit: der Stift startet</translation>
    </message>
    <message>
        <source>Ready: homing, move the stylus as its maker says</source>
        <translation>Bereit: Referenzfahrt, den Stift wie vom Hersteller beschrieben bewegen</translation>
    </message>
    <message>
        <source>Ready: to home it, %1</source>
        <translation>Bereit: zur Referenzfahrt %1</translation>
    </message>
    <message>
        <source>The stylus does not answer: check its plug and power, then open it again.</source>
        <translation>Der Stift antwortet nicht: prüfen Sie Stecker und Strom, dann öffnen Sie ihn neu.</translation>
    </message>
    <message>
        <source>Stopped: the stylus may still push. Switch its power off. %1</source>
        <translation>Angehalten: Der Stift drückt vielleicht noch. Schalten Sie seinen Strom ab. %1</translation>
    </message>
    <message>
        <source>Feeling: forces are on</source>
        <translation>Fühlen: die Kraft ist an</translation>
    </message>
    <message>
        <source>Feeling: the motors are warm, so the force is only %1 N</source>
        <translation>Fühlen: Die Motoren sind warm, die Kraft beträgt nur %1 N</translation>
    </message>
    <message>
        <source>Feeling: forces are coming up</source>
        <translation>Fühlen: die Kraft steigt an</translation>
    </message>
    <message>
        <source>Ready: no force. Feel turns it on</source>
        <translation>Bereit: keine Kraft. Fühlen schaltet sie ein</translation>
    </message>
    <message>
        <source>Ready: the force is going down</source>
        <translation>Bereit: die Kraft geht zurück</translation>
    </message>
</context>
<context>
    <name>SliceView</name>
    <message>
        <source>Axial</source>
        <translation>Axial</translation>
    </message>
    <message>
        <source>Coronal</source>
        <translation>Koronal</translation>
    </message>
    <message>
        <source>Sagittal</source>
        <translation>Sagittal</translation>
    </message>
    <message>
        <source>%1 mm thick</source>
        <translation>%1 mm dick</translation>
    </message>
    <message>
        <source>every %1 mm</source>
        <translation>alle %1 mm</translation>
    </message>
    <message>
        <source>zoom %1 %</source>
        <translation>Zoom %1 %</translation>
    </message>
</context>
<context>
    <name>StartPage</name>
    <message>
        <source>Drop a DICOM folder here</source>
        <translation>Einen DICOM-Ordner hier ablegen</translation>
    </message>
    <message>
        <source>or a scan in NIfTI, NRRD or MetaImage, or a zipped study</source>
        <translation>oder eine Aufnahme in NIfTI, NRRD oder MetaImage oder eine gezippte Studie</translation>
    </message>
    <message>
        <source>Open a DICOM folder…</source>
        <translation>Einen DICOM-Ordner öffnen…</translation>
    </message>
    <message>
        <source>Search an archive</source>
        <translation>Ein Archiv durchsuchen</translation>
    </message>
    <message>
        <source>Recently opened</source>
        <translation>Zuletzt geöffnet</translation>
    </message>
    <message>
        <source>A patient without a name</source>
        <translation>Ein Patient ohne Namen</translation>
    </message>
    <message>
        <source>   ID %1</source>
        <translation>   ID %1</translation>
    </message>
    <message>
        <source>Study without a date</source>
        <translation>Studie ohne Datum</translation>
    </message>
    <message>
        <source>Study of %1</source>
        <translation>Studie vom %1</translation>
    </message>
</context>
<context>
    <name>StructuresSection</name>
    <message>
        <source>Made of contours that the scene contains</source>
        <translation>In der Szene gezeichnet</translation>
    </message>
    <message>
        <source>Volume %1 ml (first drawn: %2 ml). %3 ml were added, %4 ml removed. The edge moved %5 mm at most.</source>
        <translation>%1 ml, gezeichnet %2 ml: %3 ml hinzugefügt, %4 ml weggenommen. Der Umriss wurde um höchstens %5 mm verschoben.</translation>
    </message>
    <message>
        <source>No structures were found there (DICOM SEG or RTSTRUCT).</source>
        <translation>Dort wurden keine Strukturen gefunden (DICOM SEG oder RTSTRUCT).</translation>
    </message>
    <message>
        <source>The outline is shown as it is in the file.</source>
        <translation>Der Umriss ist gezeigt, wie er in der Datei ist.</translation>
    </message>
    <message>
        <source>outside the scan</source>
        <translation>außerhalb der Aufnahme</translation>
    </message>
    <message>
        <source>Reading…</source>
        <translation>Lesen…</translation>
    </message>
    <message>
        <source>Add structures…</source>
        <translation>Strukturen hinzufügen…</translation>
    </message>
    <message>
        <source>Adds files, DICOM SEG or RTSTRUCT. Those in the scan&apos;s folder are found automatically.</source>
        <translation>DICOM SEG oder RTSTRUCT. Die im Ordner der Aufnahme werden mit ihr gefunden.</translation>
    </message>
    <message>
        <source>Opacity</source>
        <translation>Deckkraft</translation>
    </message>
    <message>
        <source>Opacity of the surfaces in the volume view</source>
        <translation>Deckkraft der Flächen in der Volumenansicht</translation>
    </message>
    <message>
        <source>Boundary</source>
        <translation>Grenze</translation>
    </message>
    <message>
        <source>The structure&apos;s edge resists the stylus like the wall of an organ</source>
        <translation>Ihr Rand hält den Stift auf wie die Wand eines Organs</translation>
    </message>
    <message>
        <source>Boundary of %1</source>
        <translation>Grenze von %1</translation>
    </message>
    <message>
        <source>Keep out</source>
        <translation>Sperren</translation>
    </message>
    <message>
        <source>The stylus is pushed back as soon as it is in a margin around the structure</source>
        <translation>Der Stift wird zurückgedrückt, sobald er der Struktur näher als der Sicherheitsabstand kommt</translation>
    </message>
    <message>
        <source>Keep out of %1</source>
        <translation>%1 sperren</translation>
    </message>
    <message>
        <source> mm</source>
        <translation> mm</translation>
    </message>
    <message>
        <source>Only inside</source>
        <translation>Nur innen</translation>
    </message>
    <message>
        <source>Choose a mode of the scene that is then felt only inside this structure</source>
        <translation>Ein Modus der Szene wird nur in ihr gefühlt</translation>
    </message>
    <message>
        <source>%1 only inside %2</source>
        <translation>%1 nur in %2</translation>
    </message>
    <message>
        <source>Add structures</source>
        <translation>Strukturen hinzufügen</translation>
    </message>
    <message>
        <source>Color %1</source>
        <translation>Farbe von %1</translation>
    </message>
    <message>
        <source>%1; %2 cannot be felt here</source>
        <translation>%1; %2 sind hier nicht zu fühlen</translation>
    </message>
    <message>
        <source>Check the box to show it in the views. A double click chooses its color.</source>
        <translation>Das Kästchen ankreuzen, um sie in den Ansichten zu zeigen. Ein Doppelklick wählt ihre Farbe.</translation>
    </message>
    <message>
        <source>Width of the keep-out margin. The footer warns while the stylus is in it</source>
        <translation>Der Sicherheitsabstand einer Sperre; die Fußzeile warnt, solange der Stift darin ist</translation>
    </message>
    <message>
        <source>Structures (*.dcm *);;All files (*)</source>
        <translation>Strukturen (*.dcm *);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>Correct</source>
        <translation>Korrigieren</translation>
    </message>
    <message>
        <source>Lists the doubtful places of the outline and lets you correct it: see the guide</source>
        <translation>Listet die zweifelhaften Stellen ihres Umrisses und ermöglicht, ihn zu korrigieren (siehe Anleitung)</translation>
    </message>
    <message>
        <source>Volume %1 ml (in the file: %2 ml). %3 ml were added, %4 ml removed. The edge moved %5 mm at most.</source>
        <translation>%1 ml, in der Datei %2 ml: %3 ml hinzugefügt, %4 ml weggenommen. Der Umriss wurde um höchstens %5 mm verschoben.</translation>
    </message>
    <message>
        <source>The structure reaches %1 mm into %2.</source>
        <translation>Er reicht %1 mm in %2 hinein.</translation>
    </message>
    <message>
        <source>Distance to %1: %2 mm. The keep-out margin of %1 is %3 mm wide.</source>
        <translation>Abstand zu %1: %2 mm. Die Sperre um %1 ist %3 mm breit.</translation>
    </message>
</context>
<context>
    <name>StylusSection</name>
    <message>
        <source>Look for styluses again</source>
        <translation>Neu nach Stiften suchen</translation>
    </message>
    <message>
        <source>Connect</source>
        <translation>Verbinden</translation>
    </message>
    <message>
        <source>Stiffness</source>
        <translation>Steifigkeit</translation>
    </message>
    <message>
        <source> N/m</source>
        <translation> N/m</translation>
    </message>
    <message>
        <source>Force limit</source>
        <translation>Kraftgrenze</translation>
    </message>
    <message>
        <source> N</source>
        <translation> N</translation>
    </message>
    <message>
        <source>Reach</source>
        <translation>Reichweite</translation>
    </message>
    <message>
        <source>Scan</source>
        <translation>Aufnahme</translation>
    </message>
    <message>
        <source>The whole scan is in the stylus&apos; reach.</source>
        <translation>Die ganze Aufnahme ist in Reichweite des Stifts.</translation>
    </message>
    <message>
        <source>View</source>
        <translation>Ansicht</translation>
    </message>
    <message>
        <source>The workspace of the stylus covers what the 3D view shows, and is rotated like the view.</source>
        <translation>Was die 3D-Ansicht zeigt, ist in Reichweite, gedreht wie die Ansicht.</translation>
    </message>
    <message>
        <source>1:1</source>
        <translation>1:1</translation>
    </message>
    <message>
        <source>1 mm of the hand is 1 mm in the patient.</source>
        <translation>1 mm der Hand ist 1 mm im Patienten.</translation>
    </message>
    <message>
        <source>Clutch</source>
        <translation>Auskuppeln</translation>
    </message>
    <message>
        <source>While it is pressed, the hand moves and the stylus stays where it is in the patient: move the hand to a better place, or turn the view. The stylus&apos; first button does the same.</source>
        <translation>Solange gedrückt, bewegt sich die Hand, und der Stift bleibt im Patienten, wo er ist: die Hand bequemer legen oder die Ansicht drehen. Die erste Taste des Stifts tut dasselbe.</translation>
    </message>
    <message>
        <source>Align the stylus with the view after clutching</source>
        <translation>Stift nach dem Auskuppeln an der Ansicht ausrichten</translation>
    </message>
    <message>
        <source>After clutching, moving the hand to the right moves the stylus to the right in the 3D view.</source>
        <translation>Nach dem Auskuppeln führt eine Bewegung der Hand nach rechts den Stift in der 3D-Ansicht nach rechts.</translation>
    </message>
    <message>
        <source>Slices follow</source>
        <translation>Schichten folgen</translation>
    </message>
    <message>
        <source>While the proxy moves, the views show the slices through it.</source>
        <translation>Die Schichten durch den Proxy werden gezeigt, während er sich bewegt.</translation>
    </message>
    <message>
        <source>Go to stylus</source>
        <translation>Zum Stift</translation>
    </message>
    <message>
        <source>Shows the slices through the stylus. From then on they follow it again.</source>
        <translation>Zeigt die Schichten durch den Stift. Von da an folgen sie ihm wieder.</translation>
    </message>
    <message>
        <source>Simulated (mouse and keyboard)</source>
        <translation>Simuliert (Maus und Tastatur)</translation>
    </message>
    <message>
        <source> (no permission)</source>
        <translation> (keine Berechtigung)</translation>
    </message>
    <message>
        <source>Research software, not a medical device: it must not guide a diagnosis or a treatment. Esc takes the force away at any time.</source>
        <translation>Forschungssoftware, kein Medizinprodukt: nicht für Diagnose oder Behandlung verwenden. Esc nimmt die Kraft jederzeit weg.</translation>
    </message>
    <message>
        <source>Disconnect</source>
        <translation>Trennen</translation>
    </message>
    <message>
        <source>Open a scan first.</source>
        <translation>Erst eine Aufnahme öffnen.</translation>
    </message>
    <message>
        <source>the device gives no force</source>
        <translation>er gibt keine Kraft</translation>
    </message>
    <message>
        <source>the device's own limits: %1 N/m, %2 N (%3 N continuously)</source>
        <translation>Grenzen des Geräts: %1 N/m, %2 N (%3 N auf Dauer)</translation>
    </message>
    <message>
        <source>torque stays zero</source>
        <translation>das Drehmoment bleibt null</translation>
    </message>
    <message>
        <source>the device&apos;s own watchdog: %1</source>
        <translation>seine eigene Überwachung: %1</translation>
    </message>
    <message>
        <source>No guardian was found: if the program ends or hangs, only the device itself removes the force (%1). Install palpate-guardian.</source>
        <translation>Kein Wächter gefunden: Wenn das Programm endet oder hängt, nimmt nur das Gerät seine Kraft weg (%1). palpate-guardian installieren.</translation>
    </message>
    <message>
        <source>%1 mm of patient per mm of hand</source>
        <translation>1 mm der Hand sind %1 mm im Patienten</translation>
    </message>
    <message>
        <source>no scan yet</source>
        <translation>noch keine Aufnahme</translation>
    </message>
    <message>
        <source>Reach: %1</source>
        <translation>Reichweite: %1</translation>
    </message>
</context>
<context>
    <name>StylusViews</name>
    <message>
        <source>%1 mm above</source>
        <translation>%1 mm darüber</translation>
    </message>
    <message>
        <source>%1 mm below</source>
        <translation>%1 mm darunter</translation>
    </message>
    <message>
        <source>%1 mm in front</source>
        <translation>%1 mm davor</translation>
    </message>
    <message>
        <source>%1 mm behind</source>
        <translation>%1 mm dahinter</translation>
    </message>
    <message>
        <source>%1 mm to the left</source>
        <translation>%1 mm links</translation>
    </message>
    <message>
        <source>%1 mm to the right</source>
        <translation>%1 mm rechts</translation>
    </message>
</context>
<context>
    <name>TissuesSection</name>
    <message>
        <source>A scene defines which boundaries are felt. The first in the list is the one found in this scan.</source>
        <translation>Eine Szene sagt, was gefühlt wird. Die erste der Liste ist die in dieser Aufnahme gefundene.</translation>
    </message>
    <message>
        <source>Found in this scan</source>
        <translation>In dieser Aufnahme gefunden</translation>
    </message>
    <message>
        <source>Open…</source>
        <translation>Öffnen…</translation>
    </message>
    <message>
        <source>Opens a scene from a file</source>
        <translation>Die Datei einer Szene</translation>
    </message>
    <message>
        <source>Save…</source>
        <translation>Speichern…</translation>
    </message>
    <message>
        <source>Saves this scene to a file</source>
        <translation>Speichert diese Szene in eine Datei</translation>
    </message>
    <message>
        <source>No boundaries were found in this scan.</source>
        <translation>In dieser Aufnahme wurden keine Grenzen gefunden.</translation>
    </message>
    <message>
        <source>Made for %1. This scan is of another kind.</source>
        <translation>Für %1 gemacht. Diese Aufnahme ist von anderer Art.</translation>
    </message>
    <message>
        <source>Restored from the state file</source>
        <translation>Aus der Zustandsdatei wiederhergestellt</translation>
    </message>
    <message>
        <source>%1, edited</source>
        <translation>%1, geändert</translation>
    </message>
    <message>
        <source>Choose scene</source>
        <translation>Szene wählen</translation>
    </message>
    <message>
        <source>Open scene</source>
        <translation>Szene öffnen</translation>
    </message>
    <message>
        <source>Scenes (*.json)</source>
        <translation>Szenen (*.json)</translation>
    </message>
    <message>
        <source>Save scene</source>
        <translation>Szene speichern</translation>
    </message>
    <message>
        <source>No boundaries yet: open a scan.</source>
        <translation>Noch keine Grenzen: eine Aufnahme öffnen.</translation>
    </message>
</context>
<context>
    <name>VolumeLookBox</name>
    <message>
        <source>How the volume is drawn. 'Felt boundaries' shows each boundary that is switched on, in its color.</source>
        <translation>Wie das Volumen gezeigt wird. Gefühlte Grenzen: jede eingeschaltete in ihrer Farbe.</translation>
    </message>
    <message>
        <source>From the state file</source>
        <translation>Aus der Zustandsdatei</translation>
    </message>
    <message>
        <source>Felt boundaries</source>
        <translation>Gefühlte Grenzen</translation>
    </message>
    <message>
        <source>CT skin</source>
        <translation>Haut (CT)</translation>
    </message>
    <message>
        <source>CT bone</source>
        <translation>Knochen (CT)</translation>
    </message>
    <message>
        <source>CT lung</source>
        <translation>Lunge (CT)</translation>
    </message>
    <message>
        <source>CT vessels</source>
        <translation>Gefäße (CT)</translation>
    </message>
    <message>
        <source>MR</source>
        <translation>MR</translation>
    </message>
    <message>
        <source>MR vessels</source>
        <translation>Gefäße (MR)</translation>
    </message>
</context>
<context>
    <name>ArchiveDialog</name>
    <message>
        <source>Add an archive</source>
        <translation>Archiv eintragen</translation>
    </message>
    <message>
        <source>Name</source>
        <translation>Name</translation>
    </message>
    <message>
        <source>The name of the archive in this program</source>
        <translation>Der Name des Archivs in diesem Programm</translation>
    </message>
    <message>
        <source>Host</source>
        <translation>Rechner</translation>
    </message>
    <message>
        <source>The name or address of the archive&apos;s machine</source>
        <translation>Name oder Adresse seines Rechners</translation>
    </message>
    <message>
        <source>Port</source>
        <translation>Port</translation>
    </message>
    <message>
        <source>Its DICOM port</source>
        <translation>Sein DICOM-Port</translation>
    </message>
    <message>
        <source>Its AE title</source>
        <translation>Sein AE-Titel</translation>
    </message>
    <message>
        <source>The archive&apos;s AE title (ask its administrator)</source>
        <translation>Der AE-Titel des Archivs (beim Betreiber erfragen)</translation>
    </message>
    <message>
        <source>Our AE title</source>
        <translation>Unser AE-Titel</translation>
    </message>
    <message>
        <source>The AE title of this program; the archive has to know it</source>
        <translation>Der AE-Titel dieses Programms; das Archiv muss ihn kennen</translation>
    </message>
    <message>
        <source>Fetch with C-GET (the archive must support it)</source>
        <translation>Mit C-GET holen (das Archiv muss es können)</translation>
    </message>
    <message>
        <source>With C-GET the archive answers on our connection. Without it, the archive connects to our port (C-MOVE).</source>
        <translation>Mit C-GET antwortet das Archiv auf unserer Verbindung. Ohne es verbindet sich das Archiv mit unserem Port (C-MOVE).</translation>
    </message>
    <message>
        <source>Our port</source>
        <translation>Unser Port</translation>
    </message>
    <message>
        <source>For C-MOVE: the archive must know this port, our AE title and this machine&apos;s address</source>
        <translation>Für C-MOVE: Das Archiv muss diesen Port, unseren AE-Titel und die Adresse dieses Rechners kennen</translation>
    </message>
    <message>
        <source>Echo</source>
        <translation>Prüfen</translation>
    </message>
    <message>
        <source>Tests whether the archive answers and accepts our AE title (C-ECHO)</source>
        <translation>Ob es antwortet und uns kennt (C-ECHO)</translation>
    </message>
    <message>
        <source>…</source>
        <translation>…</translation>
    </message>
    <message>
        <source>Certificates and keys (*.pem *.crt *.cer *.key);;All files (*)</source>
        <translation>Zertifikate und Schlüssel (*.pem *.crt *.cer *.key);;Alle Dateien (*)</translation>
    </message>
    <message>
        <source>TLS: authority</source>
        <translation>TLS: Aussteller</translation>
    </message>
    <message>
        <source>The certificate (PEM) of the authority that signed the archive&apos;s certificate. Empty: no TLS.</source>
        <translation>Das Zertifikat (PEM) der Stelle, die das Zertifikat des Archivs ausgestellt hat. Leer: kein TLS.</translation>
    </message>
    <message>
        <source>TLS: certificate</source>
        <translation>TLS: Zertifikat</translation>
    </message>
    <message>
        <source>Our own certificate (PEM). It is needed if the archive asks for one, and for C-MOVE.</source>
        <translation>Unser eigenes Zertifikat (PEM). Es ist nötig, wenn das Archiv es verlangt, und für C-MOVE.</translation>
    </message>
    <message>
        <source>TLS: key</source>
        <translation>TLS: Schlüssel</translation>
    </message>
    <message>
        <source>The private key of our certificate (PEM), without a pass phrase</source>
        <translation>Sein privater Schlüssel (PEM), ohne Kennwort</translation>
    </message>
    <message>
        <source>The host name in the archive&apos;s certificate, if it differs from the host above</source>
        <translation>Der Rechnername im Zertifikat des Archivs, wenn er vom obigen abweicht</translation>
    </message>
    <message>
        <source>TLS: name</source>
        <translation>TLS: Name</translation>
    </message>
</context>
<context>
    <name>ServerScan</name>
    <message>
        <source>Looking for a copy on this machine</source>
        <translation>Eine Kopie wird hier gesucht</translation>
    </message>
    <message>
        <source>Fetching from the server</source>
        <translation>Wird vom Server geholt</translation>
    </message>
    <message>
        <source>Comparing with the server</source>
        <translation>Wird mit dem Server verglichen</translation>
    </message>
    <message>
        <source>Comparing the copy on this machine</source>
        <translation>Die Kopie hier wird verglichen</translation>
    </message>
</context>
<context>
    <name>SharingModel</name>
    <message>
        <source>Scene from 3D Slicer</source>
        <translation>Szene aus 3D Slicer</translation>
    </message>
    <message>
        <source>Marks from 3D Slicer</source>
        <translation>Marken aus 3D Slicer</translation>
    </message>
</context>
<context>
    <name>SharingSection</name>
    <message>
        <source>Share with 3D Slicer</source>
        <translation>Mit 3D Slicer teilen</translation>
    </message>
    <message>
        <source>3D Slicer on this computer sees stylus, force, marks and surfaces, and sends scenes, marks and outlines. It can neither turn the force on nor raise a limit.</source>
        <translation>3D Slicer auf diesem Rechner sieht Stift, Kraft, Marken und Oberflächen und sendet Szenen, Marken und Umrisse. Es kann weder die Kraft einschalten noch eine Grenze erhöhen.</translation>
    </message>
    <message>
        <source>The port that 3D Slicer connects to (OpenIGTLink)</source>
        <translation>Der Port, mit dem sich 3D Slicer verbindet (OpenIGTLink)</translation>
    </message>
    <message>
        <source>Port</source>
        <translation>Port</translation>
    </message>
    <message>
        <source>nobody is connected</source>
        <translation>niemand ist verbunden</translation>
    </message>
    <message>
        <source>1 client</source>
        <translation>1 Teilnehmer</translation>
    </message>
    <message>
        <source>%1 clients</source>
        <translation>%1 Teilnehmer</translation>
    </message>
    <message>
        <source>Listens on 127.0.0.1, port %1: %2.</source>
        <translation>Wartet auf 127.0.0.1, Port %1: %2.</translation>
    </message>
</context>
<context>
    <name>WorkBar</name>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
</context>
<context>
    <name>UnsavedQuestion</name>
    <message>
        <source>the edited scene</source>
        <translation>die bearbeitete Szene</translation>
    </message>
    <message>
        <source>the corrected outline of %1</source>
        <translation>der korrigierte Umriss von %1</translation>
    </message>
    <message>
        <source>1 mark</source>
        <translation>1 Marke</translation>
    </message>
    <message>
        <source>%1 marks</source>
        <translation>%1 Marken</translation>
    </message>
    <message>
        <source>Not saved</source>
        <translation>Nicht gespeichert</translation>
    </message>
    <message>
        <source>%1 Not saved: %2.</source>
        <translation>%1 Nicht gespeichert: %2.</translation>
    </message>
    <message>
        <source>Save writes all that is open to a state file. File &gt; Load State opens it again.</source>
        <translation>Speichern schreibt alles, was offen ist, in eine Zustandsdatei. Im Menü File &gt; Load State wird sie wieder geöffnet.</translation>
    </message>
    <message>
        <source>Save…</source>
        <translation>Speichern…</translation>
    </message>
    <message>
        <source>Discard</source>
        <translation>Verwerfen</translation>
    </message>
    <message>
        <source>Cancel</source>
        <translation>Abbrechen</translation>
    </message>
</context>
<context>
    <name>Messages</name>
    <message>
        <source>{} was not opened: another frame was chosen while it was read. Open it again to see what was recorded on this frame.</source>
        <translation>{} wurde nicht geöffnet: Beim Lesen wurde ein anderes Bild der Folge gewählt. Erneut öffnen, um zu sehen, was an diesem Bild aufgezeichnet wurde.</translation>
    </message>
    <message>
        <source>{} was closed: another frame is shown. Open it again to see what was recorded on this frame.</source>
        <translation>{} wurde geschlossen: Ein anderes Bild der Folge wird gezeigt. Erneut öffnen, um zu sehen, was an diesem Bild aufgezeichnet wurde.</translation>
    </message>
    <message>
        <source>The stylus reported an impossible pose; home it again, then clear the fault and turn the force on.</source>
        <translation>Der Stift meldete eine unmögliche Lage: referenzieren Sie ihn neu, dann quittieren Sie die Störung und schalten die Kraft ein.</translation>
    </message>
    <message>
        <source>The scene asked for a force that is not a number; keep the recording, then clear the fault and turn the force on.</source>
        <translation>Die Szene verlangte eine Kraft, die keine Zahl ist: behalten Sie die Aufzeichnung, dann quittieren Sie die Störung und schalten die Kraft ein.</translation>
    </message>
    <message>
        <source>The stylus is gone: check its plug and power, open it again, then clear the fault and turn the force on.</source>
        <translation>Der Stift ist weg: prüfen Sie Stecker und Strom, verbinden Sie ihn neu, dann quittieren Sie die Störung und schalten die Kraft ein.</translation>
    </message>
    <message>
        <source>The stylus stopped sending poses: check its plug and power, then clear the fault and turn the force on.</source>
        <translation>Der Stift meldet keine Lage mehr: prüfen Sie Stecker und Strom, dann quittieren Sie die Störung und schalten die Kraft ein.</translation>
    </message>
    <message>
        <source>No new force was computed: the scene&apos;s thread is stalled; wait for it, then clear the fault and turn the force on.</source>
        <translation>Es wurde keine neue Kraft berechnet, die Szene wird aufgehalten: warten Sie, dann quittieren Sie die Störung und schalten die Kraft ein.</translation>
    </message>
    <message>
        <source>The servo loop was held up: close other heavy programs, then clear the fault and turn the force on.</source>
        <translation>Die Regelschleife wurde aufgehalten: schließen Sie andere große Programme, dann quittieren Sie die Störung und schalten die Kraft ein.</translation>
    </message>
    <message>
        <source>The stylus moved faster than allowed: hold it, then clear the fault and turn the force on.</source>
        <translation>Der Stift bewegte sich schneller als erlaubt: halten Sie ihn fest, dann quittieren Sie die Störung und schalten die Kraft ein.</translation>
    </message>
    <message>
        <source>The panel stopped answering: wait until it does, then clear the fault and turn the force on.</source>
        <translation>Das Bedienfeld antwortete nicht mehr: warten Sie, bis es wieder antwortet, dann quittieren Sie die Störung und schalten die Kraft ein.</translation>
    </message>
    <message>
        <source>The stylus was unplugged: check its plug and power, then open it again.</source>
        <translation>Der Stift wurde ausgesteckt: prüfen Sie Stecker und Strom, dann verbinden Sie ihn neu.</translation>
    </message>
    <message>
        <source>The stylus stopped sending poses: check its plug and power, then open it again.</source>
        <translation>Der Stift meldet keine Lage mehr: prüfen Sie Stecker und Strom, dann verbinden Sie ihn neu.</translation>
    </message>
    <message>
        <source>The stylus is too slow to push safely: use another socket, without a hub, then open it again.</source>
        <translation>Der Stift ist zu langsam für sichere Kräfte: nehmen Sie eine andere Buchse, ohne Hub, dann verbinden Sie ihn neu.</translation>
    </message>
    <message>
        <source>The stylus reported a pose that no hand can reach: open it again and home it; check its settings file.</source>
        <translation>Der Stift meldete eine Lage, die keine Hand erreicht: verbinden und referenzieren Sie ihn neu; prüfen Sie seine Einstellungsdatei.</translation>
    </message>
    <message>
        <source>The stylus lost its home: open it again and home it.</source>
        <translation>Der Stift hat seine Referenz verloren: verbinden und referenzieren Sie ihn neu.</translation>
    </message>
    <message>
        <source>The program was stopped or held up, and does not know where the hand is now: open the stylus again.</source>
        <translation>Das Programm wurde angehalten oder aufgehalten und weiß nicht, wo die Hand jetzt ist: verbinden Sie den Stift neu.</translation>
    </message>
    <message>
        <source>The machine slept, or is about to sleep: when it is awake, open the stylus again.</source>
        <translation>Der Rechner schlief oder geht gleich schlafen: verbinden Sie den Stift neu, wenn er wach ist.</translation>
    </message>
    <message>
        <source>The stylus does not take forces: check its power and its force button, then open it again.</source>
        <translation>Der Stift nimmt keine Kräfte an: prüfen Sie seinen Strom und seinen Kraftschalter, dann verbinden Sie ihn neu.</translation>
    </message>
    <message>
        <source>The stylus&apos;s own safety took the force away: let its motors cool, then open it again.</source>
        <translation>Der Stift hat selbst die Kraft weggenommen: lassen Sie seine Motoren abkühlen, dann verbinden Sie ihn neu.</translation>
    </message>
    <message>
        <source>Another program pushes the stylus, too: close that program, then open it again.</source>
        <translation>Auch ein anderes Programm treibt den Stift an: schließen Sie es, dann verbinden Sie ihn neu.</translation>
    </message>
    <message>
        <source>The guardian of the stylus ended or hangs: open the stylus again, which starts another.</source>
        <translation>Der Wächter des Stifts ist beendet oder hängt: verbinden Sie den Stift neu, das startet einen anderen.</translation>
    </message>
    <message>
        <source>ParaView&apos;s session ended, and the scan went with it. Open a scan, then press Feel</source>
        <translation>ParaViews Sitzung endete, und mit ihr die Aufnahme. Öffnen Sie eine Aufnahme, dann drücken Sie Fühlen</translation>
    </message>
    <message>
        <source>the scan was deleted. Open a scan, then press Feel</source>
        <translation>die Aufnahme wurde gelöscht. Öffnen Sie eine Aufnahme, dann drücken Sie Fühlen</translation>
    </message>
    <message>
        <source>the scan is still being read. Wait until it is shown, then press Feel</source>
        <translation>die Aufnahme wird noch gelesen. Warten Sie, bis sie gezeigt wird, dann drücken Sie Fühlen</translation>
    </message>
    <message>
        <source>no view shows the scan. Show it again (its eye in ParaView&apos;s list of open data, the Pipeline Browser), then press Feel</source>
        <translation>keine Ansicht zeigt die Aufnahme. Zeigen Sie sie wieder (ihr Auge in ParaViews Liste offener Daten, dem Pipeline Browser), dann drücken Sie Fühlen</translation>
    </message>
    <message>
        <source>another scan, {}, is chosen in ParaView&apos;s list of open data, the Pipeline Browser. Choose {} there, then press Feel</source>
        <translation>eine andere Aufnahme, {}, ist in ParaViews Liste offener Daten, dem Pipeline Browser, gewählt. Wählen Sie dort {}, dann drücken Sie Fühlen</translation>
    </message>
    <message>
        <source>the views show {}, and the stylus has {}. Go back to the one that the stylus has, then press Feel</source>
        <translation>die Ansichten zeigen {}, und der Stift hat {}. Gehen Sie zu der zurück, die der Stift hat, dann drücken Sie Fühlen</translation>
    </message>
    <message>
        <source>none of its images can be read</source>
        <translation>keines ihrer Bilder ist lesbar</translation>
    </message>
    <message>
        <source>a localizer, no volume</source>
        <translation>eine Übersichtsaufnahme, kein Volumen</translation>
    </message>
    <message>
        <source>one slice alone is no volume</source>
        <translation>eine Schicht allein ist kein Volumen</translation>
    </message>
</context>
<context>
    <name>Tissues</name>
    <message>
        <source>air</source>
        <translation>Luft</translation>
    </message>
    <message>
        <source>lung or foam</source>
        <translation>Lunge oder Schaumstoff</translation>
    </message>
    <message>
        <source>fat</source>
        <translation>Fett</translation>
    </message>
    <message>
        <source>soft tissue</source>
        <translation>Weichgewebe</translation>
    </message>
    <message>
        <source>bone</source>
        <translation>Knochen</translation>
    </message>
    <message>
        <source>metal</source>
        <translation>Metall</translation>
    </message>
    <message>
        <source>between tissues</source>
        <translation>zwischen Geweben</translation>
    </message>
    <message>
        <source>outside</source>
        <translation>außerhalb</translation>
    </message>
</context>
</TS>
