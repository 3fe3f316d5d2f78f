// SPDX-License-Identifier: BSL-1.0
// A method that was learned at one size of a system, tried at another.
#pragma once

#include <stdexcept>
#include <string>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"
#include "nysalt/trial_run.hpp"

namespace nysalt {

/// Result of a trial at another size.
struct size_trial {
  trial_result run;       ///< the trial run, if the guard had no objection
  std::string objection;  ///< reason of the refusal, one sentence; empty if the method passed

  /// Whether the guard had no objection and the trial run was made and passed.
  bool passed() const { return objection.empty(); }
};

/// Test of a method at another size: a stability_guard along initial states of the larger system, with the
/// bands that this system declares, and then a trial run: from 8 to 64 of the starts, the fewer the larger
/// the system, half of them energetic ones, and of 500 to `options.steps` steps. Where these are too few for
/// a verdict, the guard has the last word on frequencies that are met rarely. A trial that could not be run
/// is an objection. Throws what stability_guard and trial_run do. Cost: that of the guard, and some 4 10^8
/// coordinates moved once each, or what 8 trajectories of 500 steps take if that is more; of a black box 2
/// 10^5 force evaluations, or as many as these trajectories take.
size_trial try_at_size(const model& system, const tabulated& method, double step,
                       const initial_states& starts, const trial_options& options = {});

/// A method that was learned for one size of a kind of system, as a method for this size, once try_at_size()
/// passed it. Throws std::invalid_argument if the systems are not of one kind, see kind_of(), or the method
/// was refused. Cost: that of try_at_size(); none where the method was learned for this very system.
template <Family F, SeparableSystem S, Ensemble<S> E>
tuned_method<F> at_size_of(const S& system, const tuned_method<F>& learned, const E& starts,
                           const trial_options& options = {}) {
  if (describe(system) == learned.system()) return learned;
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(
        sentence("{} must run on {}, for which it was learned, got {}: {}; learn it there, or use anywhere()",
                 learned.name(), learned.system(), describe(system), why));
  };
  if (learned.kind().empty() || learned.kind() != kind_of(system)) refuse("the systems are not of one kind");
  const size_trial tried = try_at_size(model(system), tabulated(learned.anywhere()), learned.step(),
                                       initial_states(starts), options);
  if (!tried.passed()) refuse(tried.objection);
  return {learned.anywhere(), learned.step(), describe(system), {}, kind_of(system)};
}

}  // namespace nysalt
