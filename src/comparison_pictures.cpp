// SPDX-License-Identifier: BSL-1.0
// Laws and autocovariances, drawn beside those of the reference.
#include <algorithm>

#include "comparison.hpp"

namespace nysalt::program {

namespace {

curve density_curve(const std::string& label, const histogram& its) {
  curve result{.label = label, .x = {}, .y = its.density()};
  const equal_bins bins = its.bins();
  for (int i = 0; i < bins.count; ++i) result.x.push_back(bins.low + (i + 0.5) * bins.width());
  return result;
}

curve acf_curve(const std::string& label, const autocovariance& its) {
  curve result{.label = label, .x = {}, .y = its.normalised()};
  for (std::size_t k = 0; k < result.y.size(); ++k) {
    result.x.push_back(static_cast<double>(k) * its.interval());
  }
  return result;
}

/// Of independent ensembles, with less noise than each has; they share their x.
curve mean_curve(const std::vector<curve>& all) {
  curve result = all.front();
  for (std::size_t i = 0; i < result.y.size(); ++i) {
    double sum = 0.0;
    for (const curve& one : all) sum += one.y[i];
    result.y[i] = sum / static_cast<double>(all.size());
  }
  return result;
}

}  // namespace

std::vector<figure> comparison::pictures_of_statistics() const {
  std::vector<figure> result;
  const bool of_law = command_.metric == "distribution";
  const auto curve_of = [&](const std::string& label, const gathered_statistics& its) {
    return of_law ? density_curve(label, *its.histogram) : acf_curve(label, *its.autocovariance);
  };
  for (const double nominal : command_.steps) {
    panel its{fmt::format("step {:g}", nominal),
              of_law ? command_.observable : "lag",
              of_law ? "density" : "normalised autocovariance of " + command_.observable,
              false,
              {}};
    for (const auto& one : rows_) {
      if (one.nominal != nominal || !one.statistics || one.statistics->counted == 0) continue;
      if (its.curves.empty()) {
        const auto at = reference_statistics_.find(one.step);
        const auto& all = at == reference_statistics_.end() ? *reference_statistics_.begin() : *at;
        std::vector<curve> of_ensembles;
        for (const auto& ensemble : all.second) of_ensembles.push_back(curve_of("reference", ensemble));
        its.curves.push_back(mean_curve(of_ensembles));
        its.curves.back().emphasised = true;
      }
      its.curves.push_back(curve_of(one.method, *one.statistics));
    }
    if (its.curves.empty()) continue;
    std::string name = fmt::format("{}_at_{:g}", command_.metric, nominal);
    std::replace(name.begin(), name.end(), '.', '_');
    std::replace(name.begin(), name.end(), '+', '_');
    result.push_back({name, {its}});
  }
  return result;
}

}  // namespace nysalt::program
