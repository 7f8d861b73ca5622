#include "modes/scene/tissue_colors.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace palpate::modes {

TissueKind kind_of(std::string_view boundary_name) {
  struct Word {
    std::string_view begins;
    TissueKind kind;
  };
  constexpr std::array words{Word{"skin", TissueKind::skin},
                             Word{"scalp", TissueKind::skin},
                             Word{"bone", TissueKind::bone},
                             Word{"dense bone", TissueKind::bone},
                             Word{"lung", TissueKind::lung},
                             Word{"airways", TissueKind::lung},
                             Word{"air inside", TissueKind::inner_air},
                             Word{"metal", TissueKind::metal},
                             Word{"guide", TissueKind::vessel},
                             Word{"table", TissueKind::table},
                             Word{"foam or cloth", TissueKind::table}};
  std::string name(boundary_name);
  std::ranges::transform(name, name.begin(),
                         [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  const auto word = std::ranges::find_if(words, [&](const Word& one) { return name.starts_with(one.begins); });
  return word == words.end() ? TissueKind::soft_tissue : word->kind;
}

}  // namespace palpate::modes
