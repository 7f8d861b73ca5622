#pragma once

/// Messages about the choice of a series.

#include "solver/text/message.h"

namespace palpate::plugin::messages {

inline constexpr MessageRow choices[] = {
    {"as the list says",
     "name the folder with the images",
     {{"no-usable-series", "no usable series in {}{}; `palpate info` tells more"}}},
    {"what is in that folder is something else",
     "name the folder with the images",
     {{"none-is-an-image", ": of {} files none is an image, the first ({}) because: {}"}}},
    {"as listed",
     "name the folder with the images",
     {{"no-image-series-in-what-was-given", "no image series in what was given; the files and why are listed above"}}},
    {"several series, or none of that name",
     "choose from the list",
     {{"choose-a-series", "{}; choose one with --series N or --series UID:{}"},
      {"holds-series", "{} holds {} series"},
      {"there-is-no-series", "there is no series {} in {}"},
      {"volumes-do-not-fit-together", "series {} holds {} volumes that do not fit together"}}},
    {"there is no such time, b-value, echo or slice",
     "name one of those",
     {{"no-such-frame", "--frame {}: series {} has {} frame{}, counted from 0"}}},
};

}  // namespace palpate::plugin::messages
