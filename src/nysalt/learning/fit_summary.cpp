// SPDX-License-Identifier: BSL-1.0
// A fit in words.

#include "nysalt/learning/fit_summary.hpp"

#include <fmt/format.h>
#include <cmath>

namespace nysalt {

namespace {

/// The standard error of a parameter in scientific notation with `digits` decimals, or why there is none.
std::string error_of(const fit_summary::fitted_parameter& p, const fit_summary& fit, int digits) {
  if (std::isinf(p.standard_error)) return "(not determined by the data)";
  if (std::isnan(p.standard_error)) return fit.is_held_by_guard ? "(held by the guard)" : "+- not known";
  return p.free ? fmt::format("+- {:.{}e}", p.standard_error, digits) : "(not free)";
}

}  // namespace

std::string fit_summary::verdict_in_words() const {
  switch (verdict()) {
    case nysalt::verdict::usable:
      return "usable";
    case nysalt::verdict::nothing_gained:
      return fmt::format("nothing gained over {}: {}{}", rival, what_to_take(),
                         failing_rival.name.empty() ? "" : "; " + of_failing_rival());
    case nysalt::verdict::not_usable:
      break;
  }
  return "NOT usable: " + reason;
}

std::string fit_summary::what_to_take() const {
  if (rival == "equal steps") return "take a method of one evaluation with smaller steps";
  if (rival == "phase_fitted") {
    return "the member of this family that follows from only the highest frequency is as good";
  }
  if (rival_step > 0.0) return fmt::format("take {} at step {:.4g}", rival, rival_step);
  return fmt::format("take {}", rival);
}

std::string fit_summary::of_failing_rival() const {
  if (failing_rival.name.empty()) return {};
  const auto& [name, of_name, times, why] = failing_rival;
  const std::string errs = times > 1.0 ? fmt::format("errs {:.2g} times less", times)
                                       : fmt::format("errs {:.2g} times as much", 1.0 / times);
  return fmt::format("{} at step {:.4g} {} in the median, and fails: {}", name, of_name, errs, why);
}

std::string fit_summary::uncertainty() const {
  if (std::isnan(expected_excess)) return "not known";
  return fmt::format(
      "adds {:.1e} to the loss on new data, {:.2g} % of it; it rests on {:.0f} trajectories{}",
      expected_excess, 100.0 * excess_share(), deciding_trajectories,
      is_decided_by_few() ? ", too few to rely on it: take more, or starts of less different energies" : "");
}

std::string fit_summary::following() const {
  if (follows_to_the_end()) return {};
  const std::string steps = fmt::format("{} step{}", loss_steps, loss_steps == 1 ? "" : "s");
  if (!follows) return fmt::format("its error exceeds a twentieth of the motion within {}", steps);
  return fmt::format("it follows trajectories for {}, not for {}", steps, trajectory_steps);
}

std::string fit_summary::brief() const {
  std::string text = fmt::format("{} at step {:g} for {}:", family, step, system);
  for (const auto& p : parameters) {
    text += fmt::format(" {} = {:.6f}", p.name, p.value);
    text += fmt::format(" {}", error_of(p, *this, 1));
  }
  text += fmt::format(", loss {:.3e}, held out {:.3e}{}, {}", loss, held_out_loss,
                      held_out_is_new ? "" : " (the same data)", verdict_in_words());
  if (usable && !follows_to_the_end()) text += "; but " + following();
  return text;
}

std::string fit_summary::full() const {
  std::string text = fmt::format("{} at step {} for {}\n", family, step, system);
  for (const auto& p : parameters) {
    text += fmt::format("  {:<22}{:.17g}  {}\n", p.name, p.value, error_of(p, *this, 2));
  }
  const auto line = [&](const char* what, const std::string& value) {
    text += fmt::format("  {:<22}{}\n", what, value);
  };
  line("usable", !usable ? "no: " + reason
                 : gains_nothing
                     ? fmt::format("yes, but nothing is gained over {}: {}", rival, what_to_take())
                     : "yes");
  if (!follows_to_the_end())
    line("trajectories", following() + "; take a smaller step to follow them longer");
  const std::string of_steps = is_of_data && 1 < loss_steps ? fmt::format(" over {} steps", loss_steps) : "";
  line("loss", is_of_data ? fmt::format("{:.6e} ({}{}) on {} pairs of {} trajectories", loss, loss_name,
                                        of_steps, samples, trajectories)
                          : fmt::format("{:.6e} ({})", loss, loss_name));
  line("held-out loss",
       fmt::format("{:.6e} on {} pairs; at the start {:.6e}{}", held_out_loss, held_out_samples,
                   held_out_start_loss, held_out_is_new ? "" : "; but these are the data learned from"));
  if (is_of_data && coordinates_used > 0) {
    line("per coordinate",
         fmt::format("{:.3g} root mean square on held-out data, {} to {:.3g} at the start",
                     std::sqrt(held_out_loss / static_cast<double>(coordinates_used)),
                     held_out_loss > held_out_start_loss ? "WORSE compared" : "compared",
                     std::sqrt(held_out_start_loss / static_cast<double>(coordinates_used))));
  }
  if (!rival.empty()) {
    line("best classical",
         fmt::format("{}{} of the same cost, held-out loss {:.6e} ({:.3g} times {}, +- {})", rival,
                     rival_step > 0.0 ? fmt::format(" at step {:.4g}", rival_step) : std::string(),
                     rival_loss, gain(),
                     loss_beside_rival == held_out_loss
                         ? std::string("this")
                         : fmt::format("{:.6e}, by times that both have", loss_beside_rival),
                     std::isfinite(rival_noise) ? fmt::format("{:.2g}", rival_noise / loss_beside_rival)
                                                : std::string("unknown")));
  }
  if (!errors_withheld.empty()) line("standard errors", "not known: " + errors_withheld);
  if (!failing_rival.name.empty()) line("fails its trial", of_failing_rival());
  if (is_of_data) line("uncertainty", uncertainty());
  line("search", fmt::format("{} starts; this is from '{}'{}", starts_tried, from,
                             is_held_by_guard ? ", held by the guard"
                             : is_in_valley   ? ", in a valley of parameters that do as well"
                                              : ""));
  line("stability", guard);
  line("judgement", judgement.in_words());
  line("trial", judgement.report());
  if (fitted_frequency > 0.0)
    line("phase-fitted", fmt::format("the frequency {:.6g}, {}", fitted_frequency, source_of_frequency));
  if (!unguarded.empty()) line("without the guard", unguarded);
  for (const auto& [low, high] : gaps) {
    line("gap",
         fmt::format("unstable for z = {:.4g} to {:.4g}, which the motion meets rarely or never", low, high));
  }
  if (!judgement.resonance.empty()) line("resonance", judgement.resonance);
  line("one-step error",
       fmt::format("{:.3e}, the reference's own {}", one_step_error,
                   reference_checked ? fmt::format("{:.3e}", reference_error) : "not measured"));
  line("trajectory error", fmt::format("{:.3e} at the end of held-out trajectories", trajectory_error));
  line("coordinates", coordinates);
  for (const auto& name : dropped) line("never moves", name + ", left out of the loss");
  line("condition", fmt::format("{:.3g}", condition));
  for (const auto& direction : flat_directions) {
    if (!std::isfinite(direction.front())) continue;  // of a Hessian that is 0
    std::string components;
    for (const double x : direction) components += fmt::format(" {:.4f}", x);
    line("flat direction", components);
  }
  line("iterations", fmt::format("{}", iterations));
  line("reference", reference);
  line("starts", fmt::format("{}, seed {}, held out {}", ensemble, seed, held_out_seed));
  line("force derivatives", derivatives);
  line("cost", fmt::format("{} force evaluations; data {:.3g} s, fit {:.3g} s", learning_evaluations,
                           data_seconds, fit_seconds));
  return text;
}

}  // namespace nysalt
