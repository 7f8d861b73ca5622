#pragma once

/// Messages of `palpate serve` to its user and its clients.

#include "solver/text/message.h"

namespace palpate::plugin::messages {

inline constexpr MessageRow openigtlink[] = {
    {"a message of a client that is cut short, or that no OpenIGTLink program writes",
     "update the program that sends it; it is dropped or its connection closed, and the session goes on",
     {{"igtl-ends-early", "the message ends before its parts do"},
      {"igtl-not-a-message", "this is no message of OpenIGTLink, versions 1 to 3"},
      {"igtl-wrong-checksum", "the message's checksum is wrong"},
      {"igtl-body-too-large", "a message of type {} says that it has {} bytes; at most {} are taken"},
      {"igtl-not-a-number", "a coordinate is not a number"}}},
    {"STRING has a length of 16 bits",
     "a shorter text",
     {{"igtl-text-too-long", "a text of {} bytes; at most 65535 fit"},
      {"igtl-scene-too-long", "clients do not get the scene that is felt: it has {} bytes; at most {} fit"}}},
    {"an image that is no label map",
     "send a segmentation as a label map: whole numbers, one for each voxel, in one piece",
     {{"igtl-not-labels", "the image's voxels are no labels: a label is one whole number"},
      {"igtl-not-an-image", "the image's size is not that of its bytes, or its byte order or frame is unknown"},
      {"igtl-part-of-an-image", "this is a part of an image; only whole ones are taken"},
      {"igtl-no-labels", "{}: there are no labels or structures in it"}}},
    {"each takes memory and time",
     "name one again, or begin a new session",
     {{"igtl-too-many-maps", "label map \"{}\": there are {} already"}}},
    {"requests stay in memory until they are felt",
     "send it again, when what was sent before is felt",
     {{"igtl-too-much-waits", "{} \"{}\" has {} bytes, too many while {} bytes of others wait"}}},
    {"a session that is recorded: its label maps are kept beside the recording",
     "keep the folder with the recording: `palpate replay` finds them there",
     {{"igtl-map-kept", "palpate: label map \"{}\": kept for replay in {}"},
      {"igtl-map-not-kept", "palpate: label map \"{}\": cannot be kept for replay in {}: {}"}}},
    {"a scene of another session",
     "send the label map first",
     {{"igtl-no-such-map", "structure \"{}\": no label map \"{}\" was sent in this session"}}},
    {"the client runs on another machine",
     "send a label map, or name the file when `palpate serve` is started",
     {{"igtl-file-from-elsewhere", "{}: only a client on this machine may name a file"}}},
    {"a scene or a folder that cannot be felt; the one before stays",
     "follow the advice in the message",
     {{"igtl-refused", "refused: {}"}}},
    {"the network may only tighten what was set at the stylus",
     "nothing; or raise them at the stylus, by `--scene` or in the panel",
     {{"igtl-limits-stay", "limits or stiffness of the scene are reduced to those that were set at the stylus"}}},
    {"the owner of the session alone chooses how hand and patient meet: another mapping would move the stylus through "
     "the "
     "patient",
     "nothing; or begin the session with that scene",
     {{"igtl-workspace-stays", "the scene's workspace is not taken: the session keeps its own"}}},
    {"what is done at the stylus meanwhile stays",
     "fetch the scene as it is now, change it, and send it again",
     {{"igtl-scene-is-older", "the scene was changed at the stylus while this one was being prepared"}}},
    {"each frame that plays, and each change at the stylus, makes what was prepared out of date",
     "stop the playback, and send it again",
     {{"igtl-keeps-changing",
       "scan or scene changed {} times while this was being prepared: stop the playback, and send it again"}}},
    {"marks stay until the session ends",
     "send fewer, or begin a new session",
     {{"igtl-too-many-marks", "with these there would be {} marks; at most {} are kept"}}},
    {"the first client that sends something controls",
     "close that client, or go on reading",
     {{"igtl-another-client-controls", "another client controls; this one can only read"}}},
    {"a scene, a label map or marks came before a scan",
     "open a scan, or send its folder",
     {{"igtl-no-scan", "no scan is open yet: send the folder of one first"}}},
    {"a question for something that is not there",
     "ask later, or for something else",
     {{"igtl-nothing-to-get", "{}: there is nothing to get"}}},
    {"the port is taken, or the address is none of this machine",
     "another `--port`, or an address that `ip address` shows",
     {{"igtl-cannot-listen", "cannot listen on {}, port {}: {}"}}},
    {"`--host` was asked for",
     "use it in a network that you trust",
     {{"igtl-others-may-connect",
       "palpate: warning: anybody who reaches {} can read the places of stylus and marks and set scenes; nobody can "
       "turn "
       "the force on or raise a limit"}}},
    {"the session is shared",
     "connect Slicer's OpenIGTLinkIF to it",
     {{"igtl-listens", "palpate: listens on {}, port {}"}}},
    {"the session has ended",
     "nothing; or a client that reads faster",
     {{"igtl-served",
       "palpate: {} messages sent, {} replaced by newer ones; {} requests, {} replaced by newer ones; {} refused, {} "
       "passed "
       "over; {} clients disconnected or refused"}}},
};

}  // namespace palpate::plugin::messages
