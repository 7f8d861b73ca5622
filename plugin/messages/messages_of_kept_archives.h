#pragma once

/// Messages about the configured archives and fetched data.

#include "solver/text/message.h"

namespace palpate::plugin::messages {

inline constexpr MessageRow kept_archives[] = {
    {"the archive could not send all; what came is kept",
     "fetch it again",
     {{"not-all-images-came", "not all images came: see the warnings"}}},
    {"the settings that are needed to reach an archive are incomplete",
     "",
     {{"no-archive-is-entered-yet",
       "no archive is entered yet: enter one with `palpate archive add NAME --host --port --called --calling`"},
      {"choose-one-of-the-archives-with-archive", "choose one of the archives with --archive: {}"},
      {"no-archive-is-entered", "no archive {} is entered; there are: {}"}}},
    {"the user's own files",
     "",
     {{"settings-cannot-be-read", "the settings {} cannot be read ({}): correct or delete the file"},
      {"settings-cannot-be-written",
       "the settings {} cannot be written ({}): make room, or get the right to write to the folder"},
      {"neither-nor-home-names-a-folder", "neither {} nor HOME names a folder for the settings: set one of them"},
      {"fetched-cannot-be-kept", "{} cannot be written ({}): make room, or get the right to write to the folder"},
      {"cannot-be-deleted", "{} cannot be deleted ({}): delete it by hand"}}},
    {"for your information",
     "nothing",
     {{"more-studies-than-these",
       "palpate: the archive holds more than these {} studies: narrow the search, or list more with --most"},
      {"fetched-stays", "palpate: what was fetched stays in {} until `palpate archive empty`"}}},
    {"what the archive that you asked says",
     "nothing",
     {{"archive-is-asked", "{} is asked…"},
      {"archive-answers", "{} answers and knows us as {} ({} ms)."},
      {"archive-holds-none-such", "The archive holds nothing of that kind."},
      {"archive-holds-more", "The archive holds more than these {} studies: type more of what you look for."},
      {"fetched-images",
       "Fetched: {} images, {} MiB. They are deleted when the program ends, unless Keep is ticked."}}},
    {"no archive has been entered in the panel or with `palpate archive add`",
     "",
     {{"no-archive-here-yet",
       "No archive is entered yet: press Add, and ask the archive's administrator for the five entries."}}},
    {"an archive is chosen by its name", "give it one", {{"archive-needs-a-name", "An archive needs a name."}}},
    {"the list above it says which and why",
     "have that kind of object allowed in the archive",
     {{"files-not-sent", "{} of {} files were not sent"}}},
    {"nothing was marked in that session",
     "press it where something is felt",
     {{"holds-no-marks",
       "{} holds no marks: the stylus' second button makes them, or the column `buttons` of a --path"}}},
    {"a path's column of buttons",
     "",
     {{"line-buttons-is-no-bit-mask", "{}, line {}: buttons {} is no bit mask: 0 is none, 1 the first, 2 the second"}}},
};

}  // namespace palpate::plugin::messages
