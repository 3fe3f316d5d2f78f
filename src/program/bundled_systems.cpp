// SPDX-License-Identifier: BSL-1.0
#include "bundled_systems.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "did_you_mean.hpp"
#include "refusal.hpp"

namespace nysalt::program {

namespace {

struct option {
  const char* name;
  bool given;
};

/// A system, the options that it takes, and how it is made of them.
struct maker {
  system_entry entry;
  std::vector<std::string> takes;
  std::function<std::unique_ptr<bundled_system>(const system_settings&, const surroundings&)> make;
};

const std::vector<maker>& makers() {
  static const std::vector<maker> all{
      {{"fpu", "--pairs 3 --omega 50 --spread 1",
        "Fermi-Pasta-Ulam chain: stiff linear and soft quartic springs in turn", "fpu_chain",
        "hairer_lubich_wanner_2006"},
       {"--pairs", "--omega", "--spread"},
       [](const auto& s, const auto& in) {
         return make_fpu(s.pairs.value_or(3), s.omega.value_or(50.0), in);
       }},
      {{"oscillator", "--omega 50 --spread 1", "p^2/2 + omega^2 q^2/2", "harmonic_oscillator"},
       {"--omega", "--spread"},
       [](const auto& s, const auto& in) { return make_oscillator(s.omega.value_or(50.0), in); }},
      {{"linear_chain", "--masses 8 --spring 1 --spread 1",
        "equal masses between walls, joined by linear springs", "linear_chain"},
       {"--masses", "--spring", "--spread"},
       [](const auto& s, const auto& in) {
         return make_linear_chain(s.masses.value_or(8), s.spring.value_or(1.0), in);
       }},
      {{"pendulum", "--spread 1", "p^2/2 - cos q", "pendulum"},
       {"--spread"},
       [](const auto&, const auto& in) { return make_pendulum(in); }},
      {{"henon_heiles", "--spread 1", "two degrees of freedom in a cubic potential, bounded below energy 1/6",
        "henon_heiles", "henon_heiles_1964"},
       {"--spread"},
       [](const auto&, const auto& in) { return make_henon_heiles(in); }},
      {{"kepler", "--eccentricity 0.6", "p^2/2 - 1/|q| in the plane, ellipses of semi-major axis 1", "kepler",
        "hairer_lubich_wanner_2006"},
       {"--eccentricity"},
       [](const auto& s, const auto& in) { return make_kepler(s.eccentricity.value_or(0.6), in); }},
      {{"lennard_jones", "--atoms 7 --space 2 --spread 1", "a cluster of atoms, 4 (r^-12 - r^-6) each pair",
        "lennard_jones", "verlet_1967"},
       {"--atoms", "--space", "--spread"},
       [](const auto& s, const auto& in) {
         return make_lennard_jones(s.space.value_or(2), s.atoms.value_or(7), in);
       }},
      {{"phi4", "--masses 16 --spread 1", "masses in wells q^4/4, a ring joined by linear springs",
        "phi4_chain", "aoki_kusnezov_2002"},
       {"--masses", "--spread"},
       [](const auto& s, const auto& in) { return make_phi4(s.masses.value_or(16), in); }},
  };
  return all;
}

bath bath_of(const bath_settings& settings) {
  if (settings.sigma && settings.temperature) {
    refuse("--sigma and --temperature say the same twice: give one (kT = sigma^2/(2 friction))");
  }
  if (!settings.friction) {
    if (settings.sigma) refuse("--sigma needs --friction, 0 for none");
    if (settings.temperature) refuse("--temperature needs --friction");
    return bath::of_sigma(0.0, 0.0);
  }
  if (!settings.sigma && !settings.temperature) {
    refuse("--friction needs --sigma or --temperature, 0 for damping alone");
  }
  const auto require = [](const char* option, double value) {
    if (value >= 0.0 && std::isfinite(value)) return;
    refuse("{} must be finite and not negative, got {}", option, value);
  };
  require("--friction", *settings.friction);
  if (settings.temperature) {
    require("--temperature", *settings.temperature);
    return bath::of_temperature(*settings.friction, *settings.temperature);
  }
  require("--sigma", *settings.sigma);
  return bath::of_sigma(*settings.friction, *settings.sigma);
}

double spread_of(const std::optional<double>& asked, start where) {
  if (!asked) return 1.0;
  if (!(*asked > 0.0) || !std::isfinite(*asked)) {
    refuse("--spread must be positive and finite, got {}", *asked);
  }
  if (where != start::law) refuse("--spread belongs to the law of starts: take --start law");
  return *asked;
}

start start_of(const std::string& asked, const bath& heat_bath) {
  const bool is_warm = heat_bath.acts() && heat_bath.has_temperature() && heat_bath.temperature() > 0.0;
  if (asked.empty()) return is_warm ? start::gibbs : start::law;
  if (asked == "law") return start::law;
  if (asked != "gibbs" && asked != "trajectory") {
    refuse("unknown --start '{}': it is one of law, gibbs, trajectory", asked);
  }
  if (!is_warm) {
    refuse("--start {} needs a bath with a temperature above 0: give --friction and --temperature", asked);
  }
  return asked == "gibbs" ? start::gibbs : start::trajectory;
}

surroundings surroundings_of(const system_settings& settings) {
  const bath heat_bath = bath_of(settings.bath);
  const start where = start_of(settings.start, heat_bath);
  return {heat_bath, where, spread_of(settings.spread, where)};
}

}  // namespace

const std::vector<system_entry>& system_entries() {
  static const std::vector<system_entry> all = [] {
    std::vector<system_entry> entries;
    for (const auto& known : makers()) entries.push_back(known.entry);
    return entries;
  }();
  return all;
}

void require_known_system(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& known : makers()) names.push_back(known.entry.name);
  if (std::find(names.begin(), names.end(), name) != names.end()) return;
  refuse("unknown system '{}': {}", name, did_you_mean(name, names));
}

std::unique_ptr<bundled_system> make_system(const system_settings& settings) {
  if (settings.own) return settings.own(surroundings_of(settings));
  require_known_system(settings.name);
  const auto found = std::find_if(makers().begin(), makers().end(),
                                  [&](const maker& known) { return known.entry.name == settings.name; });
  for (const auto& [name, given] :
       {option{"--pairs", settings.pairs.has_value()}, option{"--omega", settings.omega.has_value()},
        option{"--masses", settings.masses.has_value()}, option{"--spring", settings.spring.has_value()},
        option{"--eccentricity", settings.eccentricity.has_value()},
        option{"--atoms", settings.atoms.has_value()}, option{"--space", settings.space.has_value()},
        option{"--spread", settings.spread.has_value()}}) {
    if (!given || std::find(found->takes.begin(), found->takes.end(), name) != found->takes.end()) continue;
    refuse("the system {} has no {}: it takes {}", settings.name, name, listed(found->takes));
  }
  return found->make(settings, surroundings_of(settings));
}

std::optional<double> highest_frequency(const bundled_system& system) {
  std::optional<double> highest;
  for (const auto& band : system.frequency_bands()) highest = std::max(highest.value_or(0.0), band.high);
  return highest;
}

}  // namespace nysalt::program
