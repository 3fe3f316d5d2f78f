// expect: Scalar
// expect: System
// expect: Flow
// expect: Family
// expect: Method
// expect: NoiseSource
// expect: Ensemble
// expect: ReferenceFlow
// SPDX-License-Identifier: BSL-1.0
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/pendulum.hpp"

// What models nothing is refused by the name of the concept, wherever it is handed over.
struct nothing {};

#ifdef NYSALT_CONTROL
template <class Model, class Nothing>
using either = Model;
#else
template <class Model, class Nothing>
using either = Nothing;
#endif

using state = nysalt::phase_point<either<double, float>, 1>;
using letters = nysalt::word<either<nysalt::drift, nothing>, nysalt::kick>;
using family = nysalt::member<either<nysalt::nystrom, nothing>>;

void everything(const nysalt::pendulum& system, const either<nysalt::pendulum, nothing>& any_system,
                const either<nysalt::verlet, nothing>& method, const either<nysalt::no_noise, nothing>& noise,
                const either<nysalt::listed<1>, nothing>& starts,
                const either<nysalt::fine_steps<>, nothing>& reference,
                const nysalt::phase_point<double, 1>& x) {
  nysalt::make_stepper(any_system, nysalt::verlet(), 0.1);
  nysalt::make_stepper(system, method, 0.1);
  nysalt::make_stepper(system, nysalt::verlet(), 0.1, noise);
  nysalt::sound_start(system, starts, 1, 0);
  nysalt::reference_error(system, reference, x, 0.1);
}
