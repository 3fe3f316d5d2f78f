// SPDX-License-Identifier: BSL-1.0
#include "citations.hpp"
#include "systems.hpp"

#include <algorithm>

#include "bundled_systems.hpp"
#include "comparison/asked_metric.hpp"
#include "comparison/catalogue.hpp"
#include "comparison/did_you_mean.hpp"
#include "comparison/refusal.hpp"

namespace nysalt::program {

namespace {

constexpr std::string_view paper = "li_lu_tao_ye_2023";

class collected {
 public:
  void add(std::string_view key, const std::string& reason) {
    if (key.empty()) return;
    auto work = std::ranges::find(all_, key, &citation::key);
    if (work == all_.end()) work = all_.insert(all_.end(), {std::string(key), {}});
    if (std::ranges::find(work->reasons, reason) == work->reasons.end()) work->reasons.push_back(reason);
  }
  std::vector<citation> all() && { return std::move(all_); }

 private:
  std::vector<citation> all_;
};

std::string_view source_of_system(const std::string& name) {
  if (is_path_of_system(name)) return {};  // of one's own
  return declaration_of(name).source;
}

std::string_view source_of_method(const std::string& typed) {
  const std::string name = canonical_method(typed);
  for (const auto& known : adaptive_methods()) {
    if (known.name == name) return known.source;
  }
  for (const auto& known : classical_methods()) {
    if (known.method.name() == name) return known.source;
  }
  refuse("unknown method '{}': {}", name, did_you_mean(name, method_names_and_aliases()));
}

void add_metric(const std::string& typed, collected& to) {
  const std::string name = metric_named(typed, "").name;
  if (name == "acceptance") to.add("duane_kennedy_pendleton_roweth_1987", "Hybrid Monte Carlo");
  if (name == "acf") to.add("sokal_1997", "autocovariances and their errors");
}

/// Everything that is learned or measured needs a reference: small steps, or the exact flow of a linear
/// system.
void add_reference(const cited_setup& setup, collected& to) {
  const bool is_exact = setup.system == "oscillator" || setup.system == "linear_chain";
  if (setup.in_bath) {
    to.add(source_of_method("baoab"), "the reference");
  } else if (!is_exact) {
    to.add(source_of_method("srkn11b"), "the reference");
  }
}

void add_setup(const cited_setup& setup, collected& to) {
  if (!setup.system.empty()) to.add(source_of_system(setup.system), "the system " + setup.system);
  for (const auto& name : setup.methods) to.add(source_of_method(name), name);
  const auto add_family = [&](const std::string& name) {
    to.add(source_of_family(name), "the family " + name);
    if (!is_word(name) && family_named(name).letters.is_processed())
      to.add("blanes_casas_ros_1999", "processing");
  };
  for (const auto& name : setup.families) add_family(name);
  for (const auto& name : setup.learned) {
    to.add(paper, "learning the integrator");
    add_family(name);
    to.add("ceres", "the search for parameters");
  }
  for (const auto& metric : setup.metrics) add_metric(metric, to);
  if (!setup.learned.empty() || !setup.metrics.empty()) add_reference(setup, to);
  if (setup.in_bath) to.add("leimkuhler_matthews_2015", "Langevin dynamics by splitting");
  if (setup.in_bath || !setup.system.empty()) {
    const std::string reason = setup.in_bath ? "random starts and noise" : "random starts";
    to.add("salmon_2011", reason);
    to.add("box_muller_1958", reason);
  }
}

}  // namespace

std::vector<citation> citations_for(const std::vector<cited_setup>& setups) {
  collected works;
  works.add(paper, "nysalt");
  for (const auto& setup : setups) add_setup(setup, works);
  works.add("eigen", "vectors");
  return std::move(works).all();
}

}  // namespace nysalt::program
