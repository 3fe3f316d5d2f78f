// SPDX-License-Identifier: BSL-1.0
#include "citations.hpp"

#include <algorithm>

#include "asked_metric.hpp"
#include "bundled_system.hpp"
#include "catalogue.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

constexpr std::string_view learned_prefix = "learned:";

class collected {
 public:
  void add(std::string_view key, const std::string& reason) {
    if (key.empty()) return;
    auto its = std::ranges::find(all_, key, &citation::key);
    if (its == all_.end()) its = all_.insert(all_.end(), {std::string(key), {}});
    if (std::ranges::find(its->reasons, reason) == its->reasons.end()) its->reasons.push_back(reason);
  }
  std::vector<citation> all() && { return std::move(all_); }

 private:
  std::vector<citation> all_;
};

std::string_view source_of_system(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& entry : system_entries()) {
    if (entry.name == name) return entry.source;
    names.push_back(entry.name);
  }
  refuse("unknown system '{}': it is one of {}", name, listed(names));
}

std::string_view source_of_method(const std::string& name) {
  if (name == adaptive_method) return adaptive_source;
  for (const auto& known : classical_methods()) {
    if (known.method.name() == name) return known.source;
  }
  refuse("unknown method '{}': it is one of {}, learned:FAMILY, or the file of a scheme", name,
         listed(method_names()));
}

void add_method(const std::string& typed, collected& to) {
  const std::string name = typed.substr(0, typed.find('@'));
  if (typed.find('@') != std::string::npos) placement_named(typed.substr(typed.find('@') + 1));
  if (!name.starts_with(learned_prefix)) {
    to.add(source_of_method(name), name);
    return;
  }
  const std::string family = family_named(name.substr(learned_prefix.size())).name;
  to.add("li_lu_tao_ye_2023", "learning the integrator");
  to.add(source_of_family(family), "the family " + family);
  to.add("ceres", "the search for parameters");
}

void add_metric(const std::string& typed, collected& to) {
  const std::string name = metric_named(typed, "").name;
  if (name == "acceptance") to.add("duane_kennedy_pendleton_roweth_1987", "Hybrid Monte Carlo");
  if (name == "acf") to.add("sokal_1997", "autocovariances and their errors");
}

/// Whatever is measured is measured against a reference.
void add_reference(bool in_bath, collected& to) {
  if (in_bath) {
    to.add(source_of_method("baoab"), "the reference");
  } else {
    to.add(source_of_method("srkn11b"), "the reference");
  }
}

}  // namespace

std::vector<citation> citations_for(const std::vector<cited_setup>& setups) {
  collected works;
  works.add("li_lu_tao_ye_2023", "nysalt");
  for (const auto& its : setups) {
    if (!its.system.empty()) works.add(source_of_system(its.system), "the system " + its.system);
    for (const auto& method : its.methods) add_method(method, works);
    for (const auto& metric : its.metrics) add_metric(metric, works);
    const auto is_learned = [](const std::string& method) { return method.starts_with(learned_prefix); };
    if (!its.metrics.empty() || std::ranges::any_of(its.methods, is_learned)) {
      add_reference(its.in_bath, works);
    }
    if (!its.in_bath) continue;
    works.add("leimkuhler_matthews_2015", "Langevin dynamics by splitting");
    works.add("salmon_2011", "random numbers");
    works.add("box_muller_1958", "normal numbers");
  }
  works.add("eigen", "vectors");
  return std::move(works).all();
}

}  // namespace nysalt::program
