// SPDX-License-Identifier: BSL-1.0
// Works to cite for a set-up.
#pragma once

#include <string>
#include <vector>

namespace nysalt::program {

/// The parts of a run that decide what to cite. Empty ones are not part of it.
struct cited_setup {
  std::string system;                 // a name of `list`
  std::vector<std::string> methods;   // classical names of `list`
  std::vector<std::string> families;  // as they are
  std::vector<std::string> learned;   // families that were learned
  std::vector<std::string> metrics;   // of compare
  bool in_bath = false;
};

/// A work of the bibliography, and what it is cited for.
struct citation {
  std::string key;
  std::vector<std::string> reasons;
};

/// Each work once, in the order in which they are met. Throws refusal for what has no such name.
std::vector<citation> citations_for(const std::vector<cited_setup>& setups);

}  // namespace nysalt::program
