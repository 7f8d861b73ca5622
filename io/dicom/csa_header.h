#pragma once

/// Siemens' private CSA header ("SV10"), as nibabel and dcm2niix describe it: named lists of texts.

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace palpate::io::internal {

/// The numbers under a name; empty if the header is damaged, lacks the name or holds no numbers for it.
std::vector<double> csa_numbers(std::span<const std::byte> header, std::string_view name);

}  // namespace palpate::io::internal
