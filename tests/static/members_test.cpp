// SPDX-License-Identifier: BSL-1.0
// A member of a name that the library uses, or of one near to it, is seen whatever its form; so none is
// ignored. The sentences that follow are in tests/must_not_compile.
#include <string>
#include <vector>

#include "nysalt/detail/requirements.hpp"
#include "nysalt/systems/counted.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/sum_of_parts.hpp"

using namespace nysalt;
using namespace nysalt::detail;

namespace {

struct bare {
  static constexpr int dimension = 1;
  template <class T>
  T potential(const vector<T, 1>& q) const {
    return q[0] * q[0];
  }
};

using D = dual<double, 1>;

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
BOOST_AUTO_TEST_CASE(members_of_systems_are_checked) { BOOST_TEST(sizeof(bare) > 0U); }
