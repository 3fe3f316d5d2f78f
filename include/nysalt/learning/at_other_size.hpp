// SPDX-License-Identifier: BSL-1.0
// A method that was learned at one size of a system, tried at another.
#pragma once

#include <stdexcept>
#include <string>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensembles/starts_to_judge.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/judgement.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// A method that was learned for one size of a kind of system, as a method for this size, if it holds there
/// by judge(). Throws std::invalid_argument if the systems are not of one kind, see kind_of(), or the method
/// does not hold. Cost: that of judge(); none where the method was learned for this very system.
template <Family F, SeparableSystem S, Ensemble<S> E>
tuned_method<F> at_size_of(const S& system, const tuned_method<F>& learned, const E& starts,
                           const judging_options& options = {}) {
  if (describe(system) == learned.system()) return learned;
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(
        sentence("{} must run on {}, for which it was learned, got {}: {}; learn it there, or use anywhere()",
                 learned.name(), learned.system(), describe(system), why));
  };
  if (learned.kind().empty() || learned.kind() != kind_of(system)) refuse("the systems are not of one kind");
  const model erased(system);
  const judgement found = judge(erased, starts_to_judge(erased, initial_states(starts)),
                                tabulated(learned.anywhere()), learned.step(), options);
  if (!found.holds()) refuse(found.in_words());
  return {learned.anywhere(), learned.step(), describe(system), {}, kind_of(system)};
}

}  // namespace nysalt
