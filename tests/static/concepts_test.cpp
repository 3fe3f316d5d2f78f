// SPDX-License-Identifier: BSL-1.0
// What models no concept, though it nearly does; what models each is in minimal_models_test.cpp. A member of
// a name that the library uses, or of one near to it, is seen whatever its form; so none is ignored. What a
// compiler says of all of these is in tests/must_not_compile.
#include <string>
#include <vector>

#include "../laws/models.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/flows/sum_of_parts.hpp"
#include "nysalt/methods/s_aia.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/references/odeint.hpp"
#include "nysalt/scalars/series.hpp"
#include "nysalt/systems/requirements.hpp"

using namespace nysalt;
using namespace nysalt::test;
using namespace nysalt::detail;

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

// Letters.
struct not_prepared {
  static constexpr char letter = 'N';
};
struct not_applied : kick {
  static void apply(auto&&...) = delete;
};
static_assert(!Flow<not_prepared> && !Flow<not_applied> && !Flow<int> && !StochasticFlow<kick>);

// Families, which are no methods.
struct without_start : nystrom {
  static std::array<double, 2> start() = delete;
};
struct not_differentiable : nystrom {
  static std::array<double, 5> coefficients(const std::array<double, 2>&) { return {}; }
};
static_assert(!Family<not_differentiable> && !Family<without_start>);
static_assert(!Family<verlet> && !Family<kick>);
static_assert(!std::is_convertible_v<nystrom, method> && !std::is_convertible_v<kick, method>);

// Ensembles and references.
struct unsaid {  // an ensemble without a description
  phase_point<double, 1> operator()(std::uint64_t, std::uint64_t) const { return {}; }
};
static_assert(!Ensemble<fpu_law<3>, fpu_chain<2>> && !Ensemble<listed<1>, henon_heiles> &&
              !Ensemble<unsaid, pendulum>);

struct never_finer {
  template <System S>
  std::int64_t advance(const S&, phase_point<double, S::dimension>&, double) const {
    return 0;
  }
  std::string description() const { return {}; }
};
static_assert(!ReferenceFlow<never_finer> && ReferenceFlow<odeint_reference>);

struct bare {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0];
  }
};

// Each name in forms that no use of it has, and whether S has a member of the name that is used.
#define NYSALT_TEST_MEMBER(name, ...)                                                     \
  namespace name##_in_forms {                                                             \
    template <class S>                                                                    \
    concept used = __VA_ARGS__;                                                           \
    struct not_const : bare {                                                             \
      void name();                                                                        \
    };                                                                                    \
    struct of_four : bare {                                                               \
      template <class A>                                                                  \
      int name(const A&, const A&, const A&, const A&) const;                             \
    };                                                                                    \
    struct overloaded : bare {                                                            \
      void name(char*) const;                                                             \
      void name(char*, char*, char*, char*) const;                                        \
    };                                                                                    \
    struct data : bare {                                                                  \
      std::vector<void*> name;                                                            \
    };                                                                                    \
    class hidden : public bare {                                                          \
      void name(char*, char*, char*, char*) const;                                        \
    };                                                                                    \
    template <class... S>                                                                 \
    inline constexpr bool refused = ((mentions_##name<S> && !used<S>)&&...);              \
    static_assert(refused<not_const, of_four, overloaded, data, hidden>);                 \
    static_assert(!mentions_##name<henon_heiles> || used<henon_heiles>);                  \
    static_assert(!mentions_##name<fpu_chain<3>> || used<fpu_chain<3>>);                  \
    struct final_class final {                                                            \
      static constexpr int dimension = 1;                                                 \
      void name(char*, char*, char*, char*) const;                                        \
    };                                                                                    \
    struct another_final_class final {                                                    \
      static constexpr int dimension = 1;                                                 \
    };                                                                                    \
    static_assert(mentions_##name<final_class> && !mentions_##name<another_final_class>); \
  }

NYSALT_TEST_MEMBER(potential, HasPotential<S, double>)
NYSALT_TEST_MEMBER(force, HasForce<S, double>)
NYSALT_TEST_MEMBER(soft_force, HasSoftForce<S>)
NYSALT_TEST_MEMBER(force_derivative, CanDifferentiateForce<S, double>)
NYSALT_TEST_MEMBER(kick, CanKick<S, double, double>)
NYSALT_TEST_MEMBER(inverse_mass, HasInverseMass<S>)
NYSALT_TEST_MEMBER(kinetic_energy, HasKineticEnergy<S, double>)
NYSALT_TEST_MEMBER(velocity, HasVelocity<S, double>)
NYSALT_TEST_MEMBER(modes, HasModes<S>)
NYSALT_TEST_MEMBER(has_modes, TellsHasModes<S>)
NYSALT_TEST_MEMBER(frequency_bands, HasFrequencyBands<S>)
NYSALT_TEST_MEMBER(force_cost, HasForceCost<S>)
NYSALT_TEST_MEMBER(bath, HasBath<S>)
NYSALT_TEST_MEMBER(description, TellsDescription<S>)
NYSALT_TEST_MEMBER(kind, TellsKind<S>)

static_assert(!mentions_force<bare> && !mentions_inverse_mass<bare> && mentions_potential<bare>);
struct force : bare {};  // the name of a class is no member
static_assert(!mentions_force<force>);

// Near names, and what is none.
#define NYSALT_TEST_NEAR(group, name)                           \
  namespace name##_is_near {                                    \
    struct of_two : bare {                                      \
      template <class A>                                        \
      A name(const A&, const A&) const;                         \
    };                                                          \
    class hidden : public bare {                                \
      double name(int) const;                                   \
    };                                                          \
    struct parameter : bare {                                   \
      double name = 2.0;                                        \
    };                                                          \
    static_assert(group<of_two> && group<hidden>);              \
    static_assert(!group<parameter> && !group<bare>);           \
    static_assert(!group<henon_heiles> && !group<fpu_chain<>>); \
  }

NYSALT_TEST_NEAR(mentions_masses, mass)
NYSALT_TEST_NEAR(mentions_masses, masses)
NYSALT_TEST_NEAR(mentions_masses, mass_matrix)
NYSALT_TEST_NEAR(mentions_masses, inverse_mas)
NYSALT_TEST_NEAR(mentions_masses, nverse_mass)
NYSALT_TEST_NEAR(mentions_masses, inverse_amss)
NYSALT_TEST_NEAR(mentions_near_kinetic_energy, kinetic)
NYSALT_TEST_NEAR(mentions_near_kinetic_energy, kinetc_energy)
NYSALT_TEST_NEAR(mentions_near_kinetic_energy, kinetic_eneryg)
NYSALT_TEST_NEAR(mentions_near_velocity, velocities)
NYSALT_TEST_NEAR(mentions_near_velocity, velocty)
NYSALT_TEST_NEAR(mentions_hamiltonian, hamiltonian)
NYSALT_TEST_NEAR(mentions_hamiltonian, Hamiltonian)
NYSALT_TEST_NEAR(mentions_hamiltonian, energy)
NYSALT_TEST_NEAR(mentions_near_potential, potential_energy)
NYSALT_TEST_NEAR(mentions_near_potential, potental)
NYSALT_TEST_NEAR(mentions_near_force, forces)
NYSALT_TEST_NEAR(mentions_near_force, grad)
NYSALT_TEST_NEAR(mentions_near_force, gradient)
NYSALT_TEST_NEAR(mentions_near_force, froce)
NYSALT_TEST_NEAR(mentions_near_others, frequencies)
NYSALT_TEST_NEAR(mentions_near_others, normal_modes)
NYSALT_TEST_NEAR(mentions_near_others, describe)

struct with_masses : bare {
  std::vector<double> masses;
};
struct with_room : bare {
  std::vector<double> forces;
};
static_assert(mentions_masses<with_masses> && !mentions_near_force<with_room>);

// What wrappers have under constraints is not taken for their own.
static_assert(std::is_same_v<written_system<counted<in_bath<bare>>>::type, bare>);
static_assert(std::is_same_v<written_system<bare>::type, bare>);
struct of_parts : sum_of_parts<bare, bare> {
  double mass(int) const;
};
static_assert(mentions_masses<of_parts> && !mentions_masses<sum_of_parts<bare, bare>>);
static_assert(std::is_same_v<written_system<of_parts>::type, bare>);

}  // namespace

// Where this file compiles all of it holds; a run shows that it was.
BOOST_AUTO_TEST_CASE(the_concepts_hold_as_asserted) { BOOST_TEST(sizeof(bare) > 0U); }
