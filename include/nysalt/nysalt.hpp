// SPDX-License-Identifier: BSL-1.0
// The library but for what needs Boost.Odeint or MPI. Comparisons, recommendations and declarations of
// systems for the program have entry headers of their own: compare.hpp, recommend.hpp, plugin.hpp.
#pragma once

#include "nysalt/analyse.hpp"
#include "nysalt/atomic_file.hpp"
#include "nysalt/core.hpp"
#include "nysalt/core/rounding.hpp"
#include "nysalt/core/steps_in.hpp"
#include "nysalt/export_to.hpp"
#include "nysalt/families/multiple_time_steps.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/flows/sum_of_parts.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/learning/learn_enough.hpp"
#include "nysalt/learning/reach.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/losses/stationary_covariance.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/methods/s_aia.hpp"
#include "nysalt/parallel.hpp"
#include "nysalt/scalars/polynomial.hpp"
#include "nysalt/systems/in_time.hpp"
#include "nysalt/systems/lennard_jones_liquid.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"
#include "nysalt/version.hpp"
