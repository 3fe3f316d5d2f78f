// SPDX-License-Identifier: BSL-1.0
// Functions of a state, by name.
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <vector>

#include "degrees_of_freedom.hpp"
#include "did_you_mean.hpp"
#include "nysalt/analysis/ensemble_statistics.hpp"
#include "nysalt/energy.hpp"
#include "prepared_problem.hpp"
#include "refusal.hpp"

namespace nysalt::program {

/// As people read them: families of names once.
inline std::vector<std::string> observable_names(const initial_value_problem& made) {
  const model& system = made.system;
  const auto& springs = made.springs;
  std::vector<std::string> names{"energy", "kinetic_energy", "potential_energy", "kinetic_temperature"};
  const auto range = [&](const char* stem, Eigen::Index last) {
    names.push_back(last == 1 ? fmt::format("{}1", stem) : fmt::format("{0}1..{0}{1}", stem, last));
  };
  range("q", size(system));
  range("p", size(system));
  if (springs.pairs > 0) {
    names.insert(names.begin(), "stiff_energy");
    range("stiff_energy_", springs.pairs);
  }
  std::string list;  // "x[", of which the first and the last are named
  for (const auto& own : made.observables) {
    const auto bracket = own.name.find('[');
    const std::string stem = bracket == std::string::npos ? std::string() : own.name.substr(0, bracket + 1);
    if (stem.empty() || stem != list) {
      names.push_back(own.name);
    } else {
      names.back() = fmt::format("{0}1]..{1}", stem, own.name);
    }
    list = stem;
  }
  return names;
}

/// The number after a stem, 1..last; 0 if the name is not of that kind.
inline Eigen::Index index_after(std::string_view name, std::string_view stem, Eigen::Index last) {
  if (!name.starts_with(stem)) return 0;
  const std::string_view digits = name.substr(stem.size());
  Eigen::Index index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  const bool is_number = error == std::errc{} && end == digits.data() + digits.size();
  return is_number && 1 <= index && index <= last ? index : 0;
}

/// Whether a system has an observable of that name that its user has not declared.
inline bool is_built_in_observable(const initial_value_problem& made, const std::string& name) {
  for (const auto& known : {"energy", "kinetic_energy", "kinetic_temperature", "potential_energy"}) {
    if (name == known) return true;
  }
  const Eigen::Index pairs = made.springs.pairs;
  return index_after(name, "q", size(made.system)) > 0 || index_after(name, "p", size(made.system)) > 0 ||
         (pairs > 0 && (name == "stiff_energy" || index_after(name, "stiff_energy_", pairs) > 0));
}

/// value(system, state) as a function of the state. Refers to the system.
inline nysalt::detail::over_scalars<nysalt::detail::of_state> of_system(const model& system, auto value) {
  return [&system, value](const auto& x) { return value(system, x); };
}

/// A function of the state of one trajectory, or of those in the lanes of packs. Refers to what
/// was made. Throws refusal, listing the names, if there is none of that name.
inline nysalt::detail::over_scalars<nysalt::detail::of_state> observable(const initial_value_problem& made,
                                                                         const std::string& name) {
  const model& system = made.system;
  const auto& springs = made.springs;
  for (const auto& own : made.observables) {
    if (own.name == name) return own.value;
  }
  if (name == "energy") {
    return of_system(system, []<class T>(const model& of, const phase_point<T, Eigen::Dynamic>& x) {
      return energy<T>(of, x);
    });
  }
  if (name == "kinetic_energy") {
    return of_system(system, []<class T>(const model& of, const phase_point<T, Eigen::Dynamic>& x) {
      return kinetic_energy<T>(of, x.p);
    });
  }
  if (name == "kinetic_temperature") {
    const double shared_by =
        static_cast<double>(size(system)) / static_cast<double>(degrees_of_freedom(made));
    return of_system(system, [shared_by]<class T>(const model& of, const phase_point<T, Eigen::Dynamic>& x) {
      return kinetic_temperature<T>(of, x) * shared_by;
    });
  }
  if (name == "potential_energy") {
    return of_system(system, []<class T>(const model& of, const phase_point<T, Eigen::Dynamic>& x) {
      return of.potential(x.q);
    });
  }
  if (const auto i = index_after(name, "q", size(system))) {
    return [i](const auto& x) { return x.q[i - 1]; };
  }
  if (const auto i = index_after(name, "p", size(system))) {
    return [i](const auto& x) { return x.p[i - 1]; };
  }
  if (springs.pairs > 0) {
    const auto spring_energy = [&springs](Eigen::Index j) {
      return [&springs, j](const auto& x) { return springs.energy(x, j); };
    };
    if (name == "stiff_energy") return spring_energy(-1);
    if (const auto j = index_after(name, "stiff_energy_", springs.pairs)) return spring_energy(j - 1);
  }
  const auto known = observable_names(made);
  // Of a numbered one the number may be wrong: "q1..q6" says which there are.
  const bool is_numbered = !name.empty() && name.back() >= '0' && name.back() <= '9';
  refuse("unknown observable '{}' of {}: {}", name, describe(system),
         is_numbered ? "it is one of " + listed(known) : did_you_mean(name, known));
}

}  // namespace nysalt::program
