// SPDX-License-Identifier: BSL-1.0
// A system as a value that the program can offer: its parameters, and how it is made of them.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/bath.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/kernels/kernels.hpp"
#include "nysalt/model.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/systems/in_bath.hpp"

namespace nysalt {

/// A whole or a real number, or a text, such as the name of a file.
using parameter_value = std::variant<std::int64_t, double, std::string>;

namespace detail {

/// A parameter of a system, a number or a text, as options, help, files and Python name it.
struct declared_parameter {
  std::string name;       ///< lower-case letters, digits and _
  parameter_value usual;  ///< default value; its type says whether it is a text, or the number is whole
  std::string meaning{};  ///< meaning, for the help
  double least = -std::numeric_limits<double>::infinity();  ///< the smallest that is allowed
  double most = std::numeric_limits<double>::infinity();    ///< the largest that is allowed
  double below = std::numeric_limits<double>::infinity();   ///< exclusive upper bound
  bool is_positive = false;                                 ///< 0 is not allowed, nor is anything below
  bool is_size = false;  ///< whether the parameter is a number of parts: two sizes are of one kind

  /// Whether its values are whole numbers.
  bool is_whole() const { return std::holds_alternative<std::int64_t>(usual); }
  /// Whether its value is a text.
  bool is_text() const { return std::holds_alternative<std::string>(usual); }
  /// Throws std::invalid_argument, in a sentence that begins with the name, for a value that is not within
  /// the bounds, or not finite.
  void require(const parameter_value& value) const;
};

}  // namespace detail

/// Values of all parameters of a system, in the order of their declaration.
class parameter_values {
 public:
  /// Appends one value.
  void add(std::string name, parameter_value value) { all_.emplace_back(std::move(name), std::move(value)); }
  /// All parameters: names and values.
  const std::vector<std::pair<std::string, parameter_value>>& all() const { return all_; }
  /// Throws std::invalid_argument if none has the name.
  const parameter_value& operator[](std::string_view name) const;
  /// The value of a whole number.
  std::int64_t whole(std::string_view name) const { return std::get<std::int64_t>((*this)[name]); }
  double real(std::string_view name) const;  ///< a whole number too
  /// The value of a text.
  const std::string& text(std::string_view name) const { return std::get<std::string>((*this)[name]); }

 private:
  std::vector<std::pair<std::string, parameter_value>> all_;
};

namespace detail {

template <class T>
using energy_of_spring = T(const phase_point<T, Eigen::Dynamic>& x, Eigen::Index j);

/// The energies of the stiff springs of a system that has some.
struct stiff_springs {
  Eigen::Index pairs = 0;                   ///< 0: there are none
  over_scalars<energy_of_spring> energy{};  ///< of spring j, and of all if j < 0
};

template <class S>
stiff_springs stiff_springs_of(const S& system) {
  stiff_springs result;
  if constexpr (HasStiffEnergies<S> && HasStiffEnergiesOver<S, lanes>) {
    const auto energy = [system]<class T>(const phase_point<T, Eigen::Dynamic>& x, Eigen::Index j) -> T {
      const auto& own = of_dimension<S::dimension>(x);
      if (j >= 0) return system.stiff_energy(own, j);
      T sum = system.stiff_energy(own, 0);
      if constexpr (requires { system.stiff_energy(own); }) {
        sum = system.stiff_energy(own);
      } else {
        for (Eigen::Index k = 1; k < system.pairs(); ++k) sum += system.stiff_energy(own, k);
      }
      return sum;
    };
    result = {system.pairs(), energy};
  }
  return result;
}

/// Throws std::invalid_argument: a bath acts only on systems with K = p^2/2m.
[[noreturn]] void refuse_bath(const std::string& system);

/// The system as a model, in a bath that may not act.
template <SeparableSystem S>
model put_in(const S& system, const bath& in) {
  if constexpr (NystromSystem<S> && !HasBath<S> && !std::is_final_v<S>) {
    return in_bath<S>(system, in);
  } else {
    if (in.acts()) refuse_bath(describe(system));
    return system;
  }
}

}  // namespace detail

/// A system that is made of its parameters.
struct initial_value_problem {
  /// A function of a state, by name.
  struct named_observable {
    std::string name;  ///< name in --observables
    detail::over_scalars<detail::of_state>
        value;  ///< function of one state, or of those in the lanes of packs
  };

  nysalt::model system;    ///< system in its bath
  initial_states starts;   ///< the initial distribution
  double frequency = 0.0;  ///< the highest of the motion, rare starts included; 0: not known
  std::vector<named_observable> observables{};  ///< observables beyond the usual ones of every system
  std::string default_observable = "energy";    ///< observable where none is named
  double fine_angle =
      5e-3;  ///< step of a reference times the frequency: there a reference of order 6 errs by rounding
  detail::stiff_springs springs{};   ///< springs of a system with stiff_energy(x, j)
  bool has_exact_flow = false;       ///< small steps then have a fixed angle
  std::optional<reference> exact{};  ///< exact flow of the system, if known
};

namespace detail {
/// A system in a bath, with an initial distribution and the highest frequency from there.
template <SeparableSystem S>
initial_value_problem made_of(const S& system, const bath& in, initial_states starts, double frequency) {
  return {.system = put_in(system, in),
          .starts = std::move(starts),
          .frequency = frequency,
          .springs = stiff_springs_of(system)};
}
}  // namespace detail

/// All that there is to say of a system before its parameters are known.
struct system_declaration {
  std::string name;   ///< name in commands and files
  std::string title;  ///< title, one line: the Hamiltonian, in words or as a formula
  std::vector<detail::declared_parameter> parameters{};  ///< parameters in the order of help and files
  /// Makes the system with a value for each parameter. The deviations of the starts are multiplied by the
  /// spread. Throws std::invalid_argument for values out of range.
  std::function<initial_value_problem(const parameter_values&, const bath&, double spread)> make{};
  std::string letters{};    ///< names of its own letters
  bool has_spread = true;   ///< the initial distribution has deviations
  std::string described{};  ///< beginning of the description, if not the name
  std::string source{};     ///< key in docs/bibliography.bib
  std::string identity{};   ///< fingerprint of the source that declares the system; files refuse another.
                            ///< Empty: a bundled one
  bool is_checked = false;  ///< whether the force is known to belong to the potential
};

}  // namespace nysalt
