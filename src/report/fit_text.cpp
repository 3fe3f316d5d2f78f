// SPDX-License-Identifier: BSL-1.0
#include "fit_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "table.hpp"
#include "terminal.hpp"

namespace nysalt::program {

namespace {

/// "312 ± 16", of the losses of the best classical method and of the fit.
std::string gain_of(const fit_summary& fit) {
  const double noise = fit.rival_noise / fit.loss_beside_rival;
  return fmt::format("{:.3g}", fit.gain()) + (std::isfinite(noise) ? fmt::format(" ± {:.2g}", noise) : "");
}

/// With all digits.
std::string parameters_of(const fit_summary& fit) {
  std::string text;
  for (const auto& p : fit.parameters) {
    text += fmt::format("{}{}={:.17g}", text.empty() ? "" : ", ", p.name, p.value);
    if (p.free && std::isfinite(p.standard_error)) text += fmt::format("±{:.1e}", p.standard_error);
  }
  return text;
}

/// What the data do not determine, in one line; empty where they determine all.
std::string undetermined(const fit_summary& fit) {
  std::string names;
  for (const auto& p : fit.parameters) {
    if (std::isinf(p.standard_error)) names += (names.empty() ? "" : ", ") + p.name;
  }
  if (!names.empty()) return fmt::format("not determined by the data: {}\n", names);
  if (fit.errors_withheld.empty()) return {};
  return fmt::format("standard errors are not known: {}\n", fit.errors_withheld);
}

}  // namespace

std::string verdict_sentence(const fit_summary& fit) {
  std::string text =
      fmt::format("{} at step {:g} for {}: {}", fit.family, fit.step, fit.system, fit.verdict_in_words());
  if (fit.verdict() == verdict::usable && !fit.rival.empty() && fit.gain() > 1.0) {
    text += fmt::format(
        ", with a held-out loss {} times smaller than that of {}, the best classical method "
        "of the same cost",
        gain_of(fit), fit.rival);
  }
  if (fit.usable && !fit.follows_to_the_end()) text += "; but " + fit.following();
  return text + ".";
}

std::string text_of(const fit_summary& fit, const text_form& form) {
  std::string text = verdict_sentence(fit) + "\n" + parameters_of(fit) + "\n" + undetermined(fit);
  text += fmt::format("held-out loss {:.3e} ({}){}, {:.3e} at the start of the search\n", fit.held_out_loss,
                      fit.loss_name, fit.held_out_is_new ? "" : " on the same data", fit.held_out_start_loss);
  text += fmt::format("one-step error {:.2e}; at the end of held-out trajectories {:.2e}\n",
                      fit.one_step_error, fit.trajectory_error);
  text += fmt::format("judgement: {}\n", fit.judgement.in_words());
  text +=
      fmt::format("learned from {} trajectories in {:.3g} s and {:.3g} force evaluations\n", fit.trajectories,
                  fit.data_seconds + fit.fit_seconds, static_cast<double>(fit.learning_evaluations));
  return wrapped(text, form.width);
}

std::string text_of(const std::vector<fit_summary>& curve, const text_form& form) {
  std::string counts;
  for (const verdict one : {verdict::usable, verdict::nothing_gained, verdict::not_usable}) {
    const auto count = std::ranges::count_if(curve, [&](const auto& fit) { return fit.verdict() == one; });
    if (count > 0) counts += fmt::format("{}{} at {}", counts.empty() ? "" : ", ", to_string(one), count);
  }
  const fit_summary& first = curve.front();
  table rows({"step", "verdict", "best classical", "its loss / this", "held-out loss"}, 3);
  for (const auto& fit : curve) {
    rows.add({fmt::format("{:g}", fit.step), std::string(to_string(fit.verdict())),
              fit.rival.empty() ? "-" : fit.rival, fit.rival.empty() ? "-" : gain_of(fit),
              fmt::format("{:.3e}", fit.held_out_loss)});
  }
  std::string notes;
  for (const auto& fit : curve)
    notes += fmt::format("at step {:g}: {}\n", fit.step, parameters_of(fit)) + undetermined(fit);
  for (const auto& fit : curve) {
    if (fit.verdict() == verdict::nothing_gained || !fit.follows_to_the_end())
      notes += verdict_sentence(fit) + "\n";
  }
  return wrapped(
             fmt::format("{} for {}, of {} steps: {}.\n\n", first.family, first.system, curve.size(), counts),
             form.width) +
         rows.text(form.width) + wrapped(notes, form.width);
}

}  // namespace nysalt::program
