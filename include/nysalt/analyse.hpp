// SPDX-License-Identifier: BSL-1.0
// Starts and references, errors and statistics along trajectories, properties of a step: what measures a
// method.
#pragma once

#include "nysalt/analysis/acceptance.hpp"
#include "nysalt/analysis/convergence_order.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "nysalt/analysis/energy_drift.hpp"
#include "nysalt/analysis/ensemble_statistics.hpp"
#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/derivatives/properties.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/derivatives/taylor_order.hpp"
#include "nysalt/derivatives/word_on_parts.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/ensembles/starts_to_judge.hpp"
#include "nysalt/hmc.hpp"
#include "nysalt/judgement.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_steps.hpp"
