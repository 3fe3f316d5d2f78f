// SPDX-License-Identifier: BSL-1.0
// What models no concept, though it nearly does; what models each is in minimal_models_test.cpp, and what a
// compiler says of others in tests/must_not_compile.
#include "../laws/models.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/methods/palindromic.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/odeint.hpp"
#include "nysalt/scalars/series.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using D = dual<double, 1>;

static_assert(Scalar<double> && Scalar<long double> && Scalar<D> && Scalar<dual<D, 3>> && Scalar<series<0>>);
static_assert(!Scalar<float>);  // double * float is a double
static_assert(!Scalar<int> && !Scalar<std::string> && !Scalar<double*> && !Scalar<vector<double, 2>>);

static_assert(CoefficientOf<double, double> && CoefficientOf<double, D> && CoefficientOf<D, D>);
static_assert(!CoefficientOf<D, double> && !CoefficientOf<dual<double, 2>, D> && !CoefficientOf<int, double>);

struct dimension_zero {
  static constexpr int dimension = 0;
};
struct dynamic_without_size {
  static constexpr int dimension = Eigen::Dynamic;
};
struct without_force {
  static constexpr int dimension = 1;
};
struct potential_that_forgets : without_force {  // returns a double whatever it is given
  template <class T>
  double potential(const vector<T, 1>&) const {
    return 0.0;
  }
};
static_assert(!System<dimension_zero> && !System<dynamic_without_size>);
static_assert(System<without_force> && !SeparableSystem<without_force>);
static_assert(!SeparableSystem<potential_that_forgets>);
static_assert(SeparableSystem<black_box> && BlackBoxForce<black_box> && !BlackBoxForce<pendulum>);
static_assert(SystemOver<black_box, dual<double, 2>> && !SystemOver<black_box, dual<D, 1>>);
static_assert(SeparableSystem<relativistic> && !NystromSystem<relativistic>);
static_assert(SeparableSystem<relativistic_with_velocity> && !NystromSystem<relativistic_with_velocity>);
static_assert(HasEnergy<relativistic> && !HasEnergy<black_box>);
static_assert(!HasModes<pendulum> && !HasFrequencyBands<potential_only> && !HasInverseMass<pendulum>);
struct mass_by_reference : pendulum {
  double stored = 0.5;
  const double& inverse_mass(Eigen::Index) const { return stored; }
};
static_assert(HasInverseMass<mass_by_reference>);  // not silently a unit mass

// Baths: a member that says what it is, whatever it returns it by.
struct bath_by_value : pendulum {
  nysalt::bath bath() const { return nysalt::bath::of_sigma(0.1, 0.2); }
};
struct bath_not_const : pendulum {
  nysalt::bath bath() { return nysalt::bath::of_sigma(0.1, 0.2); }
};
template <class S>
concept CanBeInBath = requires { typename in_bath<S>; };
static_assert(HasBath<bath_by_value> && HasBath<in_bath<pendulum>> && !HasBath<pendulum>);
static_assert(!HasBath<bath_not_const> && !HasBath<bath>);
static_assert(CanBeInBath<black_box>);
static_assert(!CanBeInBath<relativistic_with_velocity>);
static_assert(!CanBeInBath<in_bath<pendulum>> && !CanBeInBath<bath_by_value>);  // one bath is enough

// Sources of noise.
struct says_not_how_it_draws {};
static_assert(!NoiseSource<says_not_how_it_draws> && !NoiseSource<double>);

// Letters and words.
struct not_prepared {
  static constexpr char letter = 'N';
};
struct not_applied : kick {
  static void apply(auto&&...) = delete;
};
static_assert(!Flow<not_prepared> && !Flow<not_applied> && !Flow<int> && !StochasticFlow<kick>);
static_assert(!Word<kick> && !Word<verlet>);

// Families and methods.
struct without_start : nystrom {
  static std::array<double, 2> start() = delete;
};
struct with_too_few_coefficients : nystrom {
  template <Scalar C>
  static std::array<C, 4> coefficients(const std::array<C, 2>&) {
    return {};
  }
};
struct not_differentiable : nystrom {
  static std::array<double, 5> coefficients(const std::array<double, 2>&) { return {}; }
};
struct without_order : palindromic<kick, drift, 3> {
  static std::string name() { return {}; }
  static std::array<double, 3> coefficients() { return {}; }
};
static_assert(!Family<not_differentiable> && !Family<without_start>);
static_assert(!Family<with_too_few_coefficients> && !Family<verlet>);
static_assert(!Method<nystrom> && !Method<without_order> && !Method<kick>);

// Ensembles and references.
struct unsaid {  // an ensemble without a description
  phase_point<double, 1> operator()(std::uint64_t, std::uint64_t) const { return {}; }
};
static_assert(!Ensemble<fpu_law<3>, fpu_chain<2>> && !Ensemble<listed<1>, henon_heiles> &&
              !Ensemble<unsaid, pendulum>);

struct never_finer {
  template <System S>
  void advance(const S&, phase_point<double, S::dimension>&, double) const {}
  std::string description() const { return {}; }
};
static_assert(!ReferenceFlow<never_finer, pendulum> && !ReferenceFlow<odeint_reference, without_force>);
static_assert(!std::constructible_from<exact_linear, const pendulum&>);  // it has no modes

}  // namespace

BOOST_AUTO_TEST_CASE(the_concepts_hold_as_asserted) { BOOST_TEST(true); }
