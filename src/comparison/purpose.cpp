// SPDX-License-Identifier: BSL-1.0
#include "purpose.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "nysalt/losses/loss_choice.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

struct purpose {
  std::string_view name;
  std::string_view loss;  // empty: the usual one of the library
};
constexpr std::array all_purposes{
    purpose{for_state, ""},
    purpose{for_energy, "state:1"},  // trajectories give energies away for the phase
    purpose{for_distribution, "state:1"},
    purpose{for_sampling, "acceptance"},
};

}  // namespace

std::string purposes() {
  std::string all;
  for (const auto& [name, loss] : all_purposes) {
    if (!all.empty()) all += ", ";
    all += name;
  }
  return all;
}

std::string report_of_purpose(const learning_options& how) {
  return "learned " + (how.purpose.empty() ? "" : "for " + how.purpose + ", ") + "by the loss " + how.loss;
}

void settle_purpose(learning_options& how, const bath& around, const std::string& prefix, const char* usual) {
  if (how.purpose.empty()) how.purpose = usual;
  const auto found = std::ranges::find(all_purposes, std::string_view(how.purpose), &purpose::name);
  if (found == all_purposes.end())
    refuse("unknown purpose '{}': {} is one of {}", how.purpose, spelled("purpose"), purposes());
  if (!how.loss.empty()) {
    how.purpose.clear();
    return;
  }
  if (how.purpose == for_sampling && !how.horizon) {
    refuse_value(prefix + "horizon",
                 "must be given with {}; take the longest duration of a proposal, twice the mean",
                 spelled("purpose", "sampling"));
  }
  how.loss = found->loss.empty() ? usual_loss(around).description() : std::string(found->loss);
}

}  // namespace nysalt::program
