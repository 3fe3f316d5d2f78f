// SPDX-License-Identifier: BSL-1.0
#include "own_hamiltonian.hpp"

#include <utility>

#include "../src/comparison/prepared_problem.hpp"
#include "../src/comparison/refusal.hpp"
#include "nysalt/derivatives/check_force.hpp"

namespace nysalt::python {

namespace {

using column = vector<double, Eigen::Dynamic>;

std::span<const double> numbers(const column& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }
std::span<double> numbers(column& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

class own_hamiltonian {
 public:
  static constexpr int dimension = Eigen::Dynamic;
  static constexpr int lanes = 1;

  explicit own_hamiltonian(std::shared_ptr<const own_functions> functions)
      : functions_(std::move(functions)) {}

  Eigen::Index size() const { return functions_->dimension; }
  double potential(const column& q) const { return functions_->potential(numbers(q)); }
  void force(const column& q, column& f) const { functions_->force(numbers(q), numbers(f)); }
  double inverse_mass(Eigen::Index i) const {
    return functions_->inverse_masses[static_cast<std::size_t>(i)];
  }
  std::string description() const { return functions_->name; }
  std::string kind() const { return functions_->kind.empty() ? functions_->name : functions_->kind; }

 private:
  std::shared_ptr<const own_functions> functions_;
};
static_assert(BlackBoxForce<own_hamiltonian> && NystromSystem<own_hamiltonian> && HasEnergy<own_hamiltonian>);

}  // namespace

}  // namespace nysalt::python

/// No mutex: its functions are called with the global interpreter lock (GIL) held, and Python may switch
/// threads during such a call. A thread that waited for a mutex here would hold the GIL that the owner of the
/// mutex needs, and a force that calls its own system would wait for itself: both are deadlocks.
template <>
inline constexpr bool nysalt::detail::needs_lock<nysalt::python::own_hamiltonian> = false;

namespace nysalt::python {

namespace {

class own_starts {
 public:
  explicit own_starts(std::shared_ptr<const own_functions> functions) : functions_(std::move(functions)) {}

  phase_point<double, Eigen::Dynamic> operator()(std::uint64_t seed, std::uint64_t n) const {
    phase_point<double, Eigen::Dynamic> start{column(functions_->dimension), column(functions_->dimension)};
    functions_->start(seed, n, numbers(start.q), numbers(start.p));
    return start;
  }
  std::string description() const { return "starts of " + functions_->name; }

 private:
  std::shared_ptr<const own_functions> functions_;
};

/// A pointer without ownership, for a user that lives no longer than the object.
template <class T>
std::shared_ptr<T> lent(T& it) {
  return {std::shared_ptr<T>(), &it};
}

void require_force(const own_functions& functions) {
  const own_hamiltonian system(lent(functions));
  const own_starts starts(lent(functions));
  std::vector<column> points;
  for (std::uint64_t n = 0; n < 4; ++n) {
    points.push_back(sound_start(system, starts, 1, static_cast<std::int64_t>(n)).q);
  }
  const force_check found = check_force(system, points);
  if (!found.passed()) program::refuse("cannot take {}: {}", functions.name, found.report());
}

}  // namespace

std::unique_ptr<program::prepared_problem> make_own(std::shared_ptr<const own_functions> functions,
                                                    const program::surroundings& in) {
  initial_value_problem made =
      detail::made_of(own_hamiltonian(functions), in.bath, own_starts(functions), functions->frequency);
  made.fine_angle = 0.05;  // calls of Python are expensive, and the error of that angle is measured
  return std::make_unique<program::prepared_problem>(
      std::move(made), std::vector<program::named_value>{{"name", functions->name}}, in);
}

model side_by_side(const std::shared_ptr<const own_functions>& functions, std::int64_t count,
                   const bath& heat_bath) {
  auto all = std::make_shared<own_functions>();
  all->name = functions->name;
  all->dimension = count * functions->dimension;
  for (std::int64_t m = 0; m < count; ++m) {
    all->inverse_masses.insert(all->inverse_masses.end(), functions->inverse_masses.begin(),
                               functions->inverse_masses.end());
  }
  all->potential = [functions, count](std::span<const double> q) {
    std::vector<double> each(static_cast<std::size_t>(count));
    functions->potentials(q, count, each);
    double sum = 0.0;
    for (const double one : each) sum += one;
    return sum;
  };
  all->force = [functions, count](std::span<const double> q, std::span<double> f) {
    functions->forces(q, count, f);
  };
  return model(own_hamiltonian(std::move(all))).in(heat_bath);
}

void examine(own_functions& functions) {
  require_force(functions);
  if (functions.frequency > 0.0) return;
  constexpr std::uint64_t starts = 64;
  const program::surroundings nowhere{bath::of_sigma(0.0, 0.0), program::start::law};
  const auto found = make_own(lent(std::as_const(functions)), nowhere)->frequency_along_starts(1, starts);
  functions.frequency = found.value_or(0.0);
  if (functions.frequency > 0.0) return;
  program::refuse(
      "{}: a frequency must be seen along its starts, got none; give frequency, the highest angular "
      "frequency of its motion, by which the step of the reference is chosen",
      functions.name);
}

}  // namespace nysalt::python
