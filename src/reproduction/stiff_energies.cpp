// SPDX-License-Identifier: BSL-1.0
#include "stiff_energies.hpp"

#include <algorithm>
#include <cmath>

namespace nysalt::program::paper {

energies energies_at(const record& run, std::size_t sample) {
  return {run.values[3 * sample], run.values[3 * sample + 1], run.values[3 * sample + 2]};
}
double total(const energies& I) { return I[0] + I[1] + I[2]; }

double energy_error(const energies& I, const energies& reference) {
  double sum = 0.0;
  for (std::size_t j = 0; j < 3; ++j) sum += std::abs(I[j] - reference[j]);
  return sum / total(reference);
}

double angle_error(const energies& I, const energies& reference) {
  const auto theta = [](const energies& x) { return std::acos(std::sqrt(std::min(1.0, x[2] / total(x)))); };
  const auto phi = [](const energies& x) { return std::atan2(std::sqrt(x[1]), std::sqrt(x[0])); };
  return std::abs(theta(I) - theta(reference)) + std::abs(phi(I) - phi(reference));
}

std::vector<double> curve_against(const std::vector<record>& runs, const std::vector<record>& reference,
                                  energy_distance error, bool frozen) {
  std::vector<double> mean(reference.front().values.size() / 3, 0.0);
  for (std::size_t m = 0; m < reference.size(); ++m) {
    for (std::size_t i = 0; i < mean.size(); ++i) {
      const bool there = runs[m].values.size() >= 3 * (i + 1);
      const double e =
          there ? error(energies_at(runs[m], frozen ? 0 : i), energies_at(reference[m], i)) : 2.0;
      mean[i] += e / static_cast<double>(reference.size());
    }
  }
  return mean;
}

std::vector<double> means_up_to(const std::vector<record>& runs, const std::vector<record>& reference,
                                energy_distance error, std::size_t last, bool frozen) {
  std::vector<double> result;
  for (std::size_t m = 0; m < reference.size(); ++m) {
    double sum = 0.0;
    for (std::size_t i = 1; i <= last; ++i) {
      const bool there = runs[m].values.size() >= 3 * (i + 1);
      sum += there ? error(energies_at(runs[m], frozen ? 0 : i), energies_at(reference[m], i)) : 2.0;
    }
    result.push_back(sum / static_cast<double>(last));
  }
  return result;
}

std::vector<double> times(std::size_t samples, double sample) {
  std::vector<double> t;
  for (std::size_t i = 0; i < samples; ++i) t.push_back(sample * static_cast<double>(i));
  return t;
}

panel energies_panel(const record& run, double sample, const std::string& title) {
  const std::size_t samples = run.values.size() / 3;
  const std::size_t every = samples / 500 + 1;  // more points would only weigh
  panel result{title, "time", "energy", false, {}, "[0:8]"};
  curve all{"I", times((samples - 1) / every + 1, sample * static_cast<double>(every)), {}, {}, true};
  std::array<curve, 3> one{curve{"I_1", all.x, {}}, curve{"I_2", all.x, {}}, curve{"I_3", all.x, {}}};
  for (std::size_t i = 0; i < samples; i += every) {
    const energies I = energies_at(run, i);
    all.y.push_back(total(I));
    for (std::size_t j = 0; j < 3; ++j) one[j].y.push_back(I[j]);
  }
  result.curves = {all, one[0], one[1], one[2]};
  return result;
}

std::vector<record> reference_runs(const setting& setup, const prepared_problem& system, double sample,
                                   double horizon, std::int64_t count, int finer) {
  const double step = reference_step(sample) / finer;
  return followed(setup, system, classical("srkn11b", system), step, horizon, sample, count, stiff);
}

}  // namespace nysalt::program::paper
