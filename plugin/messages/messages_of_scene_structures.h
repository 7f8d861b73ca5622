#pragma once

/// Messages about the structures of a scene.

#include "solver/text/message.h"

namespace palpate::plugin::messages {

inline constexpr MessageRow scene_structures[] = {
    {"the scene's `file` or `segment` does not match a structure in the file",
     "`palpate structures` lists them",
     {{"file-holds-no-structures", "{} holds no structures{}"},
      {"file-has-no-such-structure", "{} has no \"{}\"; there are: {}"},
      {"file-holds-several-of-that-name",
       "{} holds several structures \"{}\": name one by its number, or its file; there are: {}"},
      {"file-holds-several-structures",
       "{} holds several structures: name one by its number or name, as {}:NUMBER; there are: {}"}}},
    {"another program writes the file",
     "",
     {{"structure-rewritten-while-read",
       "{} was written while it was being read: wait for the other program, and try again"}}},
    {"two structures are compared",
     "choose two that were outlined on the same study",
     {{"structures-in-different-frames",
       "{} and {} lie in different frames of reference: nothing says how one lies in the other"}}},
    {"edits are applied",
     "",
     {{"edits-need-a-structure",
       "the edits do not begin with contours of a new structure: name the one that they correct (--structure)"}}},
    {"a recording holds no path: its structures are looked for beside the series",
     "",
     {{"structure-of-a-recording-is-not-here",
       "structure \"{}\": the file that it was felt from is not here: name it with --structures"}}},
    {"it belongs to another scan: it would be felt in the wrong place",
     "",
     {{"another-frame-of-reference",
       "{} lies in another frame of reference than the scan: choose one that was outlined on this study"}}},
    {"it was outlined on another scan, or saved with other axes (RAS for LPS)",
     "",
     {{"structure-lies-off-the-scan",
       "{}: \"{}\" lies wholly outside the scan: choose one that was outlined on this scan"}}},
    {"id or name of the patient are not those of the scan",
     "",
     {{"structure-of-another-patient",
       "{} was outlined on another patient than the scan's: choose one that was outlined on this study"},
      {"structure-of-another-patient-by-name",
       "{} names another patient than the scan, and no patient id shows that they are the same patient: choose one "
       "that was outlined on "
       "this study, or correct its name or id"},
      {"structure-of-a-patient-of-another-name",
       "{} calls the scan's patient by another name or id: check in the views that it lies in the right place"}}},
    {"a structure lies in another frame of reference, and a registration is looked for beside it",
     "put structures and registrations into a folder of their own",
     {{"too-many-files-beside-a-structure",
       "more than {} files lie beside {}: registrations (REG) are looked for only in the first ones"}}},
    {"a registration (REG) of the study joins it to the scan",
     "nothing, if it lies in the right place",
     {{"structure-is-registered", "{} lies in another frame of reference; the registration {} puts it on the scan"}}},
    {"",
     "name the folder or the file with the structures",
     {{"no-structures-in-what-was-given",
       "no structures in what was given: no DICOM SEG, RTSTRUCT or label map that can be read"}}},
    {"labels are compared with a scan (`palpate-bench forces --structures`)",
     "name labels that were drawn on that scan; `palpate structures LABELS --scan SERIES` says where they lie",
     {{"no-structure-lies-on-the-scan", "none of the structures given lies on the scan with a voxel inside"}}},
};

}  // namespace palpate::plugin::messages
