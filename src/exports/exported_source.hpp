// SPDX-License-Identifier: BSL-1.0
// From what a user names to what is exported.
#pragma once

#include "comparison/method_source.hpp"
#include "export_request.hpp"
#include "exported_method.hpp"

namespace nysalt::program {

/// The method with the header of the exported file. Throws refusal for a method that is still to be learned,
/// that depends on step and frequency, or that was learned in a bath, and for a step at which a scheme was
/// not learned.
exported_method exported_from(const method_source& source, const export_request& request);

}  // namespace nysalt::program
